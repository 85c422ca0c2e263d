// Files that are written whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace framesim {

// Throws InputError (exit code 2: the name came from the command line) if `path` cannot become a file: its folder is
// missing or not writable, or it is a folder itself. Called before long work, so that nobody waits for a late refusal.
void check_writable(const std::string& path);

// Makes the folder and its parents if they are missing; throws InputError if that cannot be done.
void make_folder(const std::string& path);

// Writes to a temporary name in the same folder, then renames: a reader sees the old file or the new one, and a failure
// leaves nothing behind. Throws InputError.
void write_file(const std::string& path, std::string_view content);

}  // namespace framesim
