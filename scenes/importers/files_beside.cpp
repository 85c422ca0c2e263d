#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "scenes/importers/imported_scene.h"
#include "scenes/text_file.h"
#include "sim/words.h"

namespace framesim {
namespace {
namespace fs = std::filesystem;

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

std::optional<std::string> path_of_uri(const std::string& uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size() && uri[i] != '?' && uri[i] != '#'; ++i) {
    if (uri[i] == '%') {
      const int high = i + 2 < uri.size() ? hex(uri[i + 1]) : -1, low = i + 2 < uri.size() ? hex(uri[i + 2]) : -1;
      if (high < 0 || low < 0) return std::nullopt;
      path += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      path += uri[i];
    }
  }
  const bool plain = path.find_first_of(std::string_view("\0\\:", 3)) == std::string::npos;
  if (path.empty() || !plain || !fs::path(path).is_relative()) return std::nullopt;
  for (const fs::path& part : fs::path(path)) {
    if (part == "..") return std::nullopt;
  }
  return path;
}

std::optional<std::string> FilesInFolder::read(const std::string& uri, const std::function<void(std::string)>& refuse) {
  const auto relative = path_of_uri(uri);
  if (!relative) {
    refuse(fmt::format("{} is no file in or below the folder of the imported one", framesim::quoted(uri)));
    return std::nullopt;
  }
  const std::string path = (folder_.empty() ? "." : folder_) + "/" + *relative;
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  const fs::path base = fs::canonical(folder_.empty() ? "." : folder_, error), real = fs::canonical(path, error);
  const fs::path inside = real.lexically_relative(base);
  if (error || inside.empty() || *inside.begin() == "..") {
    refuse(fmt::format("{} leads out of the folder of the imported file", framesim::quoted(uri)));
    return std::nullopt;
  }
  if (const auto why = why_unreadable(path, kLargestImport)) refuse(fmt::format("cannot read '{}': {}", path, *why));
  return read_whole(path, refuse);
}

std::string read_whole(const std::string& path, const std::function<void(std::string)>& refuse) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) refuse(fmt::format("cannot read '{}'", path));
  std::string content;
  char block[1 << 16];
  while (const std::size_t n = std::fread(block, 1, sizeof block, file.get())) {
    content.append(block, n);
    if (content.size() > kLargestImport) refuse(fmt::format("'{}' has more than {} bytes", path, kLargestImport));
  }
  return content;
}

}  // namespace framesim
