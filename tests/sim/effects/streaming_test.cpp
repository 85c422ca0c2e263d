#include <fmt/format.h>

#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

constexpr std::int64_t ns = 1000;  // picoseconds; at 1 GB/s a byte takes one
using Column = std::vector<std::int64_t>;

constexpr std::uint32_t kMade = 100;  // items of this type number and above bring facts of their own

// Three types of one level: 1,000, 2,000 and 3,000 bytes of texture and nothing else; a command takes 1 us in the first
// stage.
EffectRun three_textures() {
  EffectRun run;
  run.machine.algorithm[static_cast<std::size_t>(Algorithm::flat)] = {.draw_s = 1e-6};
  run.machine.clear_s = 50e-6;
  for (const double bytes : {1000.0, 2000.0, 3000.0}) {
    ObjectType type{.name = "box"};
    type.levels = {Facts{.texture_bytes = bytes, .algorithm = Algorithm::flat}};
    run.scene.types.push_back(type);
  }
  run.scene.instances = 10;
  run.scene.fixed_facts = true;
  return run;
}

// What is drawn: the static facts of that number, or, from kMade on, facts made for this frame with made bytes of
// texture.
struct Item {
  std::uint32_t id = 0, facts = 0;
  double made_bytes = 0;
};

// A run with the effect: what its frames upload.
class Streamed {
 public:
  explicit Streamed(const std::string& settings, EffectRun run = three_textures())
      : run_(std::move(run)), effect_(make_effect(("streaming:bandwidth=1," + settings).c_str())) {
    effect_->on_machine(run_.machine);
    effect_->prepare(run_.context());
  }

  CommandColumns frame(const std::vector<Item>& items) {
    const Machine machine(run_.machine);
    Workload workload = static_facts();
    Selection selection;
    selection.reset(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      add(items[i], workload);
      selection.level[i] = 0;
      selection.resolution[i] = 1;
    }
    CommandColumns commands;
    machine.command(workload, selection, commands);
    effect_->on_commands({.frame = frame_++, .workload = workload, .selection = selection, .machine = machine},
                         commands);
    REQUIRE(commands.upload_ps.size() == items.size() + 1);
    REQUIRE(commands.fetch_ps.size() == items.size() + 1);
    return commands;
  }

  // Bytes uploaded for each item (1 GB/s: a byte is a nanosecond), the clear left out.
  Column bytes(const std::vector<Item>& items) {
    const CommandColumns commands = frame(items);
    CHECK(commands.upload_ps[0] == 0);
    Column bytes;
    std::int64_t sum = 0;
    for (std::size_t i = 1; i < commands.upload_ps.size(); ++i) {
      bytes.push_back(commands.upload_ps[i] / ns);
      sum += bytes.back();
    }
    CHECK(commands.upload_bytes == sum);
    return bytes;
  }

  void start_again() { effect_->prepare(run_.context()); }
  const MachineProfile& machine() const { return run_.machine; }

 private:
  Workload static_facts() const {
    Workload workload;
    workload.types = run_.scene.types;
    for (const ObjectType& type : run_.scene.types) {
      workload.facts.insert(workload.facts.end(), type.levels.begin(), type.levels.end());
    }
    workload.static_facts = static_cast<std::uint32_t>(workload.facts.size());
    workload.level_begin = {0};
    return workload;
  }

  static void add(const Item& item, Workload& workload) {
    const bool made = item.facts >= kMade;
    workload.id.push_back(InstanceId{item.id});
    workload.type.push_back(TypeId{0});
    workload.kind.push_back(ItemKind::levels);
    workload.projected_area_px.push_back(100);
    workload.facts_begin.push_back(made ? static_cast<std::uint32_t>(workload.facts.size()) : item.facts);
    workload.level_begin.push_back(workload.level_begin.back() + 1);
    if (!made) return;
    workload.facts.push_back(Facts{.texture_bytes = item.made_bytes, .algorithm = Algorithm::flat});
  }

  EffectRun run_;
  std::unique_ptr<Effect> effect_;
  std::int64_t frame_ = 0;
};

// Of a scene with these facts only, all of which the first frame uploads.
std::int64_t bytes_of(const Facts& facts, const std::string& settings) {
  EffectRun run = three_textures();
  run.scene.types.resize(1);
  run.scene.types[0].levels = {facts};
  return Streamed("preload=no," + settings, run).bytes({{0, 0}}).front();
}

