#include "experiments/table.h"

#include "experiments/options.h"
#include "sim/check.h"
#include "tests/catch.h"

namespace framesim {
namespace {

const InputLocation kHere{"command line"};

std::vector<std::string> names(const std::vector<std::string>& texts) {
  std::vector<std::string> list;
  for (const Spec& spec : read_specs(texts, kHere)) list.push_back(to_string(spec));
  return list;
}

RunResult result(std::string policy, double target_s, double p95_s) {
  RunResult r;
  r.scene = "street";
  r.policy = std::move(policy);
  r.target_s = target_s;
  r.summary.frames = 19;
  r.summary.mean_s = 0.0123456;
  r.summary.avg_err = 0.5;
  r.summary.p95_s = p95_s;
  r.records_hash = 0xabc;
  return r;
}

}  // namespace

TEST_CASE("spec lists: a comma begins a new spec unless key=value follows it") {
  CHECK(names({"distance,robin-hood:value=8,levels=no,static"}) ==
        std::vector<std::string>{"distance", "robin-hood:value=8,levels=no", "static"});
  // "b:x=1" has its ':' before the '=', so it is a new spec.
  CHECK(names({"a:x=1,b:x=1,y=2"}) == std::vector<std::string>{"a:x=1", "b:x=1,y=2"});
  CHECK(names({"a", "b,c"}) == std::vector<std::string>{"a", "b", "c"});
}

TEST_CASE("spec lists: an empty entry is refused") {
  CHECK_THROWS_AS(names({"a,,b"}), InputError);
  CHECK_THROWS_AS(names({"a,"}), InputError);
  CHECK_THROWS_AS(names({""}), InputError);
}

TEST_CASE("targets: every unit, and no target that is no time") {
  for (const char* text : {"25ms", "25000us", "25000000ns", "0.025s", "40Hz", "40fps"}) {
    CAPTURE(text);
    CHECK(read_target_s(text, kHere) == Approx(0.025).epsilon(1e-12));
  }
  for (const char* text : {"", "0", "0ms", "-5ms", "25", "25mm", "nan", "infs", "1e9s"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(read_target_s(text, kHere), InputError);
  }
}

TEST_CASE("holds: the limit is 1.10 times the target, itself included") {
  CHECK(holds(result("p", 1.0, 1.10)));
  CHECK_FALSE(holds(result("p", 1.0, 1.1000001)));
}

TEST_CASE("csv table: numbers read back as the same double, specs with commas are quoted") {
  const RunResult r = result("robin-hood:value=8,levels=no", 0.1, 0.3);
  const std::string text = format_table({&r, 1}, TableFormat::csv);
  // 0.1 and 0.0123456 are the shortest decimals of their doubles; the hash has 16 hexadecimal digits.
  CHECK(text.find("\nstreet,\"robin-hood:value=8,levels=no\",0.1,19,0.0123456,") != std::string::npos);
  CHECK(text.find(",0000000000000abc\n") != std::string::npos);
  CHECK(text.starts_with("scene,policy,target_s,frames,mean_s,stddev_s,avg_err,"));
}

TEST_CASE("text table: milliseconds and per cent, and at a glance who holds") {
  const std::vector<RunResult> results = {result("good", 0.025, 0.026), result("bad", 0.025, 0.075)};
  const std::string text = format_table(results, TableFormat::text);
  // 12.3456 ms with two decimals, AvgErr 0.5 as 50.0 %; 75 ms over 25 ms is 3 times.
  CHECK(text.find("12.35") != std::string::npos);
  CHECK(text.find("50.0") != std::string::npos);
  CHECK(text.find("NO 3.00x") != std::string::npos);
  CHECK(text.find("good 1/1, bad 0/1.") != std::string::npos);
  CHECK(text.find('\033') == std::string::npos);
  CHECK(format_table(results, TableFormat::text, true).find("\033[31mNO 3.00x") != std::string::npos);
}

TEST_CASE("markdown and json tables: one row a run, words that would break the form are escaped") {
  const std::vector<RunResult> results = {result("a|b", 0.025, 0.026), result("say \"c\"", 0.025, 0.075)};
  const std::string markdown = format_table(results, TableFormat::markdown);
  CHECK(std::count(markdown.begin(), markdown.end(), '\n') == 4);  // heading, rule, two rows
  CHECK(markdown.find("| a\\|b | yes |") != std::string::npos);
  const std::string json = format_table(results, TableFormat::json);
  CHECK(json.find("\"policy\": \"say \\\"c\\\"\"") != std::string::npos);
  CHECK(json.find("\"holds\": false") != std::string::npos);
}

}  // namespace framesim
