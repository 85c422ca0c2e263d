#include "experiments/manual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "tests/catch.h"
#include "tests/experiments/program.h"

using namespace framesim;

TEST_CASE("manual: the page has each option once, its default and its text, and escapes what roff would read") {
  CLI::App app("does .things", "framesim");
  CLI::App* verb = app.add_subcommand("paint", "Paint it");
  std::string color = "red";
  verb->add_option("--color", color, "A \\ colour\n.of yours")->type_name("NAME")->capture_default_str();
  bool hidden = false;
  verb->add_flag("--hidden-flag", hidden, "not shown")->group("");
  const std::string page = manual_page(app);
  // Hyphens as \-, the backslash as \e, and no text line begins with a control character.
  CHECK(page.find(".SS paint\nPaint it.\n") != std::string::npos);
  CHECK(page.find(".B \\-\\-color NAME (default: red)\nA \\e colour\n\\&.of yours\n") != std::string::npos);
  CHECK(page.find("\ndoes .things\n") != std::string::npos);
  CHECK(page.find("hidden") == std::string::npos);
}

TEST_CASE("completion: bash offers verbs, a verb's options, scenes, and the names behind an option") {
  // What bash itself answers, asked through its own variables: COMP_WORDS up to the cursor.
  const auto offered = [](const std::string& words, int at) {
    const std::string script =
        fmt::format("eval \"$1\"; COMP_WORDS=({}); COMP_CWORD={}; _framesim; echo \"${{COMPREPLY[*]}}\"", words, at);
    const ProgramRun run = run_program({"completion", "bash"});
    REQUIRE(run.exit_code == 0);
    return run_command({"/bin/bash", "-c", script, "bash", run.out}).out;
  };
  CHECK(offered("framesim com", 1) == "compare completion\n");
  CHECK(offered("framesim run --pol", 2) == "--policy\n");
  CHECK(offered("framesim run str", 2) == "street\n");
  CHECK(offered("framesim run street --policy robin", 4) == "robin-hood\n");
  CHECK(offered("framesim list nothing-like-it", 2) == "\n");
}

TEST_CASE("completion: an unknown shell is refused with the known ones") {
  const ProgramRun run = run_program({"completion", "tcsh"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK(run.err.find("bash,zsh,fish") != std::string::npos);
}
