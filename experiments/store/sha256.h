// SHA-256 (FIPS 180-4), so that `sha256sum FILE` shows whether an input is the one that a result was made from.
#pragma once

#include <string>
#include <string_view>

namespace framesim {

// 64 hexadecimal digits.
std::string sha256(std::string_view bytes);
// Of a file's bytes; throws InputError at `path` if it cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace framesim
