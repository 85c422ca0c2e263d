// gnuplot as a filter: script in, picture out; no temporary files.
#pragma once

#include <string>

namespace framesim {

// What gnuplot writes to standard output for `script`. Throws UsageError if gnuplot is not installed, InternalError
// with gnuplot's own words if it does not like the script.
std::string run_gnuplot(const std::string& script);

// Throws UsageError if there is no gnuplot; called before long work.
void require_gnuplot();

// `text` as a gnuplot string constant.
std::string gnuplot_string(const std::string& text);

}  // namespace framesim
