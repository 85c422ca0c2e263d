// framesim man, framesim completion: what --help knows, for man(1) and for the shell.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>

#include "experiments/manual.h"
#include "experiments/verbs.h"

namespace framesim {

void add_man(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("man", "Print the manual page, every verb and option in it");
  verb->footer(
      "Examples:\n"
      "  framesim man | man -l -\n"
      "  framesim man > ~/.local/share/man/man1/framesim.1");
  verb->callback([&app] { fmt::print("{}", manual_page(app)); });
}

void add_completion(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("completion", "Print a script that completes framesim's words in a shell");
  const auto shell = std::make_shared<std::string>();
  std::vector<std::string> names(std::begin(kShellNames), std::end(kShellNames));
  verb->add_option("SHELL", *shell, "bash, zsh or fish")->type_name("")->required()->check(CLI::IsMember(names));
  verb->footer(
      "Examples:\n"
      "  . <(framesim completion bash)\n"
      "  framesim completion fish > ~/.config/fish/completions/framesim.fish");
  verb->callback([&app, shell] {
    const auto at = std::find(std::begin(kShellNames), std::end(kShellNames), *shell);
    fmt::print("{}", completion_script(app, static_cast<Shell>(at - std::begin(kShellNames))));
  });
}

}  // namespace framesim
