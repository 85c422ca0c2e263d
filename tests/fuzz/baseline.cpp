// Tables of an earlier comparison that a new one is set beside.
#include "experiments/statistics/baseline.h"

#include "tests/fuzz/fuzz.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = fuzz::as_file(fuzz::text_of(data, size), "baseline.csv");
  std::vector<WatchedRow> rows;
  if (!fuzz::accepts([&] { rows = read_baseline(path); })) return 0;
  const BaselineCheck check = check_baseline(rows, rows, 0);
  fuzz::require(check.worse == 0 && check.better == 0 && check.is_new == 0, "a table is as good as itself");
  format_baseline(check, path, 0);
  return 0;
}
