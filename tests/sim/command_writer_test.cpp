#include "sim/command_writer.h"

#include <utility>

#include "tests/catch.h"
#include "tests/sim/random_workload.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

bool same(const CommandColumns& a, const CommandColumns& b) {
  return a.submit_ps == b.submit_ps && a.primitive_ps == b.primitive_ps && a.pixel_ps == b.pixel_ps &&
         a.item == b.item && a.facts == b.facts && a.upload_ps == b.upload_ps && a.fetch_ps == b.fetch_ps &&
         a.upload_bytes == b.upload_bytes;
}

MachineProfile profile(bool bus, double area_exponent) {
  MachineProfile machine = test_profile(0.4);
  for (AlgorithmCosts& costs : machine.algorithm) costs.area_exponent = area_exponent;
  machine.submit_draw_s = 3e-7;
  if (bus) machine.bus.chunk = Picoseconds(1'000'000);
  return machine;
}

}  // namespace

// Workloads of 0 to 400 items: with fewer than there are facts nothing is worked out before.
TEST_CASE("the writer's commands are Machine::command's, bit for bit, whatever it wrote before") {
  for (const auto& [bus, area_exponent] : {std::pair{false, 0.0}, {true, 0.0}, {false, 0.3}}) {
    const Machine machine(profile(bus, area_exponent));
    CommandWriter writer;
    CommandColumns written;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      CAPTURE(bus, area_exponent, seed);
      const RandomWorkload random(seed, seed * seed % 401);
      const Selection selection = random.select(0);
      CommandColumns plain;
      machine.command(random.workload, selection, plain);
      writer.write(machine, random.workload, selection, written);
      REQUIRE(same(written, plain));
      // What an effect may leave behind.
      written.upload_ps.assign(3, 7);
      written.fetch_ps.assign(3, 7);
      written.upload_bytes = 9;
    }
  }
}

// A day is the longest duration (units.h). 10 polygons at 30,000 s each are 3.5 days; at resolution 0.1 a third of one.
TEST_CASE("a level that takes too long is refused if it is drawn, and only then") {
  MachineProfile slow = test_profile();
  slow.algorithm[static_cast<std::size_t>(Algorithm::gouraud)].polygon_s = 30'000;
  const Machine machine(slow);
  std::vector<ObjectType> types(1);
  Workload w;
  w.types = types;
  w.facts = {{.polygons = 1}, {.polygons = 10}};
  w.static_facts = 2;
  w.level_begin = {0};
  for (std::uint32_t i = 0; i < 2; ++i) {
    w.id.push_back(InstanceId{i});
    w.type.push_back(TypeId{0});
    w.kind.push_back(ItemKind::levels);
    w.projected_area_px.push_back(10);
    w.facts_begin.push_back(0);
    w.level_begin.push_back(2 * i + 2);
  }
  Selection selection;
  selection.level = {0, 1};
  selection.resolution = {1, 0.1};
  CommandWriter writer;
  CommandColumns commands;
  writer.write(machine, w, selection, commands);
  CHECK(commands.primitive_ps[2] == ceil_picoseconds(4e-6 + 30'000).count());
  selection.resolution = {1, 1};
  CHECK_THROWS_AS(writer.write(machine, w, selection, commands), InputError);
}
