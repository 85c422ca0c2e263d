// What framesim fit reads: frames, of which a machine's constants are fitted, and runs, which are only read.
#include "experiments/fit/fit.h"
#include "scenes/registry.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

namespace {

void fit(const FrameRows& rows) {
  for (const char* constant : {"frame_setup", "submit", "polygon", "pixel_nonlinearity", "overlap"}) {
    const FitRequest request{.machine = {}, .constants = {constant}};
    fuzz::accepts([&] {
      const MachineFit fit = fit_frames(request, rows);
      format_fit(fit, TableFormat::json);
    });
  }
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
  if (rows.rows.size() <= 20) fit(rows);  // small, so that tries are many
  return 0;
}
