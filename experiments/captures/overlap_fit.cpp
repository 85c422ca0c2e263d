#include "experiments/captures/overlap_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/statistics.h"

namespace framesim {
namespace {

struct Window {
  double cpu_ms = 0, gpu_ms = 0, frame_ms = 0;  // means
};

std::vector<Window> windows_of(std::span<const CaptureFrame> frames, long size) {
  std::vector<Window> windows;
  CompensatedSum cpu, gpu, frame;
  long count = 0;
  const auto restart = [&] {
    cpu = gpu = frame = {};
    count = 0;
  };
  for (const CaptureFrame& f : frames) {
    if (!f.cpu_ms || !f.gpu_ms) {
      restart();
      continue;
    }
    cpu.add(*f.cpu_ms);
    gpu.add(*f.gpu_ms);
    frame.add(f.start_ms.value_or(f.frame_ms));
    if (++count < size) continue;
    const auto n = static_cast<double>(size);
    windows.push_back({cpu.value() / n, gpu.value() / n, frame.value() / n});
    restart();
  }
  return windows;
}

// Least squares of T - max = s * min, kept in [0,1]: s = sum min * (T - max) / sum min^2.
double fitted_share(std::span<const Window> windows) {
  CompensatedSum products, squares;
  for (const Window& w : windows) {
    const double least = std::min(w.cpu_ms, w.gpu_ms);
    products.add(least * (w.frame_ms - std::max(w.cpu_ms, w.gpu_ms)));
    squares.add(least * least);
  }
  return squares.value() > 0 ? std::clamp(products.value() / squares.value(), 0.0, 1.0) : 0;
}

// The formula is longer * max + shorter * min.
OverlapError error_of(std::string formula, double longer, double shorter, std::span<const Window> windows) {
  CompensatedSum error, bias;
  for (const Window& w : windows) {
    const double predicted = longer * std::max(w.cpu_ms, w.gpu_ms) + shorter * std::min(w.cpu_ms, w.gpu_ms);
    const double off = (predicted - w.frame_ms) / w.frame_ms;
    error.add(std::abs(off));
    bias.add(off);
  }
  const auto count = static_cast<double>(windows.size());
  return {std::move(formula), error.value() / count, bias.value() / count};
}

}  // namespace

std::vector<OverlapFit> fit_overlap(std::span<const CaptureFrame> frames, std::span<const long> windows) {
  std::vector<OverlapFit> fits;
  for (const long size : windows) {
    const std::vector<Window> means = windows_of(frames, size);
    if (means.size() < 2) continue;
    OverlapFit fit{.window = size, .windows = static_cast<long>(means.size()), .fitted_share = fitted_share(means)};
    fit.errors.push_back(error_of("serial", 1, 1, means));
    fit.errors.push_back(error_of("paper2005", 1, 1.0 / 3, means));
    fit.errors.push_back(error_of("2/3 (cpu + gpu)", 2.0 / 3, 2.0 / 3, means));
    fit.errors.push_back(error_of(fmt::format("max-plus-s:{:.3g}", fit.fitted_share), 1, fit.fitted_share, means));
    fit.errors.push_back(error_of("max", 1, 0, means));
    fits.push_back(std::move(fit));
  }
  return fits;
}

}  // namespace framesim