std::string memory(double bytes) { return fmt::format("memory={}", bytes / (1 << 20)); }  // in MiB

}  // namespace

// 100 vertices of 32 bytes, 50 polygons of 12 (three indices of 4), 1,000 bytes of texture: 3200 + 600 + 1000 = 4800.
TEST_CASE("a representation is its vertices, its indices and its textures") {
  const Facts facts{.polygons = 50, .vertices = 100, .texture_bytes = 1000};
  CHECK(bytes_of(facts, "memory=1") == 4800);
  CHECK(bytes_of(facts, "vertex-bytes=16") == 3200);
  CHECK(bytes_of(facts, "polygon-bytes=6") == 4500);
  // 5 lines of two vertices and 7 points of one, and a polygon's indices: 100 + 70 + 12.
  CHECK(bytes_of({.polygons = 1, .lines = 5, .points = 7}, "vertex-bytes=10") == 182);
  // A splat or a point is a vertex without indices.
  CHECK(bytes_of({.polygons = 9, .algorithm = Algorithm::splats}, "vertex-bytes=10") == 90);
  CHECK(bytes_of({.polygons = 9, .vertices = 9, .algorithm = Algorithm::points}, "vertex-bytes=10") == 90);
  // Rounded up once, as a whole: 0.25*10 + 0.25*12 = 5.5.
  CHECK(bytes_of({.polygons = 0.25, .vertices = 0.25}, "vertex-bytes=10") == 6);
}

TEST_CASE("a missing representation is uploaded once for all its instances, in submission order") {
  Streamed run("preload=no,memory=1");
  CHECK(run.bytes({{0, 1}, {1, 0}, {2, 1}, {3, 0}}) == Column{2000, 1000, 0, 0});
  CHECK(run.bytes({{0, 1}, {1, 0}, {2, 2}}) == Column{0, 0, 3000});
  CHECK(run.bytes({}) == Column{});
  CHECK(run.bytes({{5, 0}, {6, 1}, {7, 2}}) == Column{0, 0, 0});
}

