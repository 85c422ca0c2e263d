// streaming: what is drawn must lie in the GPU's memory, and gets there over a bus that the draws need too.
//
// Models:  textures and geometry of each representation as one resource of
//              vertices*vertex-bytes + polygons*polygon-bytes + (2*lines + points)*vertex-bytes + texture bytes
//          (points and splats are vertices without indices), moved as a whole at `bandwidth`, also where only a part of
//          a continuous one is drawn. Instances share it: the key is the entry in the scene's table of facts. Facts
//          made for a frame (levels that depend on the view, blocks of a tree) belong to their instance, which holds
//          one such representation at a time: one of another size is another content and is moved anew (a cross-fade
//          between two of them moves both in each frame).
//          A memory of `memory` bytes keeps what was used last: in the order of submission a use refreshes, a miss
//          evicts the least recently used until it fits; what is larger than the memory passes through it at each use.
//          Contents change hands at submission: that an earlier command may still wait to be drawn from what is evicted
//          is neglected. Uploads cross the bus in grants of at most `chunk` bytes, and each command fetches `fetch`
//          bytes of its own (commands, constants) at the beginning of its per-primitive stage, at most one grant and
//          never longer than the stage. Who is served first is the arbitration; event_engine.h has the rules.
//          preload=yes: before the first frame the resources of the table are loaded in its order (types in the scene's
//          order, levels coarse to fine), each that still fits. preload=no: the memory is empty.
// Source:  MODEL section 6 names the effect; the numbers are assumptions of the field. 12 GB/s is what is commonly
//          measured over PCI Express 3.0 x16 (15.75 GB/s in its specification); 64 KiB is the tile in which Direct3D
//          maps streamed textures; a pool of 1 GiB is of the size that game engines give to streaming; 32 bytes
//          are a position, a normal and a texture coordinate in single precision, 12 bytes three 32-bit indices; 4 KiB
//          a draw are a guess.
// Inert:   everything fits into the memory and is loaded before the first frame (or nothing has any bytes), so that
//          there is no upload and nothing to contend with; a closed-form overlap, which has no stages that could wait.
//          Where facts are made for a frame, what will be needed is not known before and the effect stays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/effect.h"
#include "sim/effects/residency.h"

namespace framesim {
namespace {

struct StreamingParameters {
  double bandwidth = 12;  // GB/s, 1 GB = 1e9 bytes
  double memory = 1024;   // MiB
  double chunk = 64;      // KiB
  int arbitration = static_cast<int>(Arbitration::draws_first);
  double vertex_bytes = 32;
  double polygon_bytes = 12;
  double fetch = 4096;  // bytes
  bool preload = true;
};

const ParameterTable<StreamingParameters> kParameters{{
    {"bandwidth",
     &StreamingParameters::bandwidth,
     {.unit = "GB/s", .low = 1e-3, .high = 1e4, .help = "of the bus, in 10^9 bytes a second"}},
    {"memory",
     &StreamingParameters::memory,
     {.unit = "MiB", .low = 0, .high = 1e9, .help = "of the GPU, for textures and geometry"}},
    {"chunk",
     &StreamingParameters::chunk,
     {.unit = "KiB", .low = 1, .high = 1e9, .help = "longest transfer between two decisions who gets the bus"}},
    {"arbitration",
     &StreamingParameters::arbitration,
     {.help = "who gets the bus first: whoever asked first, the draws' fetches, or uploads",
      .words = {kArbitrationNames.begin(), kArbitrationNames.end()}}},
    {"vertex-bytes",
     &StreamingParameters::vertex_bytes,
     {.unit = "B", .low = 0, .high = 4096, .help = "of a vertex; a line has two, a point one"}},
    {"polygon-bytes",
     &StreamingParameters::polygon_bytes,
     {.unit = "B", .low = 0, .high = 4096, .help = "indices of a polygon"}},
    {"fetch",
     &StreamingParameters::fetch,
     {.unit = "B", .low = 0, .high = 1e9, .help = "what each command moves itself; at most a chunk counts"}},
    {"preload", &StreamingParameters::preload, {.help = "fill the memory before the first frame"}},
}};

constexpr double kMostBytes = 1e15;  // of one resource; their sums over a frame stay far inside 64 bits

class Streaming : public Effect {
 public:
  explicit Streaming(const StreamingParameters& parameters)
      : p_(parameters),
        capacity_(static_cast<std::int64_t>(parameters.memory * 0x1p20)),
        chunk_(transfer_ps(parameters.chunk * 0x1p10)),
        fetch_(std::min(transfer_ps(parameters.fetch), chunk_)) {}

