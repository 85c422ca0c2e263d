#include "sim/registry.h"

#include <array>
#include <string>

#include "sim/words.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

struct Toy {
  double size = 0;
};

std::unique_ptr<Toy> make_small(const Settings&, double size) { return std::make_unique<Toy>(Toy{size}); }
std::unique_ptr<Toy> make_large(const Settings&, double size) { return std::make_unique<Toy>(Toy{100 * size}); }

using ToyEntry = RegistryEntry<Toy, double>;

const std::array<ToyEntry, 2> kToys = {
    {{"small-toy", "A small one.", {}, make_small}, {"large-toy", "A large one.", {}, make_large}}};

std::string error_for(const std::string& text) {
  try {
    find_entry("toy", std::span<const ToyEntry>(kToys), parse_spec(text, {"a.toml", 4, 2}));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("an entry is found by its name and makes its plug-in", "[registry]") {
  const ToyEntry& entry = find_entry("toy", std::span<const ToyEntry>(kToys), parse_spec("large-toy"));
  CHECK(entry.name == "large-toy");
  CHECK(entry.make({}, 2.0)->size == 200);
}

TEST_CASE("an unknown name is answered with its place, the legal set and the near miss", "[registry]") {
  CHECK(error_for("smalltoy") ==
        "a.toml:4:2: unknown toy 'smalltoy'; allowed: small-toy, large-toy; did you mean 'small-toy'?");
  CHECK(error_for("robot") == "a.toml:4:2: unknown toy 'robot'; allowed: small-toy, large-toy");
}

TEST_CASE("the word that was probably meant", "[words]") {
  const std::array<std::string_view, 4> known = {"static", "feedback", "funkhouser", "mixed-gradient"};
  CHECK(did_you_mean("sttaic", known) == "; did you mean 'static'?");          // one swap
  CHECK(did_you_mean("feedbak", known) == "; did you mean 'feedback'?");       // one letter missing
  CHECK(did_you_mean("Funkhauser", known) == "; did you mean 'funkhouser'?");  // one wrong, case ignored
  CHECK(did_you_mean("mixed", known) == "; did you mean 'mixed-gradient'?");   // a beginning
  CHECK(did_you_mean("mi", known).empty());                                    // too short a beginning
  CHECK(did_you_mean("dynamic", known).empty());                               // 4 letters of 7 away from "static"
  CHECK(did_you_mean("", known).empty());
  CHECK(did_you_mean(std::string(100'000, 's'), known).empty());
  // One edit away from both: the first of the list.
  const std::array<std::string_view, 2> tied = {"abcd", "abce"};
  CHECK(did_you_mean("abcf", tied) == "; did you mean 'abcd'?");
}

TEST_CASE("what is quoted is short and printable", "[words]") {
  CHECK(quoted("a\nb\x1b[31m") == "'a?b?[31m'");
  CHECK(quoted(std::string(60, 'x')) == "'" + std::string(60, 'x') + "'");
  CHECK(quoted(std::string(61, 'x')) == "'" + std::string(60, 'x') + "...'");
  // The two bytes of an umlaut stay together: 59 letters, then it would be cut in its middle.
  const std::string letters(59, 'x');
  CHECK(quoted(letters + "\xc3\xbc") == "'" + letters + "...'");
}
