// Constants of a machine from measured frames.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/fit/fit.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

double value_of(const FrameRow& row, MeasuredColumn column) { return row.value[static_cast<std::size_t>(column)]; }

MeasuredColumn column_of(const ConstantInfo& constant) {
  constexpr std::pair<std::string_view, MeasuredColumn> kColumns[] = {
      {"commands", MeasuredColumn::commands},
      {"draws", MeasuredColumn::draws},
      {"polygons", MeasuredColumn::polygons},
      {"vertices", MeasuredColumn::vertices},
      {"texture_bytes", MeasuredColumn::texture_bytes},
      {"pixels", MeasuredColumn::pixels},
      {"pixels_squared", MeasuredColumn::pixels_squared},
      {"visibility_tests", MeasuredColumn::visibility_tests},
      {"operations", MeasuredColumn::operations}};
  for (const auto& [name, column] : kColumns) {
    if (name == constant.column) return column;
  }
  FRAMESIM_CHECK(false, std::string(constant.name));
  return MeasuredColumn::cpu;
}

// What a constant multiplies in a row; once a row: 1.
double count_of(const ConstantInfo& constant, const FrameRow& row) {
  if (constant.column.empty()) return 1;
  const double count = value_of(row, column_of(constant));
  if (constant.of_machine == &MachineProfile::submit_draw_s) {
    return std::max(0.0, count - value_of(row, MeasuredColumn::commands));
  }
  return count;
}

bool has_column(const FrameRows& rows, const ConstantInfo& constant) {
  return constant.column.empty() || rows.has_column(column_of(constant));
}

bool is_gpu(CostSide side) { return side == CostSide::primitive || side == CostSide::pixel || side == CostSide::swap; }

// Which of the three measured columns have an equation, and what the model takes for a side that is not modelled.
struct Equations {
  bool cpu = false, gpu = false, frame = false;
  bool models_cpu = false, models_gpu = false;
};

class FrameModel {
 public:
  FrameModel(const FitRequest& request, const FrameRows& rows) : rows_(rows) {
    choose_constants(request);
    for (std::size_t c = 0; c < constant_infos().size(); ++c) {
      // A constant without its column, and a side of which nothing is fitted or counted, is not in the model.
      base_.push_back(has_column(rows, constant_infos()[c]) ? constant_of(request.machine, c) : 0);
    }
    choose_equations();
    if (equations_.models_gpu && constant_of(request.machine, find_constant("area_exponent")) > 0) {
      throw InputError({rows.file, 1}, fmt::format("machine '{}' has an area_exponent, and rows of frames do not tell "
                                                   "what each draw covers: start from a machine without, or fit runs",
                                                   request.machine.name));
    }
    if (fits(CostSide::overlap) || request.machine.overlap.kind != OverlapKind::staged) return;
    if (equations_.frame && cpu_known() && gpu_known()) {
      throw InputError({rows.file, 1},
                       fmt::format("the overlap of machine '{}' is {}, which has no s: fit 'overlap' too, "
                                   "or start from a machine with max-plus-s:S",
                                   request.machine.name, to_string(request.machine.overlap)));
    }
  }

  const std::vector<std::size_t>& constants() const { return constants_; }
  const Equations& equations() const { return equations_; }

  // By equation, then by row.
  std::vector<double> residuals(std::span<const double> x) const {
    std::vector<double> all = base_;
    for (std::size_t j = 0; j < constants_.size(); ++j) all[constants_[j]] = x[j];
    std::vector<double> cpu, gpu, frame;
    for (const FrameRow& row : rows_.rows) {
      const double t_cpu = equations_.models_cpu ? modelled_cpu(row, all) : 0;
      const double t_gpu = equations_.models_gpu ? modelled_gpu(row, all) : 0;
      if (equations_.cpu) cpu.push_back(t_cpu / value_of(row, MeasuredColumn::cpu) - 1);
      if (equations_.gpu) gpu.push_back(t_gpu / value_of(row, MeasuredColumn::gpu) - 1);
      if (!equations_.frame) continue;
      const double t_l = rows_.has_column(MeasuredColumn::cpu) ? value_of(row, MeasuredColumn::cpu) : t_cpu;
      const double t_r = rows_.has_column(MeasuredColumn::gpu) ? value_of(row, MeasuredColumn::gpu) : t_gpu;
      const double time = std::max(t_l, t_r) + all[find_constant("overlap")] * std::min(t_l, t_r);
      frame.push_back(time / value_of(row, MeasuredColumn::frame) - 1);
    }
    cpu.insert(cpu.end(), gpu.begin(), gpu.end());
    cpu.insert(cpu.end(), frame.begin(), frame.end());
    return cpu;
  }

