// Streaming and preemption end to end: scene, policy, effects and event engine, with what must hold of the frame
// records. The policies here choose by what is seen alone, so that all runs draw the same.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "experiments/run.h"
#include "scenes/registry.h"
#include "scenes/scene_file.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

RunResult run_with(const Scene& scene, const char* policy, const std::vector<std::string>& effects,
                   std::int64_t frames = 60) {
  RunSpec spec;
  spec.scene = parse_spec("test");
  spec.policy = parse_spec(policy);
  for (const std::string& effect : effects) spec.effects.push_back(parse_spec(effect));
  spec.target_s = 0.05;
  spec.frames = frames;
  return run(spec, scene);
}

std::int64_t sum_of(const RunResult& result, std::int64_t FrameRecord::*column) {
  std::int64_t sum = 0;
  for (const FrameRecord& record : result.records) sum += record.*column;
  return sum;
}

// Eight types of exactly 1 MiB (with vertex-bytes=0,polygon-bytes=0), one object of each in a row that the camera walks
// along, so that it sees fewer and fewer of them.
Scene row_of_textures() {
  std::string text =
      "framesim = 1\nname = 'r'\ntitle = 'r'\nsource = 'r'\nassumptions = 'r'\ntargets = ['16ms']\n[machine]\nuse = "
      "'street'\n";
  for (int t = 0; t < 8; ++t) {
    text += fmt::format(
        "[[type]]\nname = 'type{0}'\nradius = '1m'\narea = 6.0\n[[type.level]]\npolygons = 10\nvertices = "
        "30\ntexture_bytes = 1048576\nalgorithm = 'gouraud'\n[[instance]]\ntype = 'type{0}'\nposition = [0, 1, -{1}]\n",
        t, 6 + 4 * t);
  }
  text +=
      "[camera]\n[[camera.path]]\nname = 'walk'\n[[camera.path.leg]]\nkind = 'polyline'\npoints = [[0, 1, 0], [0, 1, "
      "-30]]\nframes = 60\n";
  return parse_scene(text, "row.toml", "");
}

std::string row_streaming(int memory_mib) {
  return fmt::format("streaming:preload=no,vertex-bytes=0,polygon-bytes=0,memory={}", memory_mib);
}

constexpr std::int64_t kMiB = 1 << 20;

}  // namespace

// Cold, a memory for everything uploads each type that is drawn once, in the first frame: all eight stand ahead. One of
// none uploads each drawn object in each frame.
TEST_CASE("streaming: uploads of a run are what its drawn objects need") {
  const Scene scene = row_of_textures();
  const RunResult all = run_with(scene, "full-detail", {row_streaming(8)});
  CHECK(all.records[0].upload_bytes == 8 * kMiB);
  CHECK(sum_of(all, &FrameRecord::upload_bytes) == 8 * kMiB);
  const RunResult none = run_with(scene, "full-detail", {row_streaming(0)});
  for (const FrameRecord& record : none.records) CHECK(record.upload_bytes == record.drawn * kMiB);
  CHECK(none.records.back().drawn < 8);
  CHECK(none.records[0].fidelity == 2);
}

// While all eight are drawn in the same order, least recently used is the worst that there is: a memory of seven always
// evicts what is needed next (cyclic access), and uploads as much as none.
TEST_CASE("streaming: a memory one short of the working set thrashes") {
  const Scene scene = row_of_textures();
  const RunResult short_of_one = run_with(scene, "full-detail", {row_streaming(7)});
  const RunResult enough = run_with(scene, "full-detail", {row_streaming(8)});
  for (std::size_t k = 1; k < 60 && enough.records[k].drawn == 8; ++k) {
    CAPTURE(k);
    CHECK(short_of_one.records[k].upload_bytes == 8 * kMiB);
    CHECK(enough.records[k].upload_bytes == 0);
    CHECK(short_of_one.records[k].frame_time_ps > enough.records[k].frame_time_ps);
    CHECK(short_of_one.records[k].bus_wait_ps > 0);
  }
}

// Resources of one size: the stack property of tests/sim/effects/residency_test.cpp, through the whole program.
TEST_CASE("streaming: with resources of one size more memory never uploads more, in any frame") {
  const Scene scene = row_of_textures();
  std::vector<RunResult> runs;
  for (int memory_mib = 0; memory_mib <= 8; ++memory_mib) {
    runs.push_back(run_with(scene, "full-detail", {row_streaming(memory_mib)}));
  }
  for (std::size_t m = 1; m < runs.size(); ++m) {
    for (std::size_t k = 0; k < runs[m].records.size(); ++k) {
      CAPTURE(m, k);
      CHECK(runs[m].records[k].upload_bytes <= runs[m - 1].records[k].upload_bytes);
    }
  }
  CHECK(sum_of(runs[8], &FrameRecord::upload_bytes) < sum_of(runs[3], &FrameRecord::upload_bytes));
  CHECK(sum_of(runs[3], &FrameRecord::upload_bytes) < sum_of(runs[0], &FrameRecord::upload_bytes));
}

