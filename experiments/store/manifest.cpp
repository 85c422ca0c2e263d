#include "experiments/store/manifest.h"

#include <sys/utsname.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "experiments/store/sha256.h"
#include "experiments/version.h"
#include "scenes/scene_file.h"
#include "scenes/toml_document.h"
#include "sim/check.h"

#ifndef FRAMESIM_FLAGS
#define FRAMESIM_FLAGS "unknown"
#endif

namespace framesim {
namespace {
namespace fs = std::filesystem;

std::string compiler() {
#if defined(__clang__)
  return "clang++ " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

std::string cpu() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  utsname names{};
  return uname(&names) == 0 ? names.machine : "unknown";
}

void collect_texts(const TomlNode& node, std::vector<std::string>& texts) {
  if (const std::string* text = node.as_text()) texts.push_back(*text);
  if (const TomlArray* array = node.as_array()) {
    for (const TomlNode& item : *array) collect_texts(item, texts);
  }
  if (const TomlTable* table = node.as_table()) {
    for (const TomlMember& member : *table) collect_texts(member.node, texts);
  }
}

bool known(const std::string& name, const std::vector<InputFile>& inputs) {
  return std::any_of(inputs.begin(), inputs.end(), [&](const InputFile& input) { return input.name == name; });
}

std::string beside(const std::string& file, const std::string& name) {
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? name : (folder / name).string();
}

bool could_be_path(const std::string& text) {
  return !text.empty() && text.size() < 4096 && text.find('\n') == std::string::npos;
}

}  // namespace

bool Manifest::same_program(const Manifest& other) const {
  return version == other.version && commit == other.commit && compiler == other.compiler && flags == other.flags;
}

Manifest this_program(std::string command) {
  return {.version = std::string(version()),
          .commit = std::string(framesim::commit()),
          .compiler = compiler(),
          .flags = FRAMESIM_FLAGS,
          .cpu = cpu(),
          .command = std::move(command)};
}

void add_input_text(const std::string& name, std::string_view text, std::vector<InputFile>& inputs) {
  if (!known(name, inputs)) inputs.push_back({name, sha256(text)});
}

void add_input_files(const std::string& name, const std::string& path, std::vector<InputFile>& inputs) {
  if (known(name, inputs)) return;
  inputs.push_back({name, sha256_of_file(path)});
  if (!path.ends_with(".toml")) return;
  std::vector<std::string> texts;
  collect_texts(parse_toml(read_text_file(path, kLargestSceneFile), path).root, texts);
  for (const std::string& text : texts) {
    std::error_code ignored;
    if (!could_be_path(text) || !fs::is_regular_file(beside(path, text), ignored)) continue;
    add_input_files(beside(name, text), beside(path, text), inputs);
  }
}

}  // namespace framesim