  // Where constant `c` starts: so that it alone would make up `share` of the mean of what is measured.
  FitConstant start(std::size_t c, double share) const {
    const ConstantInfo& info = constant_infos()[c];
    FitConstant constant{.name = std::string(info.name), .start = 0, .low = 0, .high = info.high, .scale = 1};
    if (info.side == CostSide::overlap) {
      constant.start = 1.0 / 3;
      return constant;
    }
    Moments counts, times;
    for (const FrameRow& row : rows_.rows) {
      counts.add(count_of(info, row));
      times.add(measured(row, info.side));
    }
    if (info.of_algorithm == &AlgorithmCosts::pixel_nonlinearity) {
      constant.scale = 0.1;
    } else {
      constant.scale = times.mean() / (counts.mean() > 0 ? counts.mean() : 1);
    }
    constant.start = std::min(constant.scale * share / static_cast<double>(constants_.size()), constant.high);
    return constant;
  }

 private:
  bool fits(CostSide side) const {
    return std::any_of(constants_.begin(), constants_.end(),
                       [&](std::size_t c) { return constant_infos()[c].side == side; });
  }
  bool cpu_known() const { return rows_.has_column(MeasuredColumn::cpu) || equations_.models_cpu; }
  bool gpu_known() const { return rows_.has_column(MeasuredColumn::gpu) || equations_.models_gpu; }

  double measured(const FrameRow& row, CostSide side) const {
    const MeasuredColumn own = is_gpu(side) ? MeasuredColumn::gpu : MeasuredColumn::cpu;
    return value_of(row, rows_.has_column(own) ? own : MeasuredColumn::frame);
  }

  void choose_constants(const FitRequest& request) {
    for (const std::string& name : request.constants) {
      const std::size_t c = find_constant(name);
      if (std::find(constants_.begin(), constants_.end(), c) != constants_.end()) {
        throw UsageError(fmt::format("--constants: '{}' is there twice", name));
      }
      if (constant_infos()[c].side == CostSide::runs) {
        throw InputError({rows_.file, 1}, fmt::format("'{}' needs rows of runs: columns scene, policy, target", name));
      }
      if (!has_column(rows_, constant_infos()[c])) {
        throw InputError({rows_.file, 1}, fmt::format("'{}' needs the column '{}'", name, constant_infos()[c].column));
      }
      constants_.push_back(c);
    }
    if (constants_.empty()) choose_by_columns();
    std::sort(constants_.begin(), constants_.end());
  }

  // CPU constants where CPU time is measured apart; once-a-row ones where a side has counts at all, but for the
  // clear, which
  // the swap stands for.
  void choose_by_columns() {
    const bool cpu = rows_.has_column(MeasuredColumn::cpu), frame = rows_.has_column(MeasuredColumn::frame);
    const bool gpu = rows_.has_column(MeasuredColumn::gpu);
    bool cpu_counts = false, gpu_counts = false;
    for (std::size_t c = 0; c < constant_infos().size(); ++c) {
      const ConstantInfo& info = constant_infos()[c];
      if (info.column.empty() || !has_column(rows_, info)) continue;
      if (info.side == CostSide::cpu ? !cpu : !gpu && !frame) continue;
      (info.side == CostSide::cpu ? cpu_counts : gpu_counts) = true;
      constants_.push_back(c);
    }
    if (cpu_counts) constants_.push_back(find_constant("frame_setup"));
    if (gpu_counts) constants_.push_back(find_constant("swap"));
    if (frame && cpu && (gpu || gpu_counts)) constants_.push_back(find_constant("overlap"));
  }

