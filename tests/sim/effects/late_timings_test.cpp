#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

// Both messages of frame k, each scalar one that tells frame and field.
struct Messages {
  explicit Messages(std::int64_t frame, const Workload& workload, const Selection& selection)
      : outcome{.frame = frame,
                .target_s = coded(frame, 1),
                .budget_s = coded(frame, 2),
                .frame_time_s = coded(frame, 3),
                .draw_time_s = coded(frame, 4),
                .planned_cost_s = coded(frame, 5),
                .workload = workload,
                .selection = selection},
        estimate{.estimated_draw_s = coded(frame, 6),
                 .actual_draw_s = coded(frame, 7),
                 .actual_logic_s = coded(frame, 8),
                 .visible = 1'000 + frame} {}
  static double coded(std::int64_t frame, int field) { return 100 * static_cast<double>(frame) + field; }

  FrameOutcome outcome;
  EstimateOutcome estimate;
};

void check_frame(const Messages& told, std::int64_t frame) {
  const auto coded = [&](int field) { return Messages::coded(frame, field); };
  CHECK(told.outcome.frame == frame);
  CHECK(told.outcome.target_s == coded(1));
  CHECK(told.outcome.budget_s == coded(2));
  CHECK(told.outcome.frame_time_s == coded(3));
  CHECK(told.outcome.draw_time_s == coded(4));
  CHECK(told.outcome.planned_cost_s == coded(5));
  CHECK(told.estimate.estimated_draw_s == coded(6));
  CHECK(told.estimate.actual_draw_s == coded(7));
  CHECK(told.estimate.actual_logic_s == coded(8));
  CHECK(told.estimate.visible == 1'000 + frame);
}

}  // namespace

TEST_CASE("late timings tell of each frame once, in order, so many frames late") {
  const Workload workload;
  const Selection selection;
  for (const auto& [text, late] : {std::pair{"late-timings:frames=1", 1}, std::pair{"late-timings", 2},
                                   std::pair{"late-timings:frames=3", 3}, std::pair{"late-timings:frames=8", 8}}) {
    CAPTURE(text);
    const auto effect = prepared_effect(text);
    CHECK(effect->hooks() == Hook::outcome);
    for (std::int64_t k = 0; k < 40; ++k) {
      CAPTURE(k);
      Messages messages(k, workload, selection);
      const bool told = effect->on_outcome(messages.outcome, messages.estimate);
      CHECK(told == (k >= late));
      if (told) check_frame(messages, k - late);
    }
  }
}

TEST_CASE("only the scalars are late: workload and selection are those of the frame that just ran") {
  const auto effect = prepared_effect("late-timings:frames=1");
  const Workload first_workload, second_workload;
  const Selection first_selection, second_selection;
  Messages first(0, first_workload, first_selection), second(1, second_workload, second_selection);
  CHECK_FALSE(effect->on_outcome(first.outcome, first.estimate));
  CHECK(effect->on_outcome(second.outcome, second.estimate));
  CHECK(&second.outcome.workload == &second_workload);
  CHECK(&second.outcome.selection == &second_selection);
}

TEST_CASE("a new run has no frames to tell of") {
  const Workload workload;
  const Selection selection;
  const auto effect = prepared_effect("late-timings:frames=2");
  for (int run = 0; run < 2; ++run) {
    effect->prepare(EffectRun{}.context());
    for (std::int64_t k = 0; k < 3; ++k) {
      Messages messages(10 * run + k, workload, selection);
      CHECK(effect->on_outcome(messages.outcome, messages.estimate) == (k == 2));
      if (k == 2) check_frame(messages, 10 * run);
    }
  }
}

TEST_CASE("late timings are inert when they are not late, and then change nothing") {
  const EffectRun run;
  const EffectContext context = run.context();
  CHECK_FALSE(make_effect("late-timings")->inert(context));
  const auto off = prepared_effect("late-timings:frames=0");
  CHECK(off->inert(context));
  const Workload workload;
  const Selection selection;
  for (std::int64_t k = 0; k < 5; ++k) {
    Messages messages(k, workload, selection);
    CHECK(off->on_outcome(messages.outcome, messages.estimate));
    check_frame(messages, k);
  }
}

TEST_CASE("late timings refuse what is no number of frames from 0 to 8") {
  for (const char* wrong : {"late-timings:frames=-1", "late-timings:frames=9", "late-timings:frames=1.5",
                            "late-timings:frames=two", "late-timings:late=2"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
