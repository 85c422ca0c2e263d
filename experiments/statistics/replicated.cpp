#include "experiments/statistics/replicated.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/cells.h"
#include "experiments/statistics/paired.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr double kLevel = 0.05;

// What must agree for policies to stand side by side. The planner may differ: it belongs to the policy.
std::string conditions(const RunResult& r) {
  std::string text = fmt::format("{}, target {}, machine {}, overlap {}, estimator {}", r.scene,
                                 show_target(r.target_s), r.machine, r.overlap, r.estimator);
  if (!r.effects.empty()) text += fmt::format(", effects {}", fmt::join(r.effects, " "));
  return text;
}

// One policy beside the best of its block.
struct Line {
  const Replicated* run = nullptr;
  std::string name;  // the policy; with its planner where it is there under several
  std::vector<double> errors;
  Estimate error;
  PairedTest against_best;  // of the best: nothing
  std::optional<double> holm_p;
  std::optional<Ratio> times;
  std::int64_t held = 0;
};

struct SideBySide {
  std::string title;
  double target_s = 0;      // exact, where the title has it rounded
  std::vector<Line> lines;  // the best first
};

Line make_line(const Replicated& run) {
  Line line;
  line.run = &run;
  line.name = run.parts.policy;
  for (const Summary& summary : run.summaries) {
    line.errors.push_back(summary.avg_err);
    line.held += summary.p95_s <= kHoldTolerance * run.parts.target_s;
  }
  line.error = estimate(line.errors);
  return line;
}

void name_planners(std::vector<Line>& lines) {
  for (Line& line : lines) {
    const std::string& policy = line.run->parts.policy;
    const auto same = [&](const Line& other) { return other.run->parts.policy == policy; };
    if (std::count_if(lines.begin(), lines.end(), same) > 1) line.name = policy + " by " + line.run->parts.planner;
  }
}

void set_beside_best(std::vector<Line>& lines, const InputLocation& where) {
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.error.mean < b.error.mean; });
  const Line& best = lines.front();
  std::vector<std::optional<double>> p_values;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    Line& line = lines[i];
    if (line.run->seeds != best.run->seeds) {
      throw InputError(where,
                       fmt::format("policies {} and {} were run with different seeds, or not all runs are there; "
                                   "differences are paired by seed",
                                   framesim::quoted(best.name), framesim::quoted(line.name)));
    }
    line.against_best = paired_test(best.errors, line.errors);
    line.times = ratio(line.error, best.error);
    p_values.push_back(line.against_best.t_p);
  }
  adjust_holm(p_values);
  for (std::size_t i = 1; i < lines.size(); ++i) lines[i].holm_p = p_values[i - 1];
}

std::vector<SideBySide> side_by_side(std::span<const Replicated> runs, const InputLocation& where) {
  std::vector<SideBySide> blocks;
  for (const Replicated& run : runs) {
    const std::string title = conditions(run.parts);
    const double target_s = run.parts.target_s;
    auto block = std::find_if(blocks.begin(), blocks.end(),
                              [&](const SideBySide& b) { return b.title == title && b.target_s == target_s; });
    if (block == blocks.end()) block = blocks.insert(blocks.end(), {title, target_s, {}});
    block->lines.push_back(make_line(run));
  }
  for (SideBySide& block : blocks) {
    name_planners(block.lines);
    set_beside_best(block.lines, where);
  }
  return blocks;
}

std::string percent(double share) { return fmt::format("{:.3f}", 100 * share); }
std::string half(const Estimate& e) { return e.half_width ? "± " + percent(*e.half_width) : "NA"; }

std::string p_text(std::optional<double> p) {
  if (!p) return "NA";
  return *p < 1e-4 ? "<0.0001" : fmt::format("{:.4f}", *p);
}

// Padding counts characters, not the bytes of "±".
std::string right(const std::string& text, std::size_t width) {
  std::size_t shown = 0;
  for (const char c : text) shown += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  return std::string(width > shown ? width - shown : 0, ' ') + text;
}

std::string seeds_text(const Replicated& run) {
  return fmt::format("{} seed{}, {} to {}", run.seeds.size(), run.seeds.size() == 1 ? "" : "s", run.seeds.front(),
                     run.seeds.back());
}

std::string table_text(const SideBySide& block) {
  std::size_t width = 6;
  for (const Line& line : block.lines) width = std::max(width, line.name.size());
  std::string text = fmt::format("{}; {}\n", block.title, seeds_text(*block.lines.front().run));
  text += fmt::format("  {:<{}} {:>9} {:>10} {:>10} {:>10}   {:>10} {:>10} {:>9} {:>9} {:>9}\n", "policy", width,
                      "holds", "AvgErr, %", "95 %", "std dev", "over best", "95 %", "worse in", "p (t)", "p (sign)");
  for (const Line& line : block.lines) {
    const Estimate& e = line.error;
    text += fmt::format("  {:<{}} {:>9} {} {} {}", line.name, width, fmt::format("{}/{}", line.held, e.count),
                        right(percent(e.mean), 10), right(half(e), 10),
                        right(e.count > 1 ? percent(e.deviation) : "NA", 10));
    if (&line != &block.lines.front()) {
      const PairedTest& test = line.against_best;
      text += fmt::format("   {} {} {:>9} {:>9} {:>9}", right(percent(test.difference.mean), 10),
                          right(half(test.difference), 10), fmt::format("{}/{}", test.higher, e.count),
                          p_text(line.holm_p), p_text(test.sign_p));
    }
    text += '\n';
  }
  return text;
}

