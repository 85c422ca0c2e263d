#include "experiments/statistics/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "experiments/csv_row.h"
#include "experiments/store/store.h"
#include "scenes/scene_file.h"
#include "scenes/text_file.h"
#include "sim/quantity.h"
#include "sim/statistics.h"
#include "sim/words.h"

namespace framesim {
namespace {

struct Measure {
  std::string_view name, unit;
  double WatchedRow::*value;
  double scale;  // to what is shown
  bool more_is_worse;
};
constexpr std::array<Measure, 3> kMeasures = {{{"AvgErr", "%", &WatchedRow::avg_err, 100, true},
                                               {"95th percentile", "ms", &WatchedRow::p95_s, 1e3, true},
                                               {"benefit", "%", &WatchedRow::benefit_share, 100, false}}};

bool same_run(const WatchedRow& a, const WatchedRow& b) {
  return a.scene == b.scene && a.policy == b.policy && a.target_s == b.target_s;
}

// Rows of equal names put together, each measure as its mean.
class Means {
 public:
  void add(const WatchedRow& row) {
    auto at = std::find_if(rows_.begin(), rows_.end(), [&](const WatchedRow& other) { return same_run(other, row); });
    if (at == rows_.end()) {
      at = rows_.insert(rows_.end(), row);
      moments_.emplace_back();
    }
    auto& moments = moments_[static_cast<std::size_t>(at - rows_.begin())];
    for (std::size_t i = 0; i < kMeasures.size(); ++i) moments[i].add(row.*kMeasures[i].value);
  }
  std::vector<WatchedRow> rows() const {
    std::vector<WatchedRow> means = rows_;
    for (std::size_t r = 0; r < means.size(); ++r) {
      for (std::size_t i = 0; i < kMeasures.size(); ++i) means[r].*kMeasures[i].value = moments_[r][i].mean();
    }
    return means;
  }

 private:
  std::vector<WatchedRow> rows_;
  std::vector<std::array<Moments, kMeasures.size()>> moments_;
};

WatchedRow row_of(const RunResult& parts, const Summary& summary) {
  return {parts.scene, parts.policy, parts.target_s, summary.avg_err, summary.p95_s, summary.benefit_share};
}

bool is_database(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  std::array<char, 16> head{};
  return file && std::fread(head.data(), 1, head.size(), file.get()) == head.size() &&
         std::string_view(head.data(), 15) == "SQLite format 3";
}

double read_cell(const std::string& text, const InputLocation& where, std::string_view column) {
  if (text == "NA") return std::numeric_limits<double>::quiet_NaN();
  const QuantityResult number = parse_number(text);
  if (!number.value) throw InputError(where, fmt::format("{}: {}", column, number.error));
  return *number.value;
}

// Columns by their names, wherever they stand.
class BaselineTable {
 public:
  BaselineTable(std::vector<std::string> header, const InputLocation& where) : header_(std::move(header)) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const auto at = std::find(header_.begin(), header_.end(), kNames[i]);
      if (at == header_.end()) {
        throw InputError(where, fmt::format("there is no column '{}'; allowed: what 'framesim compare --format csv' "
                                            "writes, or a store",
                                            kNames[i]));
      }
      at_[i] = static_cast<std::size_t>(at - header_.begin());
    }
  }

  WatchedRow row(const std::vector<std::string>& fields, const InputLocation& where) const {
    if (fields.size() != header_.size()) {
      throw InputError(where, fmt::format("{} fields, but the heading has {}", fields.size(), header_.size()));
    }
    const auto number = [&](std::size_t i) { return read_cell(fields[at_[i]], where, kNames[i]); };
    return {fields[at_[0]], fields[at_[1]], number(2), number(3), number(4), number(5)};
  }

 private:
  static constexpr std::array<std::string_view, 6> kNames = {"scene",   "policy", "target_s",
                                                             "avg_err", "p95_s",  "benefit_share"};
  std::vector<std::string> header_;
  std::array<std::size_t, kNames.size()> at_{};
};

std::vector<WatchedRow> read_csv_baseline(const std::string& path) {
  LineReader lines(path, path, kLargestCsvFile, {path});
  std::optional<BaselineTable> table;
  Means means;
  while (const auto line = lines.next()) {
    const InputLocation where{path, lines.line()};
    if (!table && line->starts_with('#')) continue;
    if (!table) {
      table.emplace(split_csv_row(*line), where);
    } else {
      means.add(table->row(split_csv_row(*line), where));
    }
  }
  if (!table) throw InputError({path}, "is empty; allowed: what 'framesim compare --format csv' writes, or a store");
  return means.rows();
}

