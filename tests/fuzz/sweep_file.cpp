// Sweep files, read down to the parts of every run; none is run.
#include <cctype>

#include "experiments/store/sweep_spec.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

namespace {

// A sweep may have a million runs, and a scene a million instances: legal, but slow here.
bool has_large_number(std::string_view text) {
  int digits = 0;
  for (const char c : text) {
    digits = std::isdigit(static_cast<unsigned char>(c)) ? digits + 1 : 0;
    if (digits > 2) return true;
  }
  return text.find("0x") != std::string_view::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  if (has_large_number(text)) return -1;
  const std::string path = fuzz::as_file(text, "sweep.toml");
  Sweep sweep;
  if (!fuzz::accepts([&] { sweep = read_sweep(path); })) return 0;
  fuzz::require(static_cast<std::int64_t>(sweep.runs.size()) <= kMostRuns, "runs within the limit");
  return 0;
}
