// What error messages say about words: the offending one, the legal ones, and the one that was probably meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace framesim {

// 'text' in quotes; at most 60 bytes of it, cut between characters, and '?' for control characters.
std::string quoted(std::string_view text);

// "a, b, c".
std::string list_of(std::span<const std::string_view> words);

// "; did you mean 'robin-hood'?" for the nearest of `known`, or nothing if none is near. Near is: an edit distance
// (insert, delete, replace, swap neighbours; case ignored) of at most a third of the word's length, and at least 1; or
// a beginning of three letters or more. Of equally near words the first.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);

}  // namespace framesim
