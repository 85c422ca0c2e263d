#include "experiments/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "sim/check.h"

extern char** environ;

namespace framesim {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// A file without a name: gone when it is closed, however we end.
File nameless_file() {
  File file(std::tmpfile());
  if (!file) throw UsageError(fmt::format("--plot: no temporary file can be made: {}", std::strerror(errno)));
  return file;
}

std::string content_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 65536> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file)) text.append(block.data(), n);
  return text;
}

// Exit status of gnuplot; -1 if it was killed by a signal.
int spawn_and_wait(std::FILE* in, std::FILE* out, std::FILE* err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in), 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(out), 1);
  posix_spawn_file_actions_adddup2(&actions, fileno(err), 2);
  std::string program = "gnuplot", from_stdin = "-";
  char* arguments[] = {program.data(), from_stdin.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw UsageError(
        fmt::format("--plot needs gnuplot, which cannot be started ({}); on Debian: apt-get install gnuplot-nox",
                    std::strerror(error)));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
  const File in = nameless_file(), out = nameless_file(), err = nameless_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() || std::fflush(in.get()) != 0) {
    throw UsageError(fmt::format("--plot: the script for gnuplot cannot be written: {}", std::strerror(errno)));
  }
  std::rewind(in.get());
  const int status = spawn_and_wait(in.get(), out.get(), err.get());
  if (status != 0) {
    throw InternalError(fmt::format("gnuplot ended with status {}: {}", status, content_of(err.get())));
  }
  return content_of(out.get());
}

void require_gnuplot() { run_gnuplot("exit\n"); }

std::string gnuplot_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c == '\n' ? ' ' : c);
  return quoted + "'";
}

}  // namespace framesim
