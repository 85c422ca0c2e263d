// What framesim fit reads: frames, of which a machine's constants are fitted, and runs, which are only read.
#include "experiments/fit/fit.h"
#include "scenes/registry.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

namespace {

// One constant, by the number of rows: a fit takes long, and tries are to be many.
void fit(const FrameRows& rows) {
  constexpr const char* kConstants[] = {"frame_setup",        "submit",        "polygon",
                                        "pixel_nonlinearity", "area_exponent", "overlap"};
  const FitRequest request{.machine = {}, .constants = {kConstants[rows.rows.size() % std::size(kConstants)]}};
  fuzz::accepts([&] {
    const MachineFit fit = fit_frames(request, rows);
    format_fit(fit, TableFormat::json);
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = fuzz::as_file(fuzz::text_of(data, size), "measured.csv");
  bool runs = false;
  if (!fuzz::accepts([&] { runs = is_run_file(path); })) return 0;
  if (runs) {
    fuzz::accepts([&] { read_measured_runs(path, {}); });
    return 0;
  }
  FrameRows rows;
  for (const int window : {3, 1}) {
    if (!fuzz::accepts([&] { rows = read_frame_rows(path, window); })) return 0;
  }
  if (rows.rows.size() <= 12) fit(rows);
  return 0;
}
