// Bus and client of the event engine on random pipelines, against a pipeline that is stepped picosecond by picosecond.
#include <algorithm>

#include "sim/event_engine.h"
#include "sim/recurrence.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"
#include "tests/sim/stepped_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::Pipeline;
using framesim::test::PipelineFrame;
using framesim::test::random_pipeline;
using framesim::test::SplitMix;
using framesim::test::staged;
using framesim::test::SteppedPipeline;

namespace {

std::vector<std::int64_t> fields(const FrameTimes& t) {
  return {t.cpu_start.count(), t.submitted.count(),  t.first_draw.count(), t.drawn.count(),    t.shown.count(),
          t.draw_time.count(), t.frame_time.count(), t.latency.count(),    t.bus_wait.count(), t.preempted.count()};
}

struct Shared {
  bool bus, client;
};

void add_bus(SplitMix& random, Pipeline& pipeline) {
  pipeline.machine.bus = {.chunk = Picoseconds(random.between(1, 6)),
                          .arbitration = static_cast<Arbitration>(random.between(0, 2))};
  const int uploads = random.chance(50) ? 15 : 50, fetches = random.chance(50) ? 30 : 90;
  const std::int64_t longest = random.between(1, 25);
  for (PipelineFrame& frame : pipeline.frames) {
    for (const std::int64_t primitive : frame.commands.primitive_ps) {
      const std::int64_t most = std::min(primitive, pipeline.machine.bus.chunk.count());
      frame.commands.upload_ps.push_back(random.chance(uploads) ? random.between(1, longest) : 0);
      frame.commands.fetch_ps.push_back(random.chance(fetches) ? random.between(0, most) : 0);
    }
  }
}

void add_client(SplitMix& random, std::uint64_t seed, GpuClient& client) {
  client.duration = Picoseconds(random.between(1, random.chance(50) ? 4 : 20));
  client.switch_time = Picoseconds(random.between(0, 3));
  const std::int64_t hold = (client.duration + 2 * client.switch_time).count();
  client.period = Picoseconds(hold + random.between(1, random.chance(50) ? 8 : 80));
  client.first = Picoseconds(random.between(0, 40));
  client.between_commands = random.chance(50);
  if (random.chance(30)) client.arrivals = RandomStream(seed, "preemption");
}

// Short durations, so that ties are frequent and a picosecond at a time is fast enough. FIFOs of 1..4, 1..4 frames in
// flight, a third with vsync.
Pipeline random_shared_pipeline(std::uint64_t seed, Shared shared) {
  SplitMix random(seed);
  const auto fifo = [&] { return static_cast<int>(random.between(1, 4)); };
  const int first = fifo(), second = fifo();
  Pipeline pipeline{.machine = staged(first, second, static_cast<int>(random.between(1, 4))), .frames = {}};
  const std::int64_t submit = random.between(0, 6), primitive = random.between(0, 9), pixel = random.between(0, 9);
  const std::int64_t before = random.between(0, 30), period = random.chance(33) ? random.between(1, 60) : 0;
  const std::int64_t swap = random.between(0, 3);
  for (std::int64_t k = random.between(1, 6); k > 0; --k) {
    PipelineFrame& frame = pipeline.frames.emplace_back();
    frame.cpu_before = random.between(0, before), frame.swap = swap, frame.vsync_period = period;
    for (std::int64_t i = random.between(1, 7); i > 0; --i) {
      const std::int64_t of_submit = random.between(0, submit), of_primitive = random.between(0, primitive);
      add_command(frame.commands, of_submit, of_primitive, random.between(0, pixel));
    }
  }
  if (shared.bus) add_bus(random, pipeline);
  if (shared.client) add_client(random, seed, pipeline.machine.client);
  return pipeline;
}

SteppedPipeline::Occurred check_against_steps(std::uint64_t first_seed, std::uint64_t seeds, Shared shared) {
  SteppedPipeline::Occurred sum;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    const Pipeline pipeline = random_shared_pipeline(seed, shared);
    SteppedPipeline reference(pipeline);
    const std::vector<FrameTimes>& expected = reference.run();
    EventEngine engine(pipeline.machine);
    for (std::size_t k = 0; k < pipeline.frames.size(); ++k) {
      INFO("seed " << seed << ", frame " << k);
      REQUIRE(fields(engine.run(pipeline.frames[k].work())) == fields(expected[k]));
    }
    const SteppedPipeline::Occurred& once = reference.occurred();
    sum.contended += once.contended, sum.taken_from_later += once.taken_from_later, sum.stopped += once.stopped;
    sum.queued_jobs += once.queued_jobs, sum.waited_between += once.waited_between;
    sum.let_later_be += once.let_later_be;
  }
  return sum;
}

}  // namespace

// The reference must be right where there is an equation.
TEST_CASE("the stepped pipeline agrees with the recurrence where nothing is shared") {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Pipeline pipeline = random_shared_pipeline(seed, {.bus = false, .client = false});
    SteppedPipeline steps(pipeline);
    const std::vector<FrameTimes>& stepped = steps.run();
    StagedRecurrence recurrence(pipeline.machine);
    for (std::size_t k = 0; k < pipeline.frames.size(); ++k) {
      INFO("seed " << seed << ", frame " << k);
      REQUIRE(fields(stepped[k]) == fields(recurrence.run(pipeline.frames[k].work())));
    }
  }
}

TEST_CASE("a shared bus agrees with the stepped pipeline, in each arbitration") {
  const auto occurred = check_against_steps(100'000, 10'000, {.bus = true, .client = false});
  CHECK(occurred.contended > 2000);
  CHECK(occurred.taken_from_later > 200);
}

TEST_CASE("another client of the GPU agrees with the stepped pipeline, in both modes, periodic and Poisson") {
  const auto occurred = check_against_steps(200'000, 5000, {.bus = false, .client = true});
  CHECK(occurred.stopped > 2000);
  CHECK(occurred.queued_jobs > 2000);
  CHECK(occurred.waited_between > 2000);
  CHECK(occurred.let_later_be > 100);
}

TEST_CASE("a bus and a client together agree with the stepped pipeline") {
  const auto occurred = check_against_steps(300'000, 10'000, {.bus = true, .client = true});
  CHECK(occurred.contended > 2000);
  CHECK(occurred.taken_from_later > 200);
  CHECK(occurred.stopped > 2000);
  CHECK(occurred.waited_between > 2000);
}

// Nothing crosses the bus, or only fetches, which come one at a time: no equation changes. A fetch is as long as the
// per-primitive stage allows.
TEST_CASE("a bus without uploads never makes a draw wait: the recurrence, bit for bit") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Pipeline pipeline = random_pipeline(seed);
    pipeline.machine.bus = {.chunk = Picoseconds(10'000'000'000'000),
                            .arbitration = static_cast<Arbitration>(seed % 3)};
    StagedRecurrence recurrence(pipeline.machine);
    EventEngine idle_bus(pipeline.machine), fetches(pipeline.machine);
    for (std::size_t k = 0; k < pipeline.frames.size(); ++k) {
      INFO("seed " << seed << ", frame " << k);
      PipelineFrame& frame = pipeline.frames[k];
      const std::vector<std::int64_t> expected = fields(recurrence.run(frame.work()));
      REQUIRE(fields(idle_bus.run(frame.work())) == expected);
      frame.commands.fetch_ps = frame.commands.primitive_ps;
      frame.commands.upload_ps.assign(frame.commands.size(), 0);
      REQUIRE(fields(fetches.run(frame.work())) == expected);  // bus_wait among them: 0
    }
  }
}
