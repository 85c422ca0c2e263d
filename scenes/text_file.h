// Text files read with limits: what is too large, or no regular file, is refused before or while it is read.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sim/check.h"

namespace framesim {

// Why `path` cannot be read as a text file of at most `largest` bytes ("no such file", "is a folder", ...), or nothing.
// Reads none of it.
std::optional<std::string> why_unreadable(const std::string& path, std::size_t largest);

// Lines of a file, one after the other, in constant memory.
class LineReader {
 public:
  // `path` as opened; `name` as messages call it. Throws InputError at `where` if it cannot be read.
  LineReader(const std::string& path, std::string name, std::size_t largest, const InputLocation& where);

  // The next line without its line end ("\n" or "\r\n"), valid until the next call; nothing at the end of the file. Throws
  // InputError at the line if it is longer than kLongestLine, as soon as that much of it has been read.
  std::optional<std::string_view> next();

  // Of the line that next() returned last, counted from 1.
  int line() const { return line_; }
  const std::string& name() const { return name_; }

 private:
  bool refill();

  std::string name_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::string buffer_;
  std::size_t begin_ = 0;  // of what has not been returned yet
  bool at_end_ = false;
  int line_ = 0;
};

// The offset of the first byte that is not UTF-8 (overlong forms and surrogates are not), or nothing.
std::optional<std::size_t> find_invalid_utf8(std::string_view text);

}  // namespace framesim
