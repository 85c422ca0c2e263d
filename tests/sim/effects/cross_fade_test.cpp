#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

constexpr std::int64_t us = 1'000'000;  // picoseconds
constexpr std::int16_t none = kNotDrawn;

// A polygon takes 1 us, a pixel 10 ns, a command 10 us of the CPU and 1 us more for each draw beyond the first.
MachineProfile round_numbers() {
  MachineProfile profile{.name = "round"};
  profile.algorithm[static_cast<std::size_t>(Algorithm::flat)] = {.polygon_s = 1e-6, .pixel_s = 10e-9};
  profile.submit_s = 10e-6;
  profile.submit_draw_s = 1e-6;
  profile.clear_s = 50e-6;
  return profile;
}

// Three levels of 100, 1000 and 5000 polygons, the middle one in 3 draws.
EffectRun three_levels() {
  EffectRun run{.machine = round_numbers()};
  ObjectType type{.name = "box"};
  type.levels = {Facts{.polygons = 100, .algorithm = Algorithm::flat},
                 Facts{.polygons = 1000, .draws = 3, .algorithm = Algorithm::flat},
                 Facts{.polygons = 5000, .algorithm = Algorithm::flat}};
  run.scene.types = {type};
  run.scene.instances = 10;
  return run;
}

// An item of a frame and what is drawn of it.
struct Item {
  std::uint32_t id = 0;
  std::int16_t level = 0;
  double resolution = 1;
  double area_px = 1000;
  std::uint32_t levels = 3;
  ItemKind kind = ItemKind::levels;
};

// What is drawn, frame by frame: the rows that the fade adds behind those of the machine.
class Fading {
 public:
  explicit Fading(const char* spec_text) : effect_(prepared_effect(spec_text, run_)) {}

  CommandColumns draw(const std::vector<Item>& items) {
    Workload workload;
    Selection selection;
    workload.types = run_.scene.types;
    workload.facts = run_.scene.types[0].levels;
    workload.level_begin = {0};
    selection.reset(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Item& item = items[i];
      workload.id.push_back(InstanceId{item.id});
      workload.type.push_back(TypeId{0});
      workload.kind.push_back(item.kind);
      workload.projected_area_px.push_back(item.area_px);
      workload.facts_begin.push_back(0);
      workload.level_begin.push_back(workload.level_begin.back() + item.levels);
      selection.level[i] = item.level;
      selection.resolution[i] = item.resolution;
    }
    CommandColumns commands;
    machine_.command(workload, selection, commands);
    const CommandColumns chosen = commands;
    effect_->on_commands({.frame = frame_++, .workload = workload, .selection = selection, .machine = machine_},
                         commands);
    return behind(chosen, commands);
  }

  // Polygons of the added rows, frame by frame, for one item of 0 pixels that has these levels.
  std::vector<std::vector<std::int64_t>> script(const std::vector<std::int16_t>& levels) {
    std::vector<std::vector<std::int64_t>> polygons;
    for (const std::int16_t level : levels) {
      polygons.emplace_back();
      const CommandColumns added = draw({{.id = 4, .level = level, .area_px = 0}});
      for (const std::int64_t primitive_ps : added.primitive_ps) polygons.back().push_back(primitive_ps / us);
    }
    return polygons;
  }

  void skip_frame() { ++frame_; }
  void prepare() { effect_->prepare(run_.context()); }

 private:
  // The rows of `all` behind those of `chosen`, which must be as they were.
  static CommandColumns behind(const CommandColumns& chosen, const CommandColumns& all) {
    CommandColumns rest;
    const auto split = [&](const auto& before, const auto& now, auto& tail) {
      REQUIRE(now.size() == all.size());
      REQUIRE(now.size() >= before.size());
      const auto middle = now.begin() + static_cast<std::ptrdiff_t>(before.size());
      CHECK(std::equal(now.begin(), middle, before.begin()));
      tail.assign(middle, now.end());
    };
    split(chosen.submit_ps, all.submit_ps, rest.submit_ps);
    split(chosen.primitive_ps, all.primitive_ps, rest.primitive_ps);
    split(chosen.pixel_ps, all.pixel_ps, rest.pixel_ps);
    split(chosen.item, all.item, rest.item);
    return rest;
  }

  EffectRun run_ = three_levels();
  Machine machine_{run_.machine};
  std::unique_ptr<Effect> effect_;
  std::int64_t frame_ = 0;
};

using Rows = std::vector<std::vector<std::int64_t>>;

}  // namespace

TEST_CASE("the old level is drawn beside the new one for so many frames, the first being that of the change") {
  CHECK(Fading("cross-fade:frames=3").script({0, 0, 2, 2, 2, 2, 2}) == Rows{{}, {}, {100}, {100}, {100}, {}, {}});
  CHECK(Fading("cross-fade:frames=1").script({2, 1, 1, 0, 0}) == Rows{{}, {5000}, {}, {1000}, {}});
  CHECK(make_effect("cross-fade")->hooks() == Hook::commands);
}

TEST_CASE("a change during a fade starts a new one from the level just left") {
  CHECK(Fading("cross-fade:frames=3").script({0, 1, 2, 2, 2, 2}) == Rows{{}, {100}, {1000}, {1000}, {1000}, {}});
  CHECK(Fading("cross-fade:frames=3").script({0, 1, 0, 0, 0, 0}) == Rows{{}, {100}, {1000}, {1000}, {1000}, {}});
  CHECK(Fading("cross-fade:frames=2").script({0, 1, 0, 1}) == Rows{{}, {100}, {1000}, {100}});
}

