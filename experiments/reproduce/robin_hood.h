// What the parts of Robin Hood's reproduction share: the forest's runs, and rows made of their summaries.
#pragma once

#include <string>
#include <string_view>

#include "experiments/reproduce/published.h"
#include "experiments/reproduce/scene_runs.h"

namespace framesim::robin_hood {

inline constexpr std::string_view kMachine = "graphicon2005-fitted";
inline constexpr std::string_view kPlain = "robin-hood:levels=false,planning=paper";   // section 7.1
inline constexpr std::string_view kWithLevels = "robin-hood:value=11,planning=paper";  // section 7.2
// AvgErr counts short frames like long ones: half of the frames may be late, so that none of the target is left unused.
inline constexpr std::string_view kCertified = "certified:miss-rate=50";
inline constexpr ReproduceTarget kErrorTarget{ReproduceTarget::Kind::absolute, 0.02};

// A run of the built-in forest; `scene` are its parameters. Estimator: the paper's own benchmark, section 4.
RunSpec forest_run(std::string_view scene, std::string_view policy, double target_s);
std::string target_name(double target_s);  // "12.5 ms"

// Mean, deviation and AvgErr of a row of `table`; figure and item are those of `form`.
void add_rows(Reproduction& out, const PublishedTable& table, std::size_t row, const Summary& simulated,
              const Summary& certified, const ReproducedRow& form);

void figure_4(SceneRuns& runs, Reproduction& out);
void section_72(const ReproduceContext& context, SceneRuns& runs, Reproduction& out);

}  // namespace framesim::robin_hood
