// What the fuzzing programs share. Each is one file with LLVMFuzzerTestOneInput: libFuzzer calls it with bytes of its own
// making, and whatever stops the program (a sanitizer, an exception that is no InputError, a broken invariant) is a finding.
// To add one: tests/fuzz/NAME.cpp, and a few small good inputs in tests/fuzz/corpus/NAME/.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "sim/check.h"

namespace framesim::fuzz {

// Calls `read`; a refusal of the input is what is wanted of a bad one. False if it was refused.
template <class Read>
bool accepts(Read read) {
  try {
    read();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A property that must hold for every accepted input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

// A file of this process that holds the input, for readers that take paths.
inline std::string as_file(std::string_view text, const char* name) {
  static const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("framesim-fuzz-" + std::to_string(getpid()));
  static const bool made = std::filesystem::create_directories(folder);
  static const int at_exit = std::atexit([] { std::filesystem::remove_all(folder); });
  (void)made, (void)at_exit;
  const std::string path = (folder / name).string();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  require(file && std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fclose(file) == 0,
          "a temp file");
  return path;
}

}  // namespace framesim::fuzz