// With one frame in flight nothing of a frame is uploaded before it starts, or after it is drawn, and the bus carries
// one transfer at a time: no latency is below bytes over bandwidth. Waits and interruptions only ever delay, so no
// frame is shown earlier than without them. At 1 GB/s a byte takes 1,000 ps.
TEST_CASE("streaming and preemption: frames on shared hardware are never shown earlier, on built-in scenes") {
  for (const char* name : {"dong-forest", "street", "graphicon-forest:representation=view-levels"}) {
    const Scene scene = load_scene(parse_spec(name));
    const RunResult alone = run_with(scene, "distance", {});
    for (const std::string memory : {"0", "0.5", "2"}) {
      for (const char* arbitration : {"in-order", "draws-first", "uploads-first"}) {
        const std::string streaming =
            fmt::format("streaming:preload=no,bandwidth=1,memory={},arbitration={}", memory, arbitration);
        for (const char* client : {"", "preemption:period=5ms", "preemption:at=command,arrivals=poisson,period=9ms"}) {
          CAPTURE(name, streaming, client);
          std::vector<std::string> effects = {streaming};
          if (*client != 0) effects.emplace_back(client);
          const RunResult shared = run_with(scene, "distance", effects);
          REQUIRE(shared.records.size() == alone.records.size());
          for (std::size_t k = 0; k < alone.records.size(); ++k) {
            CAPTURE(k);
            const FrameRecord& record = shared.records[k];
            REQUIRE(record.shown_ps >= alone.records[k].shown_ps);
            REQUIRE(record.latency_ps >= 1000 * record.upload_bytes);
          }
          CHECK(sum_of(shared, &FrameRecord::upload_bytes) > 0);
          CHECK(sum_of(shared, &FrameRecord::bus_wait_ps) > 0);
          CHECK((sum_of(shared, &FrameRecord::preempted_ps) > 0) == (*client != 0));
          CHECK(shared.records.back().shown_ps > alone.records.back().shown_ps);
        }
      }
    }
  }
}

// Instances share what they draw, so that a forest of a few types needs far less than each instance's own copy; what is
// loaded before the first frame is not uploaded in it.
TEST_CASE("streaming: a forest of shared types fits where its instances would not") {
  const Scene scene = load_scene(parse_spec("dong-forest"));
  const RunResult cold = run_with(scene, "distance", {"streaming:preload=no"});
  const RunResult none = run_with(scene, "distance", {"streaming:preload=no,memory=0"});
  CHECK(sum_of(cold, &FrameRecord::upload_bytes) < 30 * kMiB);  // all types and levels together: 27.07 MiB
  CHECK(none.records[0].upload_bytes > cold.records[0].upload_bytes);
  CHECK(sum_of(none, &FrameRecord::upload_bytes) > 50 * sum_of(cold, &FrameRecord::upload_bytes));
  const RunResult warm = run_with(scene, "distance", {"streaming"});
  CHECK(sum_of(warm, &FrameRecord::upload_bytes) == 0);
  REQUIRE(warm.inert_effects.size() == 1);
  CHECK(warm.records[0].fidelity == 1);
}

// The client holds the GPU for 1 ms + 2*50 us in each 10 ms, whoever waits: at every instant when a frame is drawn the
// jobs that came so far have held it for 11 % of the time, within one job.
TEST_CASE("preemption: the client gets its share of the GPU") {
  const Scene scene = load_scene(parse_spec("street"));
  const RunResult result = run_with(scene, "full-detail", {"preemption:period=10ms"});
  const double held = static_cast<double>(sum_of(result, &FrameRecord::preempted_ps));
  const double drawn = static_cast<double>(result.records.back().drawn_ps);
  CHECK(held <= 0.11 * drawn + 1.1e9);
  CHECK(held >= 0.11 * drawn - 1.1e9);
}

// An asked-for engine that knows neither bus nor client: uploads lengthen their commands, the client never comes.
TEST_CASE("streaming and preemption: the recurrence, asked for, folds uploads in and leaves the client out") {
  const Scene scene = row_of_textures();
  RunSpec spec;
  spec.scene = parse_spec("test");
  spec.policy = parse_spec("full-detail");
  spec.target_s = 0.05;
  const RunResult bare = run(spec, scene);
  spec.effects = {parse_spec(row_streaming(0)), parse_spec("preemption:period=3ms")};
  spec.engine.kind = EngineKind::recurrence;
  const RunResult asked = run(spec, scene);
  CHECK(asked.left_out.size() == 2);
  CHECK(bare.left_out.empty());
  CHECK(asked.records[0].fidelity == 1);
  CHECK(asked.records[0].upload_bytes == 8 * kMiB);
  CHECK(sum_of(asked, &FrameRecord::preempted_ps) == 0);
  CHECK(asked.records[0].latency_ps > bare.records[0].latency_ps);
}
