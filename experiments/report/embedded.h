// Files that are compiled in by experiments/report/embed.cmake.
#pragma once

#include <string_view>

namespace framesim {

std::string_view report_html();
std::string_view report_css();
std::string_view report_script();
std::string_view report_library();  // dygraphs with its style sheet; empty if the build did not find it
std::string_view report_library_css();

}  // namespace framesim
