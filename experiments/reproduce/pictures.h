// The papers' figures, drawn from our runs: SVG by gnuplot.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/reproduce/reproduce.h"

namespace framesim {

struct Picture {
  std::string name;    // of the file, without ".svg": "robin-hood-figure-3"
  std::string script;  // for gnuplot, which writes the SVG to standard output
};

// Runs what the pictures of `document` need and draws them. Every document has at least one.
std::vector<Picture> reproduced_pictures(const ReproducedDocument& document, const ReproduceContext& context);

// Draws them into `folder`, which must exist. Returns the paths in the order written. Throws UsageError without
// gnuplot.
std::vector<std::string> write_pictures(std::span<const Picture> pictures, const std::string& folder);

}  // namespace framesim
