#include "experiments/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "sim/check.h"

namespace framesim {
namespace {
namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError({"command line"}, fmt::format("cannot write '{}': {}", path, why));
}

fs::path folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// Ctrl-C waits until the temporary file has been renamed or removed.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t held;
    sigemptyset(&held);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held, signal);
    pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~SignalsHeld() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_{};
};

// 0, or errno.
int write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

bool is_special(const std::string& path) {  // /dev/stdout, a pipe: cannot be renamed onto
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

// 0, or errno.
int write_to(const std::string& path, int flags, std::string_view content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  if (file < 0) return errno;
  int error = write_all(file, content);
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

void check_writable(const std::string& path) {
  std::error_code ignored;
  const fs::path folder = folder_of(path);
  if (fs::is_directory(path, ignored)) refuse(path, "it is a folder");
  if (!fs::is_directory(folder, ignored)) refuse(path, fmt::format("there is no folder '{}'", folder.string()));
  if (!is_special(path) && ::access(folder.c_str(), W_OK) != 0) refuse(path, std::strerror(errno));
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) refuse(path, error.message());
  if (!fs::is_directory(path, error)) refuse(path, "it is not a folder");
  if (::access(path.c_str(), W_OK) != 0) refuse(path, std::strerror(errno));
}

void write_file(const std::string& path, std::string_view content) {
  check_writable(path);
  if (is_special(path)) {
    if (const int error = write_to(path, 0, content)) refuse(path, std::strerror(error));
    return;
  }
  const SignalsHeld held;
  const std::string temporary = fmt::format("{}.{}.part", path, ::getpid());
  int error = write_to(temporary, O_CREAT | O_TRUNC, content);
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  refuse(path, std::strerror(error));
}

}  // namespace framesim
