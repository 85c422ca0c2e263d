// Runs of the documents that their pictures show too.
#pragma once

#include <array>
#include <string_view>

#include "experiments/run.h"

namespace framesim {

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
