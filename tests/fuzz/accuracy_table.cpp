// Accuracy tables of other builds, which framesim stability --merge reads.
#include "experiments/stability/report.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = fuzz::as_file(fuzz::text_of(data, size), "accuracy.csv");
  std::vector<StabilityColumn> columns;
  if (!fuzz::accepts([&] { columns = read_stability_csvs({path, path}); })) return 0;
  fuzz::require(columns.size() == 2 && differing_rows(columns).empty(), "a table is like itself");
  merged_stability_csv(columns);
  stability_markdown(columns);
  stability_html(columns);
  return 0;
}