  void choose_equations() {
    const bool cpu = rows_.has_column(MeasuredColumn::cpu), gpu = rows_.has_column(MeasuredColumn::gpu);
    const bool fits_gpu = fits(CostSide::primitive) || fits(CostSide::pixel) || fits(CostSide::swap);
    equations_.models_cpu = fits(CostSide::cpu);
    equations_.models_gpu = fits_gpu;
    equations_.cpu = cpu && equations_.models_cpu;
    equations_.gpu = gpu && fits_gpu;
    const bool unmeasured = (equations_.models_cpu && !cpu) || (fits_gpu && !gpu);
    equations_.frame = rows_.has_column(MeasuredColumn::frame) && (fits(CostSide::overlap) || unmeasured);
    if (constants_.empty()) {
      throw InputError({rows_.file, 1},
                       "no constant can be found from these columns; needed are a measured time (cpu_s, gpu_s "
                       "or frame_s) and counts of what took it, or all three times for the overlap");
    }
    if (unmeasured && !equations_.frame)
      throw InputError({rows_.file, 1}, "the constants need a column that measures them: cpu_s, gpu_s or frame_s");
    if (!fits(CostSide::overlap)) return;
    if (!rows_.has_column(MeasuredColumn::frame))
      throw InputError({rows_.file, 1}, "'overlap' needs the column 'frame_s'");
    if (!cpu_known() || !gpu_known()) {
      throw InputError({rows_.file, 1}, fmt::format("'overlap' needs {} time too: the column '{}', or constants of it",
                                                    cpu_known() ? "GPU" : "CPU", cpu_known() ? "gpu_s" : "cpu_s"));
    }
  }

  static double sum_of(CostSide side, const FrameRow& row, const std::vector<double>& all) {
    double sum = 0;
    for (std::size_t c = 0; c < all.size(); ++c) {
      const ConstantInfo& info = constant_infos()[c];
      if (info.side == side && all[c] != 0) sum += all[c] * count_of(info, row);
    }
    return sum;
  }
  static double modelled_cpu(const FrameRow& row, const std::vector<double>& all) {
    return value_of(row, MeasuredColumn::logic) + sum_of(CostSide::cpu, row, all);
  }
  static double modelled_gpu(const FrameRow& row, const std::vector<double>& all) {
    const double k = all[find_constant("pixel_nonlinearity")];
    const double pixels =
        value_of(row, MeasuredColumn::pixels) + k * value_of(row, MeasuredColumn::pixels_squared) / kReferenceArea_px;
    const double pixel = all[find_constant("clear")] + all[find_constant("pixel")] * pixels;
    return std::max(sum_of(CostSide::primitive, row, all), pixel) + all[find_constant("swap")];
  }

  const FrameRows& rows_;
  std::vector<std::size_t> constants_;
  std::vector<double> base_;
  Equations equations_;
};

// The model is a maximum of linear ones, so a fit may end where the wrong side is the longer: it starts from several
// shares.
NonlinearFit best_fit(const FrameModel& model, const Residuals& residuals, const FitSettings& settings,
                      std::vector<FitConstant>& constants) {
  std::optional<NonlinearFit> best;
  for (const CostSide large : {CostSide::swap, CostSide::cpu, CostSide::primitive, CostSide::pixel}) {
    std::vector<FitConstant> starts;
    for (const std::size_t c : model.constants()) {
      starts.push_back(model.start(c, constant_infos()[c].side == large ? 3.0 : 0.7));
    }
    NonlinearFit fit = minimise(residuals, starts, settings);
    if (!best || fit.squares < best->squares) {
      best = std::move(fit);
      constants = std::move(starts);
    }
  }
  return *best;
}

// sigma of one command if a frame of n alike varies by `deviation`: the factors are independent.
double command_jitter(const FrameRows& rows, double deviation) {
  if (!rows.has_column(MeasuredColumn::commands)) return 0;
  Moments commands;
  for (const FrameRow& row : rows.rows) commands.add(value_of(row, MeasuredColumn::commands));
  return deviation * std::sqrt(commands.mean());
}

}  // namespace

MachineFit fit_frames(const FitRequest& request, const FrameRows& rows) {
  const FitSettings settings{.confidence = request.confidence, .where = {rows.file, 1}};
  if (rows.rows.empty()) throw InputError(settings.where, "no rows to fit");
  const FrameModel model(request, rows);
  const Residuals residuals = [&](std::span<const double> x) { return model.residuals(x); };
  std::vector<FitConstant> constants;
  NonlinearFit numbers = best_fit(model, residuals, settings, constants);
  add_intervals(residuals, constants, settings, numbers);
  MachineFit fit = describe_fit(request, model.constants(), numbers);
  fit.from = rows.file;
  fit.rows = fmt::format("{} frames", rows.rows.size());
  auto next = numbers.residuals.begin();
  const auto column = [&](bool there, const char* name) {
    if (!there) return;
    const auto end = next + static_cast<std::ptrdiff_t>(rows.rows.size());
    describe_column(fit, name, {next, end});
    next = end;
  };
  column(model.equations().cpu, "cpu_s");
  column(model.equations().gpu, "gpu_s");
  column(model.equations().frame, "frame_s");
  fit.jitter_command = command_jitter(rows, fit.jitter.value);
  return fit;
}

}  // namespace framesim