  Hook hooks() const override { return Hook::machine | Hook::commands; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    if (context.machine.overlap.kind != OverlapKind::staged) {
      return fmt::format("overlap {} is a closed form: no stage waits for a bus", to_string(context.machine.overlap));
    }
    if (!context.scene.fixed_facts) return std::nullopt;
    const double most = most_bytes(context.scene);
    if (most == 0) return "nothing in the scene has any bytes to move";
    if (!p_.preload || most > static_cast<double>(capacity_)) return std::nullopt;
    return fmt::format("all that can be drawn, at most {:.4g} MiB, is in the memory before the first frame",
                       most * 0x1p-20);
  }

  void prepare(const EffectContext& context) override {
    uploads_ = !inert(context);
    instances_ = context.scene.fixed_facts ? 0 : context.scene.instances;
    static_bytes_.clear();
    loaded_ = false;
  }

  void on_machine(MachineProfile& machine) const override {
    if (machine.overlap.kind != OverlapKind::staged) return;
    machine.bus = {.chunk = Picoseconds(chunk_), .arbitration = static_cast<Arbitration>(p_.arbitration)};
  }

  void on_commands(const DrawnFrame& drawn, CommandColumns& commands) override {
    if (drawn.machine.profile().bus.chunk.count() == 0) return;
    FRAMESIM_CHECK(commands.facts.size() == commands.size(),
                   fmt::format("{} commands, facts of {}", commands.size(), commands.facts.size()));
    const Workload& workload = drawn.workload;
    if (!loaded_) load(workload);
    commands.upload_ps.assign(commands.size(), 0);
    commands.fetch_ps.assign(commands.size(), 0);
    for (std::size_t i = 0; i < commands.size(); ++i) {
      if (commands.item[i] == kClearCommand) continue;
      if (uploads_) commands.fetch_ps[i] = std::min(fetch_, commands.primitive_ps[i]);
      const std::int64_t bytes = use(workload, commands.item[i], commands.facts[i]);
      if (bytes == 0) continue;
      commands.upload_ps[i] = transfer_ps(static_cast<double>(bytes));
      commands.upload_bytes += bytes;
    }
  }

 private:
  std::int64_t transfer_ps(double bytes) const { return ceil_picoseconds(bytes / (p_.bandwidth * 1e9)).count(); }

  double bytes_of(const Facts& facts) const {
    const bool bare = facts.algorithm == Algorithm::points || facts.algorithm == Algorithm::splats;
    const double vertices = bare ? std::max(facts.vertices, facts.polygons) : facts.vertices;
    return std::ceil((vertices + 2 * facts.lines + facts.points) * p_.vertex_bytes +
                     (bare ? 0 : facts.polygons) * p_.polygon_bytes + facts.texture_bytes);
  }

  std::int64_t whole_bytes_of(const Facts& facts) const {
    const double bytes = bytes_of(facts);
    FRAMESIM_CHECK(bytes <= kMostBytes, fmt::format("a representation of {} bytes", bytes));
    return static_cast<std::int64_t>(bytes);
  }

  // What the table of facts can hold at most: all levels, and of a continuous type each of its stand-ins as large as
  // the whole.
  double most_bytes(const SceneFacts& scene) const {
    double sum = 0;
    for (const ObjectType& type : scene.types) {
      double of_type = 0;
      for (const Facts& level : type.levels) of_type += bytes_of(level);
      sum += of_type * (type.continuous ? 1 + std::max(1, type.stand_in_levels) : 1);
    }
    return sum;
  }

  // The first frame's table of facts is that of all frames.
  void load(const Workload& workload) {
    const std::size_t keys = workload.static_facts + instances_;
    FRAMESIM_CHECK(keys < UINT32_MAX, fmt::format("{} resources", keys));
    residency_.reset(static_cast<std::uint32_t>(keys), capacity_);
    for (std::uint32_t key = 0; key < workload.static_facts; ++key) {
      static_bytes_.push_back(whole_bytes_of(workload.facts[key]));
      if (p_.preload) residency_.load(key, static_bytes_.back());
    }
    loaded_ = true;
  }

  // Bytes that have to be moved for drawing these facts.
  std::int64_t use(const Workload& workload, std::uint32_t item, std::uint32_t facts) {
    if (facts < workload.static_facts) return residency_.use(facts, static_bytes_[facts]);
    const std::size_t key = workload.static_facts + index(workload.id[item]);
    return residency_.use(static_cast<std::uint32_t>(key), whole_bytes_of(workload.facts[facts]));
  }

  StreamingParameters p_;
  std::int64_t capacity_;       // bytes
  std::int64_t chunk_, fetch_;  // ps
  std::size_t instances_ = 0;   // that may have facts of their own
  bool uploads_ = false;        // there may be some; else no draw ever waits for the bus, and none needs to ask for it
  bool loaded_ = false;
  std::vector<std::int64_t> static_bytes_;
  Residency residency_;
};

}  // namespace

EffectEntry streaming_effect() {
  return {.name = "streaming",
          .summary = "textures and geometry cross a shared bus into a limited memory, least recently used out first",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Streaming>(kParameters.read(settings));
          }};
}

}  // namespace framesim
