// Random staged pipelines from a seed: machine shape and the work of all frames.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/engine.h"
#include "sim/random_stream.h"

namespace framesim::test {

// A machine with these FIFO capacities and frames in flight, and no costs.
inline MachineProfile staged(int primitive_fifo, int pixel_fifo, int frames_in_flight) {
  MachineProfile machine;
  machine.primitive_fifo = primitive_fifo;
  machine.pixel_fifo = pixel_fifo;
  machine.overlap.frames_in_flight = frames_in_flight;
  return machine;
}

// The three engines of a machine that does one frame after the other: recurrence, events, and the closed form of no overlap.
inline std::vector<std::unique_ptr<Engine>> serial_engines() {
  std::vector<std::unique_ptr<Engine>> engines;
  MachineProfile machine = staged(2, 2, 1);
  engines.push_back(make_engine(machine, {.kind = EngineKind::recurrence}));
  engines.push_back(make_engine(machine, {.kind = EngineKind::events}));
  machine.overlap = {.kind = OverlapKind::serial, .serial_share = 1};
  engines.push_back(make_engine(machine, {.kind = EngineKind::automatic}));
  return engines;
}

// SplitMix64 (Steele, Lea, Flood 2014): small, and the same on every platform.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // low..high, both included. The bias of the remainder does not matter here.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(int percent) { return between(1, 100) <= percent; }

 private:
  std::uint64_t state_;
};

struct PipelineFrame {
  std::int64_t cpu_before = 0, swap = 0, vsync_period = 0;
  CommandColumns commands;
  FrameWork work() const { return {Picoseconds(cpu_before), Picoseconds(swap), Picoseconds(vsync_period), commands}; }
};

struct Pipeline {
  MachineProfile machine;
  std::vector<PipelineFrame> frames;
  bool jittered = false;
};

inline void add_command(CommandColumns& commands, std::int64_t submit, std::int64_t primitive, std::int64_t pixel) {
  commands.submit_ps.push_back(submit);
  commands.primitive_ps.push_back(primitive);
  commands.pixel_ps.push_back(pixel);
}

// A frame of commands {submit, primitive, pixel}, without vsync.
inline PipelineFrame make_frame(std::int64_t cpu_before, std::int64_t swap,
                                const std::vector<std::array<std::int64_t, 3>>& commands) {
  PipelineFrame frame{.cpu_before = cpu_before, .swap = swap, .vsync_period = 0, .commands = {}};
  for (const auto& [submit, primitive, pixel] : commands) add_command(frame.commands, submit, primitive, pixel);
  return frame;
}

// Each stage time of each command times e^(0.3 n), n standard normal: what the effect jitter does.
inline void jitter(std::uint64_t seed, Pipeline& pipeline) {
  const RandomStream stream(seed, "jitter");
  pipeline.jittered = true;
  for (std::size_t k = 0; k < pipeline.frames.size(); ++k) {
    CommandColumns& commands = pipeline.frames[k].commands;
    std::uint32_t lane = 0;
    for (auto* column : {&commands.submit_ps, &commands.primitive_ps, &commands.pixel_ps}) {
      for (std::uint32_t i = 0; i < column->size(); ++i) {
        (*column)[i] = std::llround(static_cast<double>((*column)[i]) * std::exp(0.3 * stream.normal(k, i, lane)));
      }
      ++lane;
    }
  }
}

// FIFOs of 1..64 (half of them 1..3), 1..4 frames in flight, 1..12 frames of 1..40 commands. Durations are up to 3, 20, 10^6
// or 10^12 ps: small ones make ties frequent. A third of the pipelines has vsync, with a period from far below to far
// above the frame time, so that blanks are missed; some change period and swap from frame to frame. A third is jittered.
inline Pipeline random_pipeline(std::uint64_t seed) {
  SplitMix random(seed);
  Pipeline pipeline;
  const auto fifo = [&] { return static_cast<int>(random.between(1, random.chance(50) ? 3 : 64)); };
  pipeline.machine.primitive_fifo = fifo();
  pipeline.machine.pixel_fifo = fifo();
  pipeline.machine.overlap.frames_in_flight = static_cast<int>(random.between(1, 4));
  constexpr std::int64_t kScales[] = {3, 20, 1'000'000, 1'000'000'000'000};
  const std::int64_t scale = kScales[random.between(0, 3)];
  // Each stage has its own load, so that each is the bottleneck of some pipelines.
  const std::int64_t submit = random.between(0, scale), primitive = random.between(0, scale);
  const std::int64_t pixel = random.between(0, scale), before = random.between(0, 20 * scale);
  const int zeros = random.chance(30) ? 50 : 5;
  const auto duration = [&](std::int64_t most) { return random.chance(zeros) ? 0 : random.between(0, most); };
  const bool vsync = random.chance(33), varying = random.chance(20);
  const std::int64_t longest = random.between(1, 60), period = random.between(1, 2 * scale * longest);
  const std::int64_t swap = random.between(0, scale);
  const std::int64_t frames = random.between(1, 12);
  for (std::int64_t k = 0; k < frames; ++k) {
    PipelineFrame& frame = pipeline.frames.emplace_back();
    frame.cpu_before = duration(before);
    frame.swap = varying ? duration(4 * scale) : swap;
    if (vsync) frame.vsync_period = varying ? random.between(0, period) : period;
    const std::int64_t commands = random.between(1, 40);
    for (std::int64_t i = 0; i < commands; ++i) {
      const std::int64_t of_submit = duration(submit);  // one after the other: the order of arguments is the compiler's
      const std::int64_t of_primitive = duration(primitive), of_pixel = duration(pixel);
      add_command(frame.commands, of_submit, of_primitive, of_pixel);
    }
  }
  if (random.chance(33)) jitter(seed, pipeline);
  return pipeline;
}

}  // namespace framesim::test