TEST_CASE("what appears or is not drawn does not fade") {
  CHECK(Fading("cross-fade:frames=3").script({0, 1, none, 1, 1}) == Rows{{}, {100}, {}, {}, {}});
  CHECK(Fading("cross-fade:frames=3").script({none, 1, 1}) == Rows{{}, {}, {}});
  CHECK(Fading("cross-fade:frames=3").script({0, none, 2, 2}) == Rows{{}, {}, {}, {}});
}

TEST_CASE("an item that was out of view does not fade, nor go on with a fade") {
  Fading fading("cross-fade:frames=4");
  CHECK(fading.script({0, 1}) == Rows{{}, {100}});
  fading.draw({});
  CHECK(fading.script({1, 1}) == Rows{{}, {}});
  fading.draw({});
  CHECK(fading.script({2, 2, 0}) == Rows{{}, {}, {5000}});
  fading.skip_frame();
  CHECK(fading.script({0}) == Rows{{}});
}

// Level 1: 3 draws, 10 + 2*1 us on the CPU, 1000 polygons of 1 us. The area is that of the frame: 3000 px of 10 ns,
// then 500.
TEST_CASE("the old level is priced as the machine prices a command, on the present area") {
  Fading fading("cross-fade:frames=2");
  fading.draw({{.id = 1, .level = 1, .area_px = 1000}});
  CommandColumns added = fading.draw({{.id = 1, .level = 2, .area_px = 3000}});
  CHECK(added.submit_ps == std::vector<std::int64_t>{12 * us});
  CHECK(added.primitive_ps == std::vector<std::int64_t>{1000 * us});
  CHECK(added.pixel_ps == std::vector<std::int64_t>{30 * us});
  added = fading.draw({{.id = 1, .level = 2, .area_px = 500}});
  CHECK(added.submit_ps == std::vector<std::int64_t>{12 * us});
  CHECK(added.pixel_ps == std::vector<std::int64_t>{5 * us});
}

// A quarter of level 0 was drawn: 25 polygons on 250 of 1000 pixels.
TEST_CASE("a level drawn in part fades out in part") {
  Fading fading("cross-fade:frames=1");
  fading.draw({{.id = 1, .level = 0, .resolution = 0.25}});
  const CommandColumns added = fading.draw({{.id = 1, .level = 1}});
  CHECK(added.primitive_ps == std::vector<std::int64_t>{25 * us});
  CHECK(added.pixel_ps == std::vector<std::int64_t>{5 * us / 2});
  CHECK(fading.draw({{.id = 1, .level = 1, .resolution = 0.5}}).size() == 0);  // another share is no other level
}

// Fades are remembered by instance; rows come in item order and name the item of this frame.
TEST_CASE("added rows name their items, in item order") {
  Fading fading("cross-fade:frames=3");
  fading.draw({{.id = 2, .level = 0}, {.id = 5, .level = 1}, {.id = 7, .level = 2}, {.id = 9, .level = 2}});
  CommandColumns added =
      fading.draw({{.id = 2, .level = 1}, {.id = 5, .level = 1}, {.id = 7, .level = 0}, {.id = 9, .level = 2}});
  CHECK(added.item == std::vector<std::uint32_t>{0, 2});
  CHECK(added.primitive_ps == std::vector<std::int64_t>{100 * us, 5000 * us});
  added = fading.draw({{.id = 5, .level = 0}, {.id = 7, .level = 0}, {.id = 9, .level = 2}});  // 2 has left
  CHECK(added.item == std::vector<std::uint32_t>{0, 1});
  CHECK(added.primitive_ps == std::vector<std::int64_t>{1000 * us, 5000 * us});
}

TEST_CASE("a fade ends when its level does not exist any more") {
  Fading fading("cross-fade:frames=5");
  fading.draw({{.id = 3, .level = 2}});
  CHECK(fading.draw({{.id = 3, .level = 1}}).size() == 1);
  CHECK(fading.draw({{.id = 3, .level = 1, .levels = 2}}).size() == 0);
  CHECK(fading.draw({{.id = 3, .level = 1}}).size() == 0);
}

TEST_CASE("curves and bundles do not fade") {
  Fading fading("cross-fade:frames=5");
  for (const double resolution : {0.25, 1.0, 0.5}) {
    CHECK(fading
              .draw({{.id = 0, .level = none, .levels = 0, .kind = ItemKind::bundle},
                     {.id = 3, .level = 0, .resolution = resolution, .levels = 1, .kind = ItemKind::curve}})
              .size() == 0);
  }
}

// Frame 2 of the new run would be the one after frame 1 of the old one.
TEST_CASE("a new run remembers nothing") {
  Fading fading("cross-fade:frames=5");
  CHECK(fading.script({0, 1}) == Rows{{}, {100}});
  fading.prepare();
  CHECK(fading.script({2, 2}) == Rows{{}, {}});
}

TEST_CASE("cross-fade is inert without frames or levels, and then changes nothing") {
  EffectRun run = three_levels();
  CHECK_FALSE(make_effect("cross-fade")->inert(run.context()));
  CHECK(make_effect("cross-fade:frames=0")->inert(run.context()));
  CHECK(Fading("cross-fade:frames=0").script({0, 1, 2, 0}) == Rows{{}, {}, {}, {}});
  run.scene.single_level = true;
  CHECK(make_effect("cross-fade")->inert(run.context()));
  CHECK(Fading("cross-fade").script({0, 0, none, 0}) == Rows{{}, {}, {}, {}});
}

TEST_CASE("cross-fade refuses what is no number of frames") {
  for (const char* wrong :
       {"cross-fade:frames=-1", "cross-fade:frames=1001", "cross-fade:frames=0.5", "cross-fade:time=1s"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
