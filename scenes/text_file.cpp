#include "scenes/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "scenes/scene_file.h"

namespace framesim {
namespace {

constexpr std::size_t kReadAtOnce = 1u << 16;  // bytes

}  // namespace

std::optional<std::string> why_unreadable(const std::string& path, std::size_t largest) {
  namespace fs = std::filesystem;
  if (path.find('\0') != std::string::npos) return "a NUL character in the path";
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return "no such file";
  if (error) return error.message();
  if (status.type() == fs::file_type::directory) return "is a folder, not a file";
  if (status.type() != fs::file_type::regular) return "is no regular file";
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return error.message();
  if (size > largest) return fmt::format("has {} bytes; allowed: {}", size, largest);
  return std::nullopt;
}

LineReader::LineReader(const std::string& path, std::string name, std::size_t largest, const InputLocation& where)
    : name_(std::move(name)), file_(nullptr, &std::fclose) {
  if (const auto why = why_unreadable(path, largest))
    throw InputError(where, fmt::format("cannot read '{}': {}", name_, *why));
  errno = 0;
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_) throw InputError(where, fmt::format("cannot read '{}': {}", name_, std::strerror(errno)));
}

bool LineReader::refill() {
  if (at_end_) return false;
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t old = buffer_.size();
  buffer_.resize(old + kReadAtOnce);
  const std::size_t count = std::fread(buffer_.data() + old, 1, kReadAtOnce, file_.get());
  buffer_.resize(old + count);
  if (count == kReadAtOnce) return true;
  if (std::ferror(file_.get())) throw InputError({name_, line_ + 1}, "cannot be read further");
  at_end_ = true;
  return count > 0;
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = begin_;
  std::size_t end = buffer_.find('\n', searched);
  while (end == std::string::npos && buffer_.size() - begin_ <= kLongestLine) {
    searched = buffer_.size() - begin_;  // refill() moves the rest to the front
    if (!refill()) break;
    end = buffer_.find('\n', searched);
  }
  const bool last = end == std::string::npos;
  if (last) end = buffer_.size();
  if (last && begin_ == end) return std::nullopt;
  ++line_;
  if (end - begin_ > kLongestLine) {
    throw InputError({name_, line_}, fmt::format("a line of more than {} bytes", kLongestLine));
  }
  std::string_view line(buffer_.data() + begin_, end - begin_);
  begin_ = last ? end : end + 1;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

// Names what was wrong at line 1 even where nothing was read, so that every message has the form file:line.
std::string read_text_file(const std::string& path, std::size_t largest) {
  const InputLocation start{path, 1};
  if (const auto why = why_unreadable(path, largest)) throw InputError(start, fmt::format("cannot be read: {}", *why));
  LineReader lines(path, path, largest, start);
  std::string text;
  while (const auto line = lines.next()) {
    text.append(*line);
    text.push_back('\n');
    if (text.size() > largest + 1) throw InputError({path, lines.line()}, fmt::format("more than {} bytes", largest));
  }
  return text;
}

std::optional<std::size_t> find_invalid_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte(i);
    if (lead < 0x80) {
      ++i;
      continue;
    }
    const std::size_t length = lead >= 0xc2 && lead < 0xe0   ? 2
                               : lead >= 0xe0 && lead < 0xf0 ? 3
                               : lead >= 0xf0 && lead < 0xf5 ? 4
                                                             : 0;
    if (length == 0 || text.size() - i < length) return i;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xc0) != 0x80) return i;
    }
    const unsigned second = byte(i + 1);
    const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool beyond = (lead == 0xed && second >= 0xa0) || (lead == 0xf4 && second >= 0x90);
    if (overlong || beyond) return i;
    i += length;
  }
  return std::nullopt;
}

}  // namespace framesim
