#include "sim/parameters.h"

#include <string>

#include "tests/catch.h"

using namespace framesim;

namespace {

struct Toy {
  double pixels = 1024;
  double wait_s = 0.004;
  std::int64_t rounds = 8;
  bool levels = true;
  int mode = 1;
};

const ParameterTable<Toy> kToy{{
    {"pixels", &Toy::pixels, {.unit = "px", .low = 1, .high = 1e9, .help = "pixels of a polygon"}},
    {"wait", &Toy::wait_s, {.unit = "s", .low = 0, .high = 0.5, .help = "how long"}},
    {"rounds", &Toy::rounds, {.low = 1, .help = "how often"}},
    {"levels", &Toy::levels, {.help = "whether"}},
    {"mode", &Toy::mode, {.help = "how", .words = {"greedy", "exact", "repaired"}}},
}};

Toy read(const std::string& text) { return kToy.read(parse_spec(text, {"a.toml", 3, 9}).settings); }

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("settings overwrite defaults, each kind its way", "[parameters]") {
  const Toy untouched = read("toy");
  CHECK(untouched.pixels == 1024);
  CHECK(untouched.mode == 1);
  const Toy toy = read("toy:pixels=16.5,wait=2.5ms,rounds=1e3,levels=no,mode=repaired");
  CHECK(toy.pixels == 16.5);
  CHECK(toy.wait_s == 0.0025);
  CHECK(toy.rounds == 1000);
  CHECK_FALSE(toy.levels);
  CHECK(toy.mode == 2);
  CHECK(read("toy:levels=yes").levels);
  CHECK(read("toy:levels=true").levels);
  CHECK_FALSE(read("toy:levels=false").levels);
  CHECK(read("toy:rounds=9007199254740991").rounds == 9007199254740991);
  // Both ends of a range belong to it.
  CHECK(read("toy:pixels=1").pixels == 1);
  CHECK(read("toy:pixels=1e9").pixels == 1e9);
}

TEST_CASE("wrong settings are refused with place, value and what is allowed", "[parameters]") {
  CHECK(error_of("toy:pixel=3") ==
        "a.toml:3:9: unknown parameter 'pixel'; allowed: pixels, wait, rounds, levels, mode; did you mean 'pixels'?");
  CHECK(error_of("toy:pixels=0.5") ==
        "a.toml:3:9: parameter 'pixels': '0.5' is out of range; allowed: number 1 .. 1000000000");
  CHECK(error_of("toy:pixels=nan") == "a.toml:3:9: parameter 'pixels': 'nan' is not a finite number");
  CHECK(error_of("toy:pixels=") == "a.toml:3:9: parameter 'pixels': '' is not a finite number");
  CHECK(error_of("toy:wait=3") == "a.toml:3:9: parameter 'wait': '3' has no unit; allowed: ns, us, ms, s, Hz, fps");
  CHECK(error_of("toy:wait=1s") == "a.toml:3:9: parameter 'wait': '1s' is out of range; allowed: duration 0s .. 500ms");
  CHECK(error_of("toy:rounds=2.5") == "a.toml:3:9: parameter 'rounds': '2.5' is not a whole number");
  CHECK(error_of("toy:rounds=9007199254740993") ==  // 2^53 + 1 has no double of its own
        "a.toml:3:9: parameter 'rounds': '9007199254740993' is not a whole number");
  CHECK(error_of("toy:rounds=0") == "a.toml:3:9: parameter 'rounds': '0' is out of range; allowed: whole number >= 1");
  CHECK(error_of("toy:levels=1") ==
        "a.toml:3:9: parameter 'levels': '1' is not a truth value; allowed: true, false, yes, no");
  CHECK(error_of("toy:mode=Exact") ==
        "a.toml:3:9: parameter 'mode': 'Exact' is not known; allowed: greedy, exact, repaired; did you mean 'exact'?");
  const ParameterTable<Toy> none{{}};
  CHECK_THROWS_WITH(none.read({{"a", "1", {"x"}}}), "x: unknown parameter 'a'; allowed: none");
}

TEST_CASE("a table describes itself", "[parameters]") {
  const auto infos = kToy.describe();
  REQUIRE(infos.size() == 5);
  CHECK(infos[0].name == "pixels");
  CHECK(infos[0].unit == "px");
  CHECK(infos[0].default_text == "1024");
  CHECK(infos[0].allowed == "number 1 .. 1000000000");
  CHECK(infos[0].help == "pixels of a polygon");
  CHECK(infos[1].default_text == "4ms");
  CHECK(infos[1].allowed == "duration 0s .. 500ms");
  CHECK(infos[2].default_text == "8");
  CHECK(infos[2].allowed == "whole number >= 1");
  CHECK(infos[3].default_text == "true");
  CHECK(infos[3].allowed == "true, false");
  CHECK(infos[4].default_text == "exact");
  CHECK(infos[4].allowed == "greedy, exact, repaired");
  // Every default, set by its own text, is the default again: the table contradicts neither itself nor the record.
  for (const ParameterInfo& info : infos) {
    CAPTURE(info.name);
    CHECK(error_of("toy:" + info.name + "=" + info.default_text) == "no error");
  }
}

TEST_CASE("a spec is taken apart and put together again", "[parameters]") {
  const Spec spec = parse_spec("robin-hood:value=8,file=a:b=c,levels=", {"x.toml", 1, 2});
  CHECK(spec.name == "robin-hood");
  REQUIRE(spec.settings.size() == 3);
  CHECK(spec.settings[0].key == "value");
  CHECK(spec.settings[0].value == "8");
  CHECK(spec.settings[1].value == "a:b=c");  // only the first '=' parts
  CHECK(spec.settings[2].value.empty());
  CHECK(to_string(spec.settings[2].where) == "x.toml:1:2");
  CHECK(to_string(spec) == "robin-hood:value=8,file=a:b=c,levels=");
  CHECK(to_string(parse_spec("static")) == "static");
  CHECK(to_string(parse_spec("static").where) == "command line");
}

TEST_CASE("a spec that cannot be taken apart", "[parameters]") {
  CHECK_THROWS_WITH(parse_spec(""), "command line: '' begins with no name");
  CHECK_THROWS_WITH(parse_spec(":a=1"), "command line: ':a=1' begins with no name");
  CHECK_THROWS_WITH(parse_spec("p:a"), "command line: 'a' has no '=' in 'p'; expected p:key=value,key=value");
  CHECK_THROWS_WITH(parse_spec("p:"), "command line: '' has no '=' in 'p'; expected p:key=value,key=value");
  CHECK_THROWS_WITH(parse_spec("p:a=1,"), "command line: '' has no '=' in 'p'; expected p:key=value,key=value");
  CHECK_THROWS_WITH(parse_spec("p:=1"), "command line: '=1' of 'p' has nothing before the '='");
  CHECK_THROWS_WITH(parse_spec("p:a=1,b=2,a=3"), "command line: parameter 'a' of 'p' is given twice");
}

TEST_CASE("free text is taken out before the table reads the rest", "[parameters]") {
  Settings settings = parse_spec("p:a=1,task=physics,b=2", {"x.toml", 4, 5}).settings;
  const std::optional<Setting> task = take_setting(settings, "task");
  REQUIRE(task);
  CHECK(task->value == "physics");
  CHECK(to_string(task->where) == "x.toml:4:5");
  REQUIRE(settings.size() == 2);
  CHECK(settings[0].key == "a");
  CHECK(settings[1].key == "b");
  CHECK_FALSE(take_setting(settings, "task"));
  CHECK(settings.size() == 2);
}
