// PORT: an effect: something a scene or machine may call for and that costs nothing where it is not called for.
// To add one: copy effects/vsync.cpp, add a line to effects/registry.cpp and a test.
//
// An effect names the hooks it uses. The run composes its active effects once, at load, into one short list a hook;
// empty lists cost nothing and the engine has no branch for any of them. An effect that cannot change the result of this
// run says so (`inert`), and is then left out; leaving it out changes no bit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "sim/machine.h"
#include "sim/random_stream.h"
#include "sim/registry.h"

namespace framesim {

enum class Hook : std::uint8_t { frame = 1, commands = 2, present = 4 };
constexpr Hook operator|(Hook a, Hook b) { return static_cast<Hook>(static_cast<int>(a) | static_cast<int>(b)); }
constexpr bool has(Hook set, Hook hook) { return (static_cast<int>(set) & static_cast<int>(hook)) != 0; }

// What effects may change of one frame before it runs.
struct FrameSettings {
  std::int64_t frame = 0;
  Picoseconds logic{0};         // Hook::frame
  Picoseconds vsync_period{0};  // Hook::present; 0 = shown at once
};

class Effect {
 public:
  virtual ~Effect() = default;
  virtual Hook hooks() const = 0;
  // Why this effect cannot change any frame of a run on this machine, or nothing if it can.
  virtual std::optional<std::string> inert(const MachineProfile& machine) const = 0;
  // Hook::frame and Hook::present: before the frame starts.
  virtual void on_frame(FrameSettings&) const {}
  // Hook::commands: on whole columns, after the machine has filled them.
  virtual void on_commands(std::int64_t /*frame*/, CommandColumns&) const {}
};

// Registered in effects/registry.cpp. `seed` is the run's master seed; each effect derives its own stream from it.
using EffectEntry = RegistryEntry<Effect, std::uint64_t>;
std::span<const EffectEntry> effects();

}  // namespace framesim
