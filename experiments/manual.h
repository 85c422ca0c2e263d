// The manual page and the shells' completions, both read from the same declarations as --help.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace framesim {

// roff for man(1): synopsis, every verb with its options, their defaults and examples, exit codes.
std::string manual_page(const CLI::App& app);

enum class Shell { bash, zsh, fish };
inline constexpr std::string_view kShellNames[] = {"bash", "zsh", "fish"};

// A script for the shell: verbs; each verb's options; names of policies, scenes, machines and so on behind the options that
// take them; files elsewhere.
std::string completion_script(const CLI::App& app, Shell shell);

}  // namespace framesim
