#include "experiments/report/report.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/report/embedded.h"
#include "scenes/registry.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

// What the page's script reads.
nlohmann::json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

// The first value of a column: four bytes, the lowest first, in base64.
float first_float(const std::string& base64) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) bits = bits << 6 | (base64[i] == '=' ? 0 : digits.find(base64[i]));
  const auto byte = [&](int i) { return static_cast<std::uint32_t>(bits >> (40 - 8 * i) & 255); };
  return std::bit_cast<float>(byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24);
}

RunResult one_run(std::string policy, std::uint64_t seed = 1) {
  RunResult run;
  run.scene = "street";
  run.policy = std::move(policy);
  run.target_s = 0.025;
  run.seed = seed;
  run.summary.ngap = std::nan("");
  return run;
}

}  // namespace

TEST_CASE("report: frame times and level shares arrive as they were") {
  if (report_library().empty()) return;  // a build without the chart library makes no page, which the next case tests
  std::vector<RunResult> runs = {one_run("a")};
  runs[0].records.resize(801);
  for (FrameRecord& record : runs[0].records)
    record.frame_time_ps = 16'500'000'000, record.mix_none = 1, record.mix_finest = 3;
  const auto data = data_of(report_page({.runs = runs}));
  const auto& run = data["runs"][0];
  // 801 floats are 3204 bytes; base64 has four letters for each three of them.
  CHECK(run["times"].get<std::string>().size() == 3204 / 3 * 4);
  CHECK(first_float(run["times"]) == 16.5f);
  // 801 frames in at most 400 groups: three frames each, 267 groups. One item of four is not drawn.
  CHECK(run["mix"]["rows"].size() == 267);
  CHECK(run["mix"]["rows"][1] == nlohmann::json::parse("[3, 0.75, 0, 0, 0, 0.25]"));
}

TEST_CASE("report: a page needs the chart library") {
  if (!report_library().empty()) return;
  CHECK_THROWS_AS(report_page({}), InputError);
}

TEST_CASE("report: a column without any value is left out, and a single missing one is null") {
  if (report_library().empty()) return;
  std::vector<RunResult> runs = {one_run("a"), one_run("b")};
  const auto without = data_of(report_page({.runs = runs}));
  runs[1].summary.ngap = 0.5;
  const auto with = data_of(report_page({.runs = runs}));
  CHECK(with["columns"].size() == without["columns"].size() + 1);
  CHECK(with["runs"][0]["ngap"].is_null());
  CHECK(with["runs"][0]["cells"].size() == with["columns"].size());
}

TEST_CASE("report: text of a run cannot end the script that holds it, nor be taken for a place to fill") {
  if (report_library().empty()) return;
  const std::vector<RunResult> runs = {one_run("</script><b>@SCRIPT@")};
  const std::string page = report_page({.runs = runs, .manifest = {{"command", "<!-- @DATA@"}}});
  CHECK(data_of(page)["runs"][0]["label"] == "</script><b>@SCRIPT@");
  CHECK(data_of(page)["manifest"][0][1] == "<!-- @DATA@");
}

TEST_CASE("report: runs of several seeds are told apart, of one seed not") {
  if (report_library().empty()) return;
  CHECK(data_of(report_page({.runs = std::vector<RunResult>{one_run("a")}}))["runs"][0]["label"] == "a");
  const std::vector<RunResult> runs = {one_run("a", 1), one_run("a", 2)};
  CHECK(data_of(report_page({.runs = runs}))["runs"][1]["label"] == "a #2");
}

TEST_CASE("report: the street from above has its objects, its path and what is in view") {
  RunSpec spec{.scene = parse_spec("street"), .policy = parse_spec("full-detail"), .target_s = 0.025};
  const Scene scene = load_scene(spec.scene);
  const SceneView view = look_from_above(spec, scene, 10);
  CHECK(view.x_m.size() == 6);  // six objects
  CHECK(view.thinned == 0);
  CHECK(view.path_m.size() == 40);  // 40 frames
  REQUIRE(view.frames.size() == 10);
  CHECK(view.frames[1].frame == 4);
  for (const SceneView::Frame& frame : view.frames) {
    for (const SceneView::Item& item : frame.items) CHECK(item.fineness == 1);  // everything at its finest
  }
  // At most two of six objects: every third, so of rows 0 to 5 rows 0 and 3.
  const SceneView thin = look_from_above(spec, scene, 10, 2);
  CHECK(thin.thinned == 3);
  CHECK(thin.x_m == std::vector<double>{view.x_m[0], view.x_m[3]});
}