std::string verdict(const Line& line) {
  if (!line.holm_p) return line.against_best.difference.count < 2 ? "one seed says nothing about chance" : "no spread";
  return *line.holm_p < kLevel ? "beaten" : "not told apart";
}

std::string verdict_text(const SideBySide& block) {
  if (block.lines.size() < 2) return "";
  std::string text = fmt::format("  {} ran\n", block.lines.front().name);
  for (std::size_t i = 1; i < block.lines.size(); ++i) {
    const Line& line = block.lines[i];
    const std::string times =
        line.times ? fmt::format("{:8.2f} ± {:.2f} times", line.times->value, line.times->deviation) : "      NA times";
    text += fmt::format("  {} closer to the target than {} ({})\n", times, line.name, verdict(line));
  }
  return text;
}

constexpr std::string_view kExplanation =
    "Intervals are 95 % confidence intervals of the mean (Student's t). 'over best': difference of AvgErr to the first "
    "line,\n"
    "seed by seed. p (t): paired t test, adjusted for the number of policies (Holm); p (sign): sign test, each by "
    "itself.\n"
    "beaten: p (t) under 0.05. NA: fewer than two seeds, or no spread (nothing that runs draws from the seed).\n";

std::string number(std::optional<double> value) { return value ? fmt::format("{}", *value) : "NA"; }

Cells as_cells(std::span<const SideBySide> blocks) {
  Cells cells;
  cells.names = {"scene",
                 "policy",
                 "target_s",
                 "machine",
                 "overlap",
                 "planner",
                 "estimator",
                 "effects",
                 "seeds",
                 "first_seed",
                 "held",
                 "avg_err",
                 "stddev",
                 "half_width_95",
                 "best",
                 "over_best",
                 "over_best_half_width_95",
                 "worse_in",
                 "better_in",
                 "p_t",
                 "p_t_holm",
                 "p_sign",
                 "ratio",
                 "ratio_stddev"};
  for (const SideBySide& block : blocks) {
    for (const Line& line : block.lines) {
      const RunResult& r = line.run->parts;
      const PairedTest& t = line.against_best;
      const bool best = &line == &block.lines.front();
      const auto unless_best = [&](std::optional<double> value) { return best ? std::string("NA") : number(value); };
      cells.rows.push_back({r.scene,
                            r.policy,
                            number(r.target_s),
                            r.machine,
                            r.overlap,
                            r.planner,
                            r.estimator,
                            fmt::format("{}", fmt::join(r.effects, ", ")),
                            fmt::format("{}", line.error.count),
                            fmt::format("{}", line.run->seeds.front()),
                            fmt::format("{}", line.held),
                            number(line.error.mean),
                            number(line.error.deviation),
                            number(line.error.half_width),
                            block.lines.front().name,
                            unless_best(t.difference.mean),
                            unless_best(t.difference.half_width),
                            unless_best(static_cast<double>(t.higher)),
                            unless_best(static_cast<double>(t.lower)),
                            number(t.t_p),
                            number(line.holm_p),
                            number(t.sign_p),
                            line.times ? number(line.times->value) : "NA",
                            line.times ? number(line.times->deviation) : "NA"});
      std::vector<bool>& numbers = cells.numbers.emplace_back(cells.names.size(), true);
      for (const std::size_t text : {0, 1, 3, 4, 5, 6, 7, 14}) numbers[text] = false;
    }
  }
  return cells;
}

}  // namespace

std::vector<Replicated> group_seeds(std::span<const RunResult> results) {
  std::vector<Replicated> groups;
  std::map<std::string, std::size_t> places;
  for (const RunResult& result : results) {
    const std::string key =
        fmt::format("{}\n{}\n{}\n{}", conditions(result), result.target_s, result.policy, result.planner);
    const auto [at, is_new] = places.try_emplace(key, groups.size());
    if (is_new) groups.push_back({result, {}, {}});
    Replicated& group = groups[at->second];
    group.seeds.push_back(result.seed);
    group.summaries.push_back(result.summary);
  }
  return groups;
}

std::string format_replicated(std::span<const Replicated> runs, TableFormat format, const InputLocation& where) {
  const std::vector<SideBySide> blocks = side_by_side(runs, where);
  if (format != TableFormat::text) return format_cells(as_cells(blocks), format);
  std::string text;
  for (const SideBySide& block : blocks) text += table_text(block) + verdict_text(block) + '\n';
  return text + std::string(kExplanation);
}

}  // namespace framesim
