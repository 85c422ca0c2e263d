// What made a result: the program, the machine it ran on, and every file that went in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace framesim {

// How this program was built and where it runs. Equal programs give equal results on any CPU, so only the program is
// compared where results are put together.
struct Manifest {
  std::string version, commit, compiler, flags;  // commit "unknown" where the sources were in no git checkout
  std::string cpu;                               // as the system names it
  std::string command;                           // the options that bear on results; not --jobs, --resume, --shard
  bool same_program(const Manifest& other) const;
};
Manifest this_program(std::string command);

struct InputFile {
  std::string name;    // as the sweep's file names it, "built-in street", or a file that such a file names
  std::string sha256;  // of its bytes: what `sha256sum` prints
  bool operator==(const InputFile&) const = default;
};

// The file and every file that it names, and so on: a TOML file's texts that are files beside it (CSV tables, machines).
// In the order in which they are met, each once.
void add_input_files(const std::string& name, const std::string& path, std::vector<InputFile>& inputs);
void add_input_text(const std::string& name, std::string_view text, std::vector<InputFile>& inputs);

}  // namespace framesim
