#include "experiments/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "experiments/options.h"
#include "experiments/verbs.h"
#include "experiments/version.h"
#include "sim/check.h"
#include "sim/words.h"

namespace framesim {
namespace {

enum ExitCode { kDone = 0, kUsage = 2, kInput = 3, kInternal = 4 };

int complain(int code, const std::string& message) {
  std::fflush(stdout);
  fmt::print(stderr, "framesim: {}\n", message);
  return code;
}

// CLI11 prints descriptions as one long line; this breaks them at spaces.
class WrappingFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    constexpr std::size_t kWidth = 84;
    std::string text = option->get_description();
    for (std::size_t line = 0, space = 0, i = 0; i < text.size(); ++i) {
      if (text[i] == ' ') space = i;
      if (i - line < kWidth || space <= line) continue;
      text[space] = '\n';
      line = space + 1;
    }
    return text;
  }
};

// What is wrong with the verb, when there is none.
std::string verb_error(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands(nullptr)) names.push_back(verb->get_name());
  const std::vector<std::string_view> verbs(names.begin(), names.end());
  const std::vector<std::string> words = app.remaining();
  std::string found = "a verb is missing", meant;
  if (!words.empty()) {
    found = fmt::format("there is no {} {}", words.front().starts_with('-') ? "option" : "verb",
                        framesim::quoted(words.front()));
    meant = did_you_mean(words.front(), verbs);
  }
  return fmt::format("{}; allowed verbs: {}{}; see 'framesim --help'", found, list_of(verbs), meant);
}

// --help and --version are "errors" to CLI11 too; they print to stdout and are fine.
int parse_error(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) return complain(kUsage, "command line: " + verb_error(app));
  return complain(kUsage,
                  fmt::format("command line: {}; see 'framesim {} --help'", error.what(), chosen.front()->get_name()));
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(
      "framesim simulates how the frames of a 3D program are made, and how well policies that choose levels of "
      "detail hold a target frame time.",
      "framesim");
  app.set_version_flag("--version", fmt::format("framesim {} (commit {})", version(), commit()));
  app.require_subcommand(1);
  app.formatter(std::make_shared<WrappingFormatter>());
  app.get_formatter()->column_width(34);
  Session session;
  add_quiet_option(app, session.quiet);
  add_list(app, session);
  add_run(app, session);
  add_compare(app, session);
  add_explain(app, session);
  add_check(app, session);
  add_tradeoff(app, session);
  add_reproduce(app, session);
  add_stability(app, session);
  add_import(app, session);
  add_fit(app, session);
  add_sweep(app, session);
  add_merge(app, session);
  add_query(app, session);
  add_report(app, session);
  add_man(app);
  add_completion(app);
  app.footer(
      "Examples:\n"
      "  framesim compare\n"
      "  framesim run street --policy robin-hood --target 25ms\n"
      "  framesim explain street --policy robin-hood\n"
      "  framesim list policies\n"
      "Exit codes: 0 done, 1 check found a difference, compare a regression, or stability a row outside its bound, 2 "
      "wrong\n"
      "command line, 3 wrong input file, 4 internal error.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return parse_error(app, error);
  }
  return session.exit_code;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  // `framesim compare | head` ends quietly, also where a parent had SIGPIPE ignored. SIGINT keeps its default: files
  // are written whole or not at all (output_file.h), so there is nothing to clean up.
  std::signal(SIGPIPE, SIG_DFL);
  int code = kInternal;
  try {
    code = parse_and_run(argc, argv);
  } catch (const InputError& error) {
    code = complain(error.where().file == "command line" ? kUsage : kInput, error.what());
  } catch (const UsageError& error) {
    code = complain(kUsage, fmt::format("command line: {}", error.what()));
  } catch (const InternalError& error) {
    code = complain(kInternal, fmt::format("internal error: {}", error.what()));
  } catch (const std::bad_alloc&) {
    code = complain(kInternal, "out of memory");
  } catch (const std::exception& error) {
    code = complain(kInternal, error.what());
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return complain(kInternal, "standard output cannot be written");
  }
  return code;
}

}  // namespace framesim