// At 2.5 GB/s 1,000 bytes take 400 ns; at 3 GB/s 333.3..., of which a started picosecond counts.
TEST_CASE("an upload takes its bytes over the bandwidth, rounded up to a picosecond") {
  const auto upload_ps = [](const char* spec_text) {
    EffectRun run = three_textures();
    const auto effect = make_effect(spec_text);
    effect->on_machine(run.machine);
    effect->prepare(run.context());
    Workload workload;
    workload.facts = run.scene.types[0].levels;
    workload.static_facts = 1;
    workload.id = {InstanceId{0}};
    const Machine machine(run.machine);
    CommandColumns commands;
    commands.submit_ps = commands.primitive_ps = commands.pixel_ps = {0};
    commands.item = {0};
    commands.facts = {0};
    effect->on_commands({.frame = 0, .workload = workload, .selection = {}, .machine = machine}, commands);
    return commands.upload_ps[0];
  };
  CHECK(upload_ps("streaming:preload=no,bandwidth=2.5") == 400'000);
  CHECK(upload_ps("streaming:preload=no,bandwidth=3") == 333'334);
}

// 5,000 bytes hold 0 and 2 (4,000) or 1 and 2 (5,000), not all (6,000): 2 comes and 0 goes, as the oldest; and so on
// around.
TEST_CASE("a memory smaller than what is drawn in turn uploads everything again and again") {
  Streamed thrashing("preload=no," + memory(5000));
  CHECK(thrashing.bytes({{0, 0}, {1, 1}, {2, 2}}) == Column{1000, 2000, 3000});
  for (int k = 0; k < 5; ++k) CHECK(thrashing.bytes({{0, 0}, {1, 1}, {2, 2}}) == Column{1000, 2000, 3000});
  Streamed enough("preload=no," + memory(6000));
  CHECK(enough.bytes({{0, 0}, {1, 1}, {2, 2}}) == Column{1000, 2000, 3000});
  for (int k = 0; k < 5; ++k) CHECK(enough.bytes({{0, 0}, {1, 1}, {2, 2}}) == Column{0, 0, 0});
}

TEST_CASE("what is larger than the memory is uploaded by each command that draws it") {
  Streamed run("preload=no," + memory(2500));
  CHECK(run.bytes({{0, 2}, {1, 1}, {2, 2}}) == Column{3000, 2000, 3000});
  CHECK(run.bytes({{0, 2}, {1, 1}, {2, 2}}) == Column{3000, 0, 3000});
}

// The table is 1,000, 2,000, 3,000 bytes: into 4,500 go the first two, into 1,500 the first. What was loaded first is the
// oldest.
TEST_CASE("before the first frame the memory takes in table order what still fits") {
  const std::vector<Item> all = {{0, 0}, {1, 1}, {2, 2}};
  CHECK(Streamed("memory=1").bytes(all) == Column{0, 0, 0});
  CHECK(Streamed(memory(6000)).bytes(all) == Column{0, 0, 0});
  CHECK(Streamed(memory(4500)).bytes(all) == Column{0, 0, 3000});
  CHECK(Streamed(memory(1500)).bytes(all) == Column{0, 2000, 3000});
  // Past the second, which does not fit into what is left, the table's third may: here 1,000 + 1,000 of 2,500.
  EffectRun small_last = three_textures();
  small_last.scene.types[2].levels[0].texture_bytes = 1000;
  CHECK(Streamed(memory(2500), small_last).bytes({{0, 0}, {2, 2}, {1, 1}}) == Column{0, 0, 2000});
  Streamed around(memory(4500));
  CHECK(around.bytes({{2, 2}}) == Column{3000});  // evicts 0, and 1 as well: 2,000 + 3,000 is more than 4,500
  CHECK(around.bytes({{0, 0}}) == Column{1000});
  CHECK(around.bytes({{1, 1}}) == Column{2000});  // 3,000 + 1,000 + 2,000: the third goes
  CHECK(around.bytes({{0, 0}, {1, 1}}) == Column{0, 0});
}

TEST_CASE("facts made for a frame belong to their instance and are moved anew when their size changes") {
  EffectRun changing = three_textures();
  changing.scene.fixed_facts = false;
  Streamed run("memory=1", changing);
  CHECK(run.bytes({{4, kMade, 500}, {5, kMade, 500}}) == Column{500, 500});
  CHECK(run.bytes({{5, kMade, 500}, {4, kMade, 700}}) == Column{0, 700});  // wherever they lie in the frame's table
  CHECK(run.bytes({{9, kMade, 500}, {4, kMade, 700}, {0, 0}}) == Column{500, 0, 0});
  // 1,000 bytes of table and the instance's 1,400 go into 2,500; 2,000 do not.
  Streamed tight(memory(2500), changing);
  CHECK(tight.bytes({{4, kMade, 1400}, {0, 0}}) == Column{1400, 0});
  CHECK(tight.bytes({{4, kMade, 2000}}) == Column{2000});
  CHECK(tight.bytes({{0, 0}}) == Column{1000});
}

// A draw's own 400 bytes are 400 ns at 1 GB/s: less than the stage's 1 us and the grant of 1 KiB. 5,000 are more than
// both.
TEST_CASE("a draw's own fetch is at most one grant and never longer than its stage") {
  const auto fetch = [](const std::string& settings, double draw_s) {
    EffectRun run = three_textures();
    run.machine.algorithm[static_cast<std::size_t>(Algorithm::flat)].draw_s = draw_s;
    return Streamed("preload=no," + settings, run).frame({{0, 0}, {1, 1}}).fetch_ps;
  };
  CHECK(fetch("fetch=400,chunk=1", 1e-6) == Column{0, 400 * ns, 400 * ns});
  CHECK(fetch("fetch=5000,chunk=4", 1e-6) == Column{0, 1000 * ns, 1000 * ns});
  CHECK(fetch("fetch=5000,chunk=4", 1e-3) == Column{0, 4096 * ns, 4096 * ns});
  CHECK(fetch("fetch=0", 1e-6) == Column{0, 0, 0});
}

TEST_CASE("the bus of the machine has the chunk's time and the arbitration") {
  const Bus bus = Streamed("chunk=2,arbitration=uploads-first").machine().bus;
  CHECK(bus.chunk.count() == 2048 * ns);
  CHECK(bus.arbitration == Arbitration::uploads_first);
  CHECK(Streamed("chunk=2,arbitration=in-order").machine().bus.arbitration == Arbitration::in_order);
  CHECK(Streamed("chunk=2").machine().bus.arbitration == Arbitration::draws_first);
  CHECK(make_effect("streaming")->hooks() == (Hook::machine | Hook::commands));
}

TEST_CASE("durations stay as they were, and a new run begins with the memory as at first") {
  Streamed run("preload=no,memory=1");
  const CommandColumns first = run.frame({{0, 0}, {1, 1}});
  CHECK(first.primitive_ps == Column{0, 1000 * ns, 1000 * ns});
  CHECK(first.pixel_ps[0] == 50'000 * ns);
  CHECK(run.bytes({{0, 0}, {1, 1}}) == Column{0, 0});
  run.start_again();
  CHECK(run.bytes({{0, 0}, {1, 1}}) == Column{1000, 2000});
}

// All three types together have 6,000 bytes.
TEST_CASE("streaming is inert where everything fits and is loaded, or nothing has bytes, and says why") {
  const auto inert = [](const std::string& spec_text, const EffectRun& run) {
    return make_effect(spec_text.c_str())->inert(run.context());
  };
  EffectRun run = three_textures();
  CHECK(inert("streaming", run)->find("in the memory before the first frame") != std::string::npos);
  CHECK(inert("streaming:" + memory(6000), run));
  CHECK_FALSE(inert("streaming:" + memory(5999), run));
  CHECK_FALSE(inert("streaming:preload=no", run));
  run.scene.fixed_facts = false;  // what will be needed is not known
  CHECK_FALSE(inert("streaming", run));
  run = three_textures();
  run.machine.overlap = parse_overlap("serial");
  CHECK(inert("streaming:preload=no,memory=0", run)->find("serial is a closed form") != std::string::npos);
  run = three_textures();
  for (ObjectType& type : run.scene.types) type.levels[0].texture_bytes = 0;
  CHECK(inert("streaming:preload=no,memory=0", run)->find("any bytes") != std::string::npos);
}

// A continuous type of 1,000 bytes has entries for x = 1, 1/4, 1/2 and 1 again with three stand-ins; each may be that
// large.
TEST_CASE("stand-ins of a continuous type count towards what must fit") {
  EffectRun run = three_textures();
  run.scene.types.resize(1);
  run.scene.types[0].continuous = true;
  run.scene.types[0].stand_in_levels = 3;
  CHECK(make_effect(("streaming:" + memory(4000)).c_str())->inert(run.context()));
  CHECK_FALSE(make_effect(("streaming:" + memory(3999)).c_str())->inert(run.context()));
}

TEST_CASE("inert, it uploads and fetches nothing, and a machine without a bus has no columns for it") {
  Streamed fits("memory=1");
  const CommandColumns commands = fits.frame({{0, 0}, {1, 2}});
  CHECK(commands.upload_ps == Column{0, 0, 0});
  CHECK(commands.fetch_ps == Column{0, 0, 0});
  EffectRun serial = three_textures();
  serial.machine.overlap = parse_overlap("serial");
  const auto effect = make_effect("streaming:preload=no,memory=0");
  effect->on_machine(serial.machine);
  CHECK(serial.machine.bus.chunk.count() == 0);
  effect->prepare(serial.context());
  CommandColumns bare;
  const Machine machine(serial.machine);
  machine.command({}, {}, bare);
  effect->on_commands({.frame = 0, .workload = {}, .selection = {}, .machine = machine}, bare);
  CHECK(bare.upload_ps.empty());
  CHECK(bare.facts.empty());
}

TEST_CASE("streaming refuses numbers that are none of its own") {
  for (const char* wrong : {"streaming:bandwidth=0", "streaming:memory=-1", "streaming:chunk=0.5", "streaming:fetch=-1",
                            "streaming:arbitration=fair", "streaming:preload=maybe", "streaming:bus=3"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}

// What it does depends on all commands and their durations: on a fade's further ones, and on what jitter and heat made
// of them.
TEST_CASE("streaming applies behind all effects that change commands") {
  std::vector<std::string_view> order;
  for (const EffectEntry& entry : effects()) {
    if (entry.name == "cross-fade" || entry.name == "jitter" || entry.name == "thermal" || entry.name == "streaming") {
      order.push_back(entry.name);
    }
  }
  CHECK(order == std::vector<std::string_view>{"cross-fade", "jitter", "thermal", "streaming"});
}