std::string show_change(const Measure& measure, double was, double is) {
  const std::string by = was != 0 ? fmt::format("{:+.2f} %", 100 * (is - was) / was) : "from nothing";
  return fmt::format("{} {:.4g} {} -> {:.4g} {} ({})", measure.name, was * measure.scale, measure.unit,
                     is * measure.scale, measure.unit, by);
}

void note_changes(RowChange& change, const WatchedRow& before, double threshold) {
  for (const Measure& measure : kMeasures) {
    const double was = before.*measure.value, is = change.row.*measure.value;
    if (!std::isfinite(was) || !std::isfinite(is)) continue;
    const double up = is - was, noise = threshold * std::fabs(was);
    if (!(std::fabs(up) > noise)) continue;
    ((up > 0) == measure.more_is_worse ? change.worse : change.better).push_back(show_change(measure, was, is));
  }
}

std::string row_name(const WatchedRow& row) {
  return fmt::format("{}, {}, {}", row.scene, row.policy, show_target(row.target_s));
}

}  // namespace

std::vector<WatchedRow> watched(std::span<const RunResult> results) {
  Means means;
  for (const RunResult& result : results) means.add(row_of(result, result.summary));
  return means.rows();
}

std::vector<WatchedRow> watched(std::span<const Replicated> runs) {
  Means means;
  for (const Replicated& run : runs) {
    for (const Summary& summary : run.summaries) means.add(row_of(run.parts, summary));
  }
  return means.rows();
}

std::vector<WatchedRow> read_baseline(const std::string& path) {
  if (!is_database(path)) return read_csv_baseline(path);
  const Store store = Store::open(path);
  std::vector<RunResult> results;
  for (StoredRun& run : store.runs()) results.push_back(std::move(run.result));
  const std::vector<Replicated> runs = group_seeds(results);
  std::vector<WatchedRow> rows = watched(runs);
  if (rows.size() == runs.size()) return rows;
  throw InputError({path},
                   "has runs of one scene, policy and target under different conditions (machine, overlap, "
                   "planner, estimator or effects); a baseline has one");
}

double read_noise_threshold(const std::string& text) {
  std::string number = text;
  if (number.ends_with('%')) number.pop_back();
  const QuantityResult percent = parse_number(number);
  if (!percent.value || *percent.value < 0 || *percent.value > 1000) {
    throw UsageError(fmt::format("--noise-threshold: {} is not a share in per cent from 0 to 1000, such as 2%",
                                 framesim::quoted(text)));
  }
  return *percent.value / 100;
}

BaselineCheck check_baseline(std::span<const WatchedRow> now, std::span<const WatchedRow> baseline, double threshold) {
  BaselineCheck check;
  std::size_t found = 0;
  for (const WatchedRow& row : now) {
    RowChange& change = check.rows.emplace_back();
    change.row = row;
    const auto before =
        std::find_if(baseline.begin(), baseline.end(), [&](const WatchedRow& other) { return same_run(other, row); });
    change.is_new = before == baseline.end();
    if (!change.is_new) {
      ++found;
      note_changes(change, *before, threshold);
    }
    check.worse += !change.worse.empty();
    check.better += change.worse.empty() && !change.better.empty();
    check.is_new += change.is_new;
  }
  check.not_run = baseline.size() - found;
  return check;
}

std::string format_baseline(const BaselineCheck& check, const std::string& path, double threshold) {
  std::string text = fmt::format(
      "Beside {}, with up to {:g} % taken for noise: {} rows, {} worse, {} better, {} new; {} "
      "rows of it not run\n",
      path, 100 * threshold, check.rows.size(), check.worse, check.better, check.is_new, check.not_run);
  for (const RowChange& change : check.rows) {
    for (const std::string& measure : change.worse)
      text += fmt::format("  worse   {}: {}\n", row_name(change.row), measure);
    for (const std::string& measure : change.better)
      text += fmt::format("  better  {}: {}\n", row_name(change.row), measure);
    if (change.is_new) text += fmt::format("  new     {}\n", row_name(change.row));
  }
  return text;
}

CheckedSuite baseline_suite(const BaselineCheck& check, const std::string& path) {
  CheckedSuite suite{path, {}};
  for (const RowChange& change : check.rows) suite.cases.push_back({row_name(change.row), change.worse});
  return suite;
}

}  // namespace framesim
