// PORT: policies from a shared library, loaded at run time (`--plugin libmine.so`) or linked into a program of one's own.
//
// A plug-in is one file: a policy written as in policies/, and behind it
//
//     FRAMESIM_PLUGIN("mine", add(mine_policy()))      // add(...) once for each policy
//
// It is compiled against the installed headers and links to nothing of framesim: what it calls is found in the program
// that loads it. C++ gives no promise about layouts across compilers and versions, so a plug-in says what it was compiled
// with, and one that does not fit is refused before any of its code runs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/policy.h"

namespace framesim {

// Raised when a port changes in a way that the sizes below do not show.
inline constexpr std::uint32_t kPluginInterface = 1;

// Of the types that cross the border, mixed into one number.
constexpr std::uint64_t plugin_layout() {
  std::uint64_t mixed = kPluginInterface;
  for (const std::size_t size : {sizeof(Workload), sizeof(Selection), sizeof(PolicyTraits), sizeof(PolicyScene),
                                 sizeof(FrameContext), sizeof(FrameOutcome), sizeof(PolicyEntry), sizeof(ParameterInfo),
                                 sizeof(Setting), sizeof(ObjectType), sizeof(Facts), sizeof(void*)}) {
    mixed = mixed * 1'000'003 + size;
  }
  return mixed;
}

using AddPolicy = void (*)(PolicyEntry entry);

// Plain data at a fixed place in the library, so that it can be read and judged before anything is called. `magic` and
// `interface` stay the first two members for ever.
struct PluginInfo {
  std::uint32_t magic = kMagic;
  std::uint32_t interface = kPluginInterface;
  std::uint64_t layout = plugin_layout();
  const char* name = "";
  void (*register_policies)(AddPolicy add) = nullptr;

  static constexpr std::uint32_t kMagic = 0x6d697366;  // "fsim"
};

}  // namespace framesim

// In a namespace of its own file: defines the symbol that a loader looks for.
#define FRAMESIM_PLUGIN(plugin_name, ...)                                                       \
  extern "C" __attribute__((visibility("default"))) const framesim::PluginInfo framesim_plugin; \
  const framesim::PluginInfo framesim_plugin = {.name = plugin_name,                            \
                                                .register_policies = [](framesim::AddPolicy add) { __VA_ARGS__; }};
