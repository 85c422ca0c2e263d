// Runs of the documents that their pictures show too.
#pragma once

#include <array>
#include <string_view>

#include "experiments/run.h"

namespace framesim {

// Robin Hood 2005. Two machines: one with costs read off the paper's curves, and one fitted to its table 2.
struct RobinHoodMachine {
  std::string_view name;
  bool fitted;
};
std::array<RobinHoodMachine, 2> robin_hood_machines();
// graphicon-forest with these settings ("path=linear") under any policy; the policy of section 7.1 (no levels of
// detail); and the run of section 7.2 (levels of detail, figures 6 and 7).
RunSpec robin_hood_run(std::string_view scene_settings, std::string_view policy, double target_s,
                       const RobinHoodMachine& machine);
std::string_view robin_hood_plain_policy();
RunSpec robin_hood_levels_run(const RobinHoodMachine& machine);

// Dong et al. 2015: that many trees on a device ("computer1", ...), before and after their method.
RunSpec dong_run(std::string_view device, int trees, bool after);

// Funkhouser and Sequin 1993, section 7: the four algorithms in the order of table 1, on the auditorium at 0.1 s.
inline constexpr double kAuditoriumTarget_s = 0.1;
inline constexpr std::array<std::string_view, 4> kAuditoriumAlgorithms = {"full-detail", "static", "feedback",
                                                                          "funkhouser:rule=incremental"};
RunSpec auditorium_run(std::string_view policy);

// Its viewpoints A, B and C as frames of the path, first and last (scene file).
struct Viewpoint {
  std::string_view name;
  std::size_t first, last;
};
inline constexpr std::array<Viewpoint, 3> kAuditoriumViewpoints = {{{"A", 100, 100}, {"B", 370, 449}, {"C", 450, 475}}};

}  // namespace framesim
