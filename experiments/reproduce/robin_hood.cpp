// Robin Hood's algorithm for time-critical level of detail, Graphicon 2005: table 2 and section 7.1; figure 4 and
// section 7.2 have files of their own.
//
// Fitted: constants of the machine, to the five linear rows of table 2 (machine profile graphicon2005-fitted says
// which, and how). Predicted: everything else.
#include "experiments/reproduce/robin_hood.h"

#include <fmt/format.h>

#include <algorithm>

namespace framesim {
namespace robin_hood {

RunSpec forest_run(std::string_view scene, std::string_view policy, double target_s) {
  RunSpec spec = scene_run(fmt::format("graphicon-forest:{}", scene), policy, target_s);
  spec.machine = parse_spec(kMachine, {"reproduce"});
  spec.estimator = parse_spec("table", {"reproduce"});
  return spec;
}

std::string target_name(double target_s) { return fmt::format("{:g} ms", target_s * 1e3); }

void add_rows(Reproduction& out, const PublishedTable& table, std::size_t row, const Summary& simulated,
              const Summary& certified, const ReproducedRow& form) {
  const auto add = [&](std::string_view quantity, std::string_view unit, std::string_view column,
                       double Summary::*value, std::optional<ReproduceTarget> target) {
    ReproducedRow next = form;
    next.quantity = quantity;
    next.unit = unit;
    next.published = table.number(row, column);
    next.simulated = simulated.*value;
    next.target = target;
    next.certified = certified.*value;
    out.rows.push_back(std::move(next));
  };
  add("mean", "s", "mean_s", &Summary::mean_s, ReproduceTarget{ReproduceTarget::Kind::relative, 0.02});
  add("deviation", "s", "stddev_s", &Summary::stddev_s, std::nullopt);
  add("AvgErr", "", "avg_err", &Summary::avg_err, kErrorTarget);
}

namespace {

// ---- Table 2 ----

struct TableRun {
  std::string path;
  double target_s;
  std::size_t robin_hood, certified;  // places in the runs
};

// How many of the rows [first, out.rows.size()) of that quantity on that path are inside their target.
double inside(const Reproduction& out, std::string_view path, std::string_view quantity) {
  return static_cast<double>(std::count_if(out.rows.begin(), out.rows.end(), [&](const ReproducedRow& row) {
    return row.figure == "table 2" && row.item.starts_with(path) && row.quantity == quantity &&
           verdict(row) == Verdict::inside;
  }));
}

// Of the steps from one target to the next longer one, beginning with 25 ms: how many lower AvgErr.
struct Falls {
  double published = 0, simulated = 0, steps = 0;
};

Falls falls(const Reproduction& out, std::string_view path) {
  Falls falls;
  const ReproducedRow* before = nullptr;
  for (const ReproducedRow& row : out.rows) {
    if (row.figure != "table 2" || !row.item.starts_with(path) || row.quantity != "AvgErr") continue;
    if (before) {
      falls.steps += 1;
      falls.published += *row.published < *before->published;
      falls.simulated += row.simulated < before->simulated;
    }
    if (before || row.item.starts_with(fmt::format("{} 25 ms", path))) before = &row;
  }
  return falls;
}

// The rows of AvgErr in which certified is nearer to the target than Robin Hood, both simulated.
void count_beaten(Reproduction& out) {
  double rows = 0, beaten = 0;
  for (const ReproducedRow& row : out.rows) {
    if (row.figure != "table 2" || row.quantity != "AvgErr") continue;
    rows += 1;
    beaten += *row.certified < row.simulated;
  }
  out.rows.push_back({.figure = "table 2",
                      .item = "both paths, certified",
                      .quantity = fmt::format("AvgErr below Robin Hood's, of {:g}", rows),
                      .simulated = beaten,
                      .target = ReproduceTarget{ReproduceTarget::Kind::at_least, rows}});
}

void summarise_table(Reproduction& out) {
  count_beaten(out);
  for (const char* path : {"linear", "zigzag"}) {
    const Falls steps = falls(out, path);
    out.rows.push_back({.figure = "table 2",
                        .item = std::string(path) + " 25 to 200 ms",
                        .quantity = fmt::format("falls of AvgErr, of {:g}", steps.steps),
                        .published = steps.published,
                        .simulated = steps.simulated,
                        .target = ReproduceTarget{ReproduceTarget::Kind::at_least, steps.steps}});
  }
  for (const char* quantity : {"mean", "AvgErr"}) {
    out.rows.push_back({.figure = "table 2",
                        .item = "zigzag, predicted",
                        .quantity = fmt::format("{} inside, of 5", quantity),
                        .simulated = inside(out, "zigzag", quantity),
                        .target = ReproduceTarget{ReproduceTarget::Kind::at_least, 4}});
  }
}

void table_2(SceneRuns& runs, Reproduction& out) {
  const PublishedTable table("robin_hood_table2");
  std::vector<TableRun> list;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    TableRun next{.path = table.text(row, "path"), .target_s = table.number(row, "target_s")};
    next.robin_hood = runs.add(forest_run("path=" + next.path, kPlain, next.target_s));
    next.certified = runs.add(forest_run("path=" + next.path, kCertified, next.target_s));
    list.push_back(std::move(next));
  }
  runs.run();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const TableRun& run = list[row];
    add_rows(out, table, row, runs[run.robin_hood].summary, runs[run.certified].summary,
             {.figure = "table 2",
              .item = fmt::format("{} {}, {}", run.path, target_name(run.target_s),
                                  run.path == "linear" ? "fitted" : "predicted")});
  }
  summarise_table(out);
}

// ---- 1,000 and 2,000 trees: "almost identical" ----

void more_trees(SceneRuns& runs, Reproduction& out) {
  const PublishedTable table("robin_hood_table2");
  struct Pair {
    std::size_t row, base, more;
    int trees;
  };
  std::vector<Pair> pairs;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "path") != "linear") continue;
    const double target_s = table.number(row, "target_s");
    const std::size_t base = runs.add(forest_run("path=linear", kPlain, target_s));
    for (const int trees : {1000, 2000}) {
      pairs.push_back(
          {row, base, runs.add(forest_run(fmt::format("path=linear,trees={}", trees), kPlain, target_s)), trees});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.trees < b.trees; });
  runs.run();
  for (const Pair& pair : pairs) {
    const Summary &base = runs[pair.base].summary, &more = runs[pair.more].summary;
    const ReproducedRow form{
        .figure = "section 7.1",
        .item = fmt::format("{} trees, {}", pair.trees, target_name(table.number(pair.row, "target_s")))};
    ReproducedRow mean = form, error = form;
    mean.quantity = "mean over that of 600, less 1";
    mean.unit = "%";
    mean.published = 0;
    mean.simulated = 100 * (more.mean_s / base.mean_s - 1);
    mean.target = ReproduceTarget{ReproduceTarget::Kind::absolute, 2};
    error.quantity = "AvgErr less that of 600";
    error.published = 0;
    error.simulated = more.avg_err - base.avg_err;
    error.target = kErrorTarget;
    out.rows.push_back(std::move(mean));
    out.rows.push_back(std::move(error));
  }
}

