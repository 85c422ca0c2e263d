// framesim check, through the binary: a table that is as it was, one that was doctored, and updating.
#include <string>

#include "tests/catch.h"
#include "tests/experiments/program.h"

namespace framesim {
namespace {

const std::string kFirstLine =
    "# framesim compare --scenes street --policies static,robin-hood:value=9,levels=false --frames 9\n";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A folder with one golden table, freshly made.
void make_table(const TestFolder& folder) {
  folder.write("a.csv", kFirstLine);
  const ProgramRun made = run_program({"check", folder.path(), "--update"});
  CAPTURE(made.out, made.err);
  REQUIRE(made.exit_code == 0);
}

// The table with `from` replaced by `to`, once.
void doctor(const TestFolder& folder, const std::string& from, const std::string& to) {
  std::string text = folder.read("a.csv");
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  folder.write("a.csv", text.replace(at, from.size(), to));
}

}  // namespace

TEST_CASE("golden: a new table is made by --update from its first line, and then agrees") {
  const TestFolder folder;
  make_table(folder);
  const std::string text = folder.read("a.csv");
  CHECK(text.starts_with(kFirstLine + "scene,policy,target_s,frames,"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 4);  // first line, heading, two policies
  const ProgramRun check = run_program({"check", folder.path(), "--jobs", "2"});
  CHECK(check.exit_code == 0);
  CHECK(check.out == "1 tables, 2 rows: 0 differences\n");
  CHECK(folder.names() == std::vector<std::string>{"a.csv"});
}

TEST_CASE("golden: a doctored number is found, named and left alone") {
  const TestFolder folder;
  make_table(folder);
  // The street's default target is 16 ms and the run has 9 frames, of which the first is not measured: 8.
  doctor(folder, "street,static,0.016,8,", "street,static,0.016,7,");
  const std::string doctored = folder.read("a.csv");
  const ProgramRun check = run_program({"check", folder.path()});
  CHECK(check.exit_code == 1);
  CHECK(has(check.out, "scene street, policy static, target 0.016 s, frames: expected 7, found 8\n"));
  CHECK(has(check.out, "1 differences"));
  CHECK(folder.read("a.csv") == doctored);
}

TEST_CASE("golden: a changed hash, a missing row and an extra row are all listed") {
  const TestFolder folder;
  make_table(folder);
  std::string text = folder.read("a.csv");
  text.resize(text.size() - 2);  // the last digit of the last hash, and the line break
  text += "g\n";                 // no hexadecimal digit: cannot be right by chance
  text += text.substr(text.find("\nstreet,static,") + 1,
                      text.find('\n', text.find("\nstreet,static,") + 1) - text.find("\nstreet,static,"));
  folder.write("a.csv", text);
  doctor(folder, "street,static,", "street,statics,");
  const ProgramRun check = run_program({"check", folder.path()});
  CAPTURE(check.out);
  CHECK(check.exit_code == 1);
  CHECK(has(check.out, "policy robin-hood:value=9,levels=false, target 0.016 s, hash: expected "));
  CHECK(has(check.out, "policy statics, target 0.016 s, row: expected present, found absent"));
  CHECK(has(check.out, "2 differences"));
}

TEST_CASE("golden: --update mends a doctored table") {
  const TestFolder folder;
  make_table(folder);
  const std::string right = folder.read("a.csv");
  doctor(folder, "street,static,0.016,8,", "street,static,0.016,7,");
  const ProgramRun update = run_program({"check", folder.path(), "--update"});
  CHECK(update.exit_code == 0);
  CHECK(has(update.out, "a.csv: rewritten"));
  CHECK(folder.read("a.csv") == right);
}

TEST_CASE("golden: what cannot be read is refused with file and line") {
  const TestFolder folder;
  CHECK(run_program({"check", folder.path()}).exit_code == 3);  // no table in it
  CHECK(run_program({"check", folder.path("none")}).exit_code == 3);
  folder.write("a.csv", "scene,policy\n");
  const ProgramRun no_first_line = run_program({"check", folder.path()});
  CHECK(no_first_line.exit_code == 3);
  CHECK(has(no_first_line.err, "a.csv:1"));
  folder.write("a.csv", "# framesim compare --polices static\n");
  CHECK(has(run_program({"check", folder.path()}).err, "a.csv:1"));
  folder.write("a.csv", "# framesim compare --policies statics\n");
  const ProgramRun no_policy = run_program({"check", folder.path()});
  CHECK(no_policy.exit_code == 3);
  CHECK(has(no_policy.err, "a.csv:1"));
  folder.write("a.csv", kFirstLine + "scene,policy,target_s\nstreet,static\n");
  const ProgramRun short_row = run_program({"check", folder.path()});
  CHECK(short_row.exit_code == 3);
  CHECK(has(short_row.err, "a.csv:3"));
}

}  // namespace framesim
