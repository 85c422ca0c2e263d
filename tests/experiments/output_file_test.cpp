#include "experiments/output_file.h"

#include "sim/check.h"
#include "tests/catch.h"
#include "tests/experiments/program.h"

namespace framesim {

TEST_CASE("output file: a new file and a replaced one hold exactly the content, and nothing else is left") {
  const TestFolder folder;
  write_file(folder.path("a.csv"), "first, and longer");
  write_file(folder.path("a.csv"), "second");
  CHECK(folder.read("a.csv") == "second");
  CHECK(folder.names() == std::vector<std::string>{"a.csv"});
}

TEST_CASE("output file: a missing folder, and a folder in place of the file, are refused") {
  const TestFolder folder;
  CHECK_THROWS_AS(write_file(folder.path("none/a.csv"), "x"), InputError);
  CHECK_THROWS_AS(check_writable(folder.path("none/a.csv")), InputError);
  CHECK_THROWS_AS(write_file(folder.path(), "x"), InputError);
  CHECK(folder.names().empty());
}

TEST_CASE("output file: folders are made with their parents; a file in the way is refused") {
  const TestFolder folder;
  make_folder(folder.path("a/b"));
  CHECK(std::filesystem::is_directory(folder.path("a/b")));
  make_folder(folder.path("a/b"));  // again: nothing to do
  folder.write("file", "x");
  CHECK_THROWS_AS(make_folder(folder.path("file")), InputError);
}

TEST_CASE("output file: a device is written, not replaced") {
  write_file("/dev/null", "gone");
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace framesim