void reproduce_robin_hood(const ReproduceContext& context, Reproduction& out) {
  SceneRuns runs(context);
  out.remarks.push_back(
      "Machine graphicon2005-fitted: area_exponent and submit fitted to the five linear rows of table 2, so that those "
      "rows are no prediction; the numbers of all others are. Planner: the paper's equations 5 to 7 with C = 1; "
      "estimator: its benchmark tables. Why frames fall short: a primitive takes the longer the more is covered of its "
      "tree, by a power of 0.04; tables hold that for complete trees, parts of them cover less and take less than "
      "planned. That a power does this, and not a term that is quadratic in pixels or a set-up that pixels hide, was "
      "seen on both paths. Certified: miss-rate=50, as AvgErr counts short frames like long ones.");
  table_2(runs, out);
  figure_4(runs, out);
  section_72(context, runs, out);
  more_trees(runs, out);
  out.remarks.push_back("Figure 4: a step near a turn counts as a jump if it is at least twice the largest elsewhere.");
  out.remarks.push_back(
      "Section 7.2: no row of table 2 says what lines and points cost, and levels are estimated whole, so that hardly "
      "anything falls short here. The paper's reason, that function 11 sometimes gives near trees more than they can "
      "use, is looked for in the worst frame, since in the mean over frames it is below 0.4 %; it shows on the zigzag "
      "path. On the straight path of the paper's test no tree, as placed here, is that near.");
  out.remarks.push_back(
      "Section 7.1: \"almost identical\" is read as: the mean within 2 % of that of 600 trees, AvgErr within 0.02; "
      "published is 0. With 2,000 trees on the same square fewer are complete, so more falls short; and at 12.5 ms "
      "equations 5 to 7 take the CPU time of the additional trees off the time for drawing, though the pipeline hides "
      "most of it.");
}

}  // namespace
}  // namespace robin_hood

ReproducedDocument robin_hood_document() {
  return {.name = "robin-hood",
          .title = "Robin Hood's algorithm for time-critical level of detail, Graphicon 2005",
          .reproduce = robin_hood::reproduce_robin_hood};
}

}  // namespace framesim
