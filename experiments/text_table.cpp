// The table that people read: which policy holds its target, and at what price.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "experiments/blocks.h"
#include "experiments/table.h"

namespace framesim {
namespace {

constexpr std::size_t kOverviewColumns = 6;  // scenes side by side before a new block begins

struct Cell {
  std::string text;
  std::string_view color;  // escape sequence, or empty
};

constexpr std::string_view kGreen = "\033[32m", kRed = "\033[31m", kReset = "\033[0m";

// Rows of cells with the columns lined up: the first `left` to the left, the others to the right.
class Grid {
 public:
  Grid(std::size_t left, bool color) : left_(left), color_(color) {}

  void add(std::vector<Cell> row) {
    if (widths_.size() < row.size()) widths_.resize(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) widths_[i] = std::max(widths_[i], row[i].text.size());
    rows_.push_back(std::move(row));
  }

  std::string text() const {
    std::string out;
    for (const auto& row : rows_) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i) line += "  " + padded(row[i], i);
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + '\n';
    }
    return out;
  }

 private:
  std::string padded(const Cell& cell, std::size_t column) const {
    const std::string space(widths_[column] - cell.text.size(), ' ');
    const bool colored = color_ && !cell.color.empty();
    const std::string text = colored ? fmt::format("{}{}{}", cell.color, cell.text, kReset) : cell.text;
    return column < left_ ? text + space : space + text;
  }

  std::size_t left_;
  bool color_;
  std::vector<std::size_t> widths_;
  std::vector<std::vector<Cell>> rows_;
};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string block_title(const RunResult& r) {
  std::string title =
      fmt::format("{}, target {} ({:.4g} fps), {:.0f} frames; machine {}, overlap {}, estimator {}", r.scene,
                  show_target(r.target_s), 1 / r.target_s, r.summary.frames, r.machine, r.overlap, r.estimator);
  if (!r.effects.empty()) title += ", effects " + joined(r.effects);
  return title + '\n';
}

// The title has the frames, and format_error_parts() the parts of the error.
bool in_text_table(const SummaryColumn& column) {
  static constexpr std::array kElsewhere = {&Summary::frames, &Summary::err_estimator, &Summary::err_planner,
                                            &Summary::err_selection, &Summary::over_budget};
  return std::find(kElsewhere.begin(), kElsewhere.end(), column.value) == kElsewhere.end();
}

Cell holds_cell(const RunResult& r) {
  return holds(r) ? Cell{"yes", kGreen} : Cell{fmt::format("NO {:.2f}x", r.summary.p95_s / r.target_s), kRed};
}

std::string block_text(const Block& block, bool color) {
  Grid grid(2, color);
  std::vector<Cell> headings = {{"policy", ""}, {"holds", ""}}, units = {{"", ""}, {"", ""}};
  for (const SummaryColumn& column : summary_columns()) {
    if (!in_text_table(column)) continue;
    headings.push_back({show_heading(column), ""});
    units.push_back({std::string(show_unit(column)), ""});
  }
  grid.add(headings);
  grid.add(units);
  for (const RunResult* r : block) {
    std::vector<Cell> row = {{r->policy, ""}, holds_cell(*r)};
    for (const SummaryColumn& column : summary_columns()) {
      if (in_text_table(column)) row.push_back({show_cell(column, r->summary), ""});
    }
    grid.add(std::move(row));
  }
  return block_title(*block.front()) + grid.text() + '\n';
}

// Policies in the order of their first run.
std::vector<std::string> policies_of(std::span<const RunResult> results) {
  std::vector<std::string> names;
  for (const RunResult& r : results) {
    if (std::find(names.begin(), names.end(), r.policy) == names.end()) names.push_back(r.policy);
  }
  return names;
}

std::string overview(std::span<const Block> blocks, const std::vector<std::string>& policies, bool color) {
  Grid grid(1 + blocks.size(), color);
  std::vector<Cell> scenes = {{"policy", ""}}, targets = {{"", ""}};
  for (const Block& block : blocks) {
    scenes.push_back({block.front()->scene, ""});
    targets.push_back({show_target(block.front()->target_s), ""});
  }
  grid.add(scenes);
  grid.add(targets);
  for (const std::string& policy : policies) {
    std::vector<Cell> row = {{policy, ""}};
    for (const Block& block : blocks) {
      const auto run =
          std::find_if(block.begin(), block.end(), [&](const RunResult* r) { return r->policy == policy; });
      row.push_back(run == block.end() ? Cell{"NA", ""} : holds_cell(**run));
    }
    grid.add(std::move(row));
  }
  return grid.text();
}

// "robin-hood 6/6, ..., full-detail 0/6", those that hold most first.
std::string reading(std::span<const RunResult> results, const std::vector<std::string>& policies) {
  struct Score {
    std::string policy;
    long held = 0, runs = 0;
  };
  std::vector<Score> scores;
  for (const std::string& policy : policies) {
    Score score{policy};
    for (const RunResult& r : results) {
      if (r.policy != policy) continue;
      ++score.runs;
      if (holds(r)) ++score.held;
    }
    scores.push_back(score);
  }
  std::stable_sort(scores.begin(), scores.end(), [](const Score& a, const Score& b) { return a.held > b.held; });
  std::string text;
  for (const Score& s : scores) text += fmt::format("{}{} {}/{}", text.empty() ? "" : ", ", s.policy, s.held, s.runs);
  return text;
}

}  // namespace

std::string format_text_table(std::span<const RunResult> results, bool color) {
  const std::vector<Block> blocks = blocks_of(results);
  const std::vector<std::string> policies = policies_of(results);
  std::string text;
  for (const Block& block : blocks) text += block_text(block, color);
  if (blocks.size() > 1) {
    text += "Which policies hold the target (NO: the 95th percentile of frame time as a multiple of the target)\n";
    for (std::size_t i = 0; i < blocks.size(); i += kOverviewColumns) {
      const std::size_t n = std::min(kOverviewColumns, blocks.size() - i);
      text += overview(std::span(blocks).subspan(i, n), policies, color) + '\n';
    }
  }
  text += fmt::format("Targets held (95th percentile of frame time at most {:.2f} times the target): {}.\n",
                      kHoldTolerance, reading(results, policies));
  return text;
}

}  // namespace framesim
