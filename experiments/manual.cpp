#include "experiments/manual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <span>
#include <vector>

#include "experiments/version.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "sim/effect.h"
#include "sim/estimator.h"
#include "sim/planner.h"

namespace framesim {
namespace {

// Text for roff: no line may begin with a control character, and backslash and hyphen are taken literally.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

bool is_shown(const CLI::Option& option) { return !option.get_group().empty(); }

// "--policy SPEC (default: x)" or "SCENE".
std::string option_heading(const CLI::Option& option) {
  std::string text = option.get_name(option.get_positional() && option.get_lnames().empty(), true);
  std::replace(text.begin(), text.end(), ',', ' ');
  if (!option.get_type_name().empty() && option.get_items_expected_max() > 0) text += ' ' + option.get_type_name();
  if (!option.get_default_str().empty()) text += fmt::format(" (default: {})", option.get_default_str());
  return text;
}

std::string options_text(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (!is_shown(*option)) continue;
    text += fmt::format(".TP\n.B {}\n{}\n", roff(option_heading(*option)), roff(option->get_description()));
  }
  return text;
}

std::string verb_text(const CLI::App& verb) {
  return fmt::format(".SS {}\n{}.\n{}.PP\n.nf\n{}\n.fi\n", verb.get_name(), roff(verb.get_description()),
                     options_text(verb), roff(verb.get_footer()));
}

// --- completion

struct Words {
  std::string_view option;  // long name without dashes, or the name of a positional
  std::vector<std::string> words;
};

template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.emplace_back(entry.name);
  return names;
}

// What stands behind an option, where that is a name out of a registry.
std::vector<Words> value_words() {
  return {{"policy", names_of(policies())},           {"policies", names_of(policies())},
          {"scenes", names_of(built_in_scenes())},    {"SCENE", names_of(built_in_scenes())},
          {"machine", names_of(built_in_machines())}, {"effect", names_of(effects())},
          {"no-effect", names_of(effects())},         {"estimator", names_of(estimators())},
          {"planner", names_of(planners())}};
}

std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (!is_shown(*option)) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool takes_scene(const CLI::App& verb) {
  const auto options = verb.get_options();
  return std::any_of(options.begin(), options.end(), [](const CLI::Option* o) { return o->get_name(true) == "SCENE"; });
}

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string bash_script(const CLI::App& app) {
  std::string text =
      "_framesim() {\n  local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]} verb=${COMP_WORDS[1]}\n"
      "  COMPREPLY=()\n  case $last in\n";
  for (const Words& words : value_words()) {
    if (words.option == "SCENE") continue;
    text += fmt::format("    --{}) COMPREPLY=($(compgen -W '{}' -- \"$word\")); return ;;\n", words.option,
                        fmt::join(words.words, " "));
  }
  std::vector<std::string> verbs;
  for (const CLI::App* verb : verbs_of(app)) verbs.push_back(verb->get_name());
  text += fmt::format(
      "  esac\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    COMPREPLY=($(compgen -W '{} {}' -- \"$word\"))\n"
      "    return\n  fi\n  case $verb in\n",
      fmt::join(verbs, " "), fmt::join(long_options(app), " "));
  for (const CLI::App* verb : verbs_of(app)) {
    std::vector<std::string> words = long_options(*verb);
    if (takes_scene(*verb)) {
      for (std::string& scene : names_of(built_in_scenes())) words.push_back(std::move(scene));
    }
    text += fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$word\")) ;;\n", verb->get_name(),
                        fmt::join(words, " "));
  }
  return text + "  esac\n}\ncomplete -o default -F _framesim framesim\n";
}

// Within single quotes of fish.
std::string quoted_for_fish(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, text.find('\n'))) {
    if (c == '\\' || c == '\'') out += '\\';
    out += c;
  }
  return "'" + out + "'";
}

std::string fish_script(const CLI::App& app) {
  const std::vector<Words> values = value_words();
  std::string text;
  for (const CLI::App* verb : verbs_of(app)) {
    const std::string seen = fmt::format("-n '__fish_seen_subcommand_from {}'", verb->get_name());
    text += fmt::format("complete -c framesim -n __fish_use_subcommand -a {} -d {}\n", verb->get_name(),
                        quoted_for_fish(verb->get_description()));
    if (takes_scene(*verb)) {
      text += fmt::format("complete -c framesim {} -a '{}'\n", seen, fmt::join(names_of(built_in_scenes()), " "));
    }
    for (const CLI::Option* option : verb->get_options()) {
      if (!is_shown(*option)) continue;
      for (const std::string& name : option->get_lnames()) {
        const auto known = std::find_if(values.begin(), values.end(), [&](const Words& w) { return w.option == name; });
        std::string takes = option->get_items_expected_max() > 0 ? " -r" : "";
        if (known != values.end()) takes = fmt::format(" -x -a '{}'", fmt::join(known->words, " "));
        text += fmt::format("complete -c framesim {} -l {}{} -d {}\n", seen, name, takes,
                            quoted_for_fish(option->get_description()));
      }
    }
  }
  return text;
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH FRAMESIM 1 \"\" \"framesim {}\" \"User Commands\"\n.SH NAME\nframesim \\- simulate frames that have a time "
      "to "
      "meet, and compare policies that choose levels of detail\n.SH SYNOPSIS\n.B framesim\n.I verb\n[options]\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n{}.SH VERBS\n",
      version(), roff(app.get_description()), options_text(app));
  for (const CLI::App* verb : verbs_of(app)) text += verb_text(*verb);
  return text + fmt::format(".SH EXAMPLES AND EXIT CODES\n.nf\n{}\n.fi\n", roff(app.get_footer()));
}

std::string completion_script(const CLI::App& app, Shell shell) {
  if (shell == Shell::fish) return fish_script(app);
  const std::string bash = bash_script(app);
  return shell == Shell::bash ? bash : "autoload -U +X bashcompinit && bashcompinit\n" + bash;
}

}  // namespace framesim
