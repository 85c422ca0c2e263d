#include "experiments/store/sweep_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <limits>
#include <set>

#include "experiments/options.h"
#include "experiments/store/sha256.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "scenes/table_reader.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr std::string_view kKeys[] = {"framesim", "scenes",   "policies",  "targets",    "estimators", "planners",
                                      "overlaps", "machine",  "effects",   "no_effects", "seeds",      "first_seed",
                                      "frames",   "fidelity", "yardstick", "frame_rows", "vary"};
constexpr std::array<std::string_view, 5> kVaried = {"scene", "policy", "estimator", "planner", "effect"};
enum Varied : std::size_t { kScene, kPolicy, kEstimator, kPlanner, kEffect };

// A text of the file and its place.
struct Word {
  std::string text;
  InputLocation where;
};

std::vector<Word> words(const TableReader& root, std::string_view key) {
  root.texts(key);  // refuses what is no list of texts
  std::vector<Word> words;
  const TomlMember* member = find_member(root.members(), key);
  if (!member) return words;
  for (const TomlNode& node : *member->node.as_array()) {
    words.push_back({*node.as_text(), root.document().where(node.place)});
  }
  if (words.empty()) root.refuse(key, "found an empty list; allowed: at least one entry, or no such key");
  return words;
}

std::vector<Spec> specs(const TableReader& root, std::string_view key) {
  std::vector<Spec> list;
  std::set<std::string> known;
  for (const Word& word : words(root, key)) {
    list.push_back(parse_spec(word.text, word.where));
    const std::string text = to_string(list.back());
    if (!known.insert(text).second)
      throw InputError(word.where, fmt::format("{}: {} is there twice", key, framesim::quoted(text)));
  }
  return list;
}

// What [[vary]] changes: lists of which every entry is run. The effects of one run are together one entry.
struct Lists {
  std::array<std::vector<Spec>, kEffect> specs;
  std::vector<std::vector<Spec>> effects = {{}};
};

std::vector<Setting> vary_values(const TableReader& table) {
  const std::string key = table.text("key");
  const TomlMember* member = find_member(table.members(), "values");
  if (!member || !member->node.as_array() || member->node.as_array()->empty()) {
    table.refuse("values", "allowed: a list of texts, numbers, true or false, at least one");
  }
  std::vector<Setting> values;
  for (const TomlNode& node : *member->node.as_array()) {
    if (node.as_array() || node.as_table() || std::holds_alternative<TomlDate>(node.value)) {
      table.refuse("values", "allowed: a list of texts, numbers, true or false");
    }
    std::string text = node.as_text() ? *node.as_text() : show_value(node);
    if (text.find(',') != std::string::npos) table.refuse("values", "a value may not hold a comma");
    values.push_back({key, std::move(text), table.document().where(node.place)});
  }
  return values;
}

// `spec` with the setting put in, or in place of what it had.
Spec with(Spec spec, const Setting& setting) {
  const auto same = [&](const Setting& other) { return other.key == setting.key; };
  const auto old = std::find_if(spec.settings.begin(), spec.settings.end(), same);
  if (old == spec.settings.end()) {
    spec.settings.push_back(setting);
  } else {
    *old = setting;
  }
  return spec;
}

void vary(std::vector<Spec>& list, const std::string& name, const std::vector<Setting>& values) {
  std::vector<Spec> varied;
  for (const Spec& spec : list) {
    if (spec.name != name) {
      varied.push_back(spec);
      continue;
    }
    for (const Setting& value : values) varied.push_back(with(spec, value));
  }
  list = std::move(varied);
}

void vary_effects(std::vector<std::vector<Spec>>& lists, const std::string& name, const std::vector<Setting>& values) {
  std::vector<std::vector<Spec>> varied;
  for (const std::vector<Spec>& list : lists) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const Spec& spec) { return spec.name == name; });
    if (at == list.end()) {
      varied.push_back(list);
      continue;
    }
    for (const Setting& value : values) {
      varied.push_back(list);
      varied.back()[static_cast<std::size_t>(at - list.begin())] = with(*at, value);
    }
  }
  lists = std::move(varied);
}

// How many entries of the list will be there once for each value.
std::size_t count_varied(const Lists& lists, std::size_t of, const std::string& name) {
  const auto named = [&](const Spec& spec) { return spec.name == name; };
  const auto has_one = [&](const std::vector<Spec>& list) { return std::any_of(list.begin(), list.end(), named); };
  const std::vector<std::vector<Spec>>& effects = lists.effects;
  if (of == kEffect) return static_cast<std::size_t>(std::count_if(effects.begin(), effects.end(), has_one));
  return static_cast<std::size_t>(std::count_if(lists.specs[of].begin(), lists.specs[of].end(), named));
}

std::string too_many_runs() { return fmt::format("the sweep has more than {} runs", kMostRuns); }

void apply_vary(const TableReader& root, Lists& lists) {
  for (const TomlNode* node : root.tables("vary")) {
    const TableReader table(root.document(), *node, "[[vary]]", {"of", "name", "key", "values"});
    const std::size_t of = table.word("of", kVaried);
    const std::string name = table.text("name");
    const std::vector<Setting> values = vary_values(table);
    const std::size_t found = count_varied(lists, of, name);
    if (found == 0) {
      table.refuse("name", fmt::format("there is no {} {} in this file to vary", kVaried[of], framesim::quoted(name)));
    }
    // Several [[vary]] multiply: a few lines of text could ask for any number of entries.
    if (found * values.size() > static_cast<std::size_t>(kMostRuns)) throw InputError(table.where(), too_many_runs());
    of == kEffect ? vary_effects(lists.effects, name, values) : vary(lists.specs[of], name, values);
  }
}

std::string beside(const std::string& file, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  return folder.empty() || std::filesystem::path(name).is_absolute() ? name : (folder / name).string();
}

bool is_path(const std::string& name) { return name.find('/') != std::string::npos || name.ends_with(".toml"); }

const BuiltIn* find_built_in(std::span<const BuiltIn> entries, const std::string& name) {
  const auto at = std::find_if(entries.begin(), entries.end(), [&](const BuiltIn& b) { return b.name == name; });
  return at == entries.end() ? nullptr : &*at;
}

// A scene or machine as the program loads it, and its bytes among the inputs.
Spec resolve(const Spec& spec, std::string_view kind, std::span<const BuiltIn> entries, Sweep& sweep) {
  Spec loaded = spec;
  if (is_path(spec.name)) {
    loaded.name = beside(sweep.path, spec.name);
    if (!std::filesystem::is_regular_file(loaded.name)) {
      throw InputError(spec.where, fmt::format("{} {}: there is no such file", kind, framesim::quoted(loaded.name)));
    }
    add_input_files(spec.name, loaded.name, sweep.inputs);
  } else if (const BuiltIn* built_in = find_built_in(entries, spec.name)) {
    add_input_text(fmt::format("built-in {} {}", kind, spec.name), built_in->text, sweep.inputs);
  }
  return loaded;
}

std::vector<double> read_targets(const TableReader& root, const Scene& scene) {
  const std::vector<Word> given = words(root, "targets");
  if (given.empty()) return {scene.targets_s.front()};
  if (given.size() == 1 && given.front().text == "all") return scene.targets_s;
  std::vector<double> targets;
  for (const Word& word : given) {
    targets.push_back(read_target_s(word.text, word.where));
    if (std::count(targets.begin(), targets.end(), targets.back()) > 1) {
      throw InputError(word.where, fmt::format("targets: {} is there twice", framesim::quoted(word.text)));
    }
  }
  return targets;
}

struct Seeds {
  std::int64_t first = 1, count = 1;
};

Seeds read_seeds(const TableReader& root) {
  // Up to the largest that SQLite's integers hold.
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  const Seeds seeds{root.whole("first_seed", 0, kLargest, 1), root.whole("seeds", 1, 1'000'000, 1)};
  if (seeds.first > kLargest - (seeds.count - 1)) root.refuse("seeds", "passes the largest seed");
  return seeds;
}

// What all runs have in common.
RunSpec read_common(const TableReader& root, Sweep& sweep) {
  constexpr std::int64_t kMostFrames = 1'000'000'000;
  RunSpec spec;
  spec.no_effects = specs(root, "no_effects");
  spec.frames = root.whole("frames", 1, kMostFrames, 0);
  spec.engine.kind = static_cast<EngineKind>(root.word("fidelity", kEngineKindNames, 0));
  sweep.yardstick =
      static_cast<Yardstick>(root.word("yardstick", kYardstickNames, static_cast<std::size_t>(Yardstick::bound)));
  sweep.frame_rows = root.flag("frame_rows", false);
  spec.bound = sweep.yardstick >= Yardstick::bound;
  if (!root.has("machine")) return spec;
  const Spec machine = parse_spec(root.text("machine"), root.where("machine"));
  spec.machine = resolve(machine, "machine", built_in_machines(), sweep);
  return spec;
}

std::vector<std::optional<Overlap>> read_overlaps(const TableReader& root) {
  std::vector<std::optional<Overlap>> overlaps;
  for (const Word& word : words(root, "overlaps")) overlaps.push_back(parse_overlap(word.text, word.where));
  if (overlaps.empty()) overlaps.push_back(std::nullopt);
  return overlaps;
}

// One entry of each list, without scene, target, policy and seed.
std::vector<RunSpec> read_variants(const TableReader& root, const Lists& lists, const RunSpec& common) {
  std::vector<std::optional<Spec>> planners(lists.specs[kPlanner].begin(), lists.specs[kPlanner].end());
  if (planners.empty()) planners.push_back(std::nullopt);
  const std::vector<std::optional<Overlap>> overlaps = read_overlaps(root);
  const double count = static_cast<double>(lists.specs[kEstimator].size()) * static_cast<double>(planners.size()) *
                       static_cast<double>(overlaps.size()) * static_cast<double>(lists.effects.size());
  if (count > static_cast<double>(kMostRuns)) throw InputError(root.where(), too_many_runs());
  std::vector<RunSpec> variants;
  for (const Spec& estimator : lists.specs[kEstimator]) {
    for (const std::optional<Spec>& planner : planners) {
      for (const std::optional<Overlap>& overlap : overlaps) {
        for (const std::vector<Spec>& effects : lists.effects) {
          variants.push_back(common);
          RunSpec& variant = variants.back();
          variant.estimator = estimator;
          variant.planner = planner;
          variant.overlap = overlap;
          variant.effects = effects;
        }
      }
    }
  }
  return variants;
}

Lists read_lists(const TableReader& root) {
  Lists lists;
  lists.specs[kScene] = specs(root, "scenes");
  lists.specs[kPolicy] = specs(root, "policies");
  lists.specs[kEstimator] = specs(root, "estimators");
  lists.specs[kPlanner] = specs(root, "planners");
  lists.effects = {specs(root, "effects")};
  for (const char* needed : {"scenes", "policies"}) {
    if (!root.has(needed))
      throw InputError(root.where(), fmt::format("the key '{}' is missing; allowed: a list of names", needed));
  }
  if (lists.specs[kEstimator].empty()) {
    lists.specs[kEstimator].push_back({std::string(kDefaultEstimator), {}, root.where()});
  }
  apply_vary(root, lists);
  return lists;
}

std::string describe(const Spec& spec) { return to_string(spec); }

std::string describe(const std::vector<Spec>& specs) {
  std::string text;
  for (const Spec& spec : specs) text += describe(spec) + ' ';
  return text;
}

// Everything of a run that bears on its result, but the input files' bytes.
std::string describe(const Job& job, const std::string& machine) {
  const RunSpec& s = job.spec;
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}\n", describe(s.scene), s.target_s, describe(s.policy),
                     describe(s.estimator), s.planner ? describe(*s.planner) : "", machine,
                     s.overlap ? to_string(*s.overlap) : "", describe(s.effects), describe(s.no_effects), s.seed,
                     s.frames, static_cast<int>(s.engine.kind), s.bound);
}

class SweepPlanner {
 public:
  SweepPlanner(const TableReader& root, Sweep& sweep)
      : root_(root), sweep_(sweep), lists_(read_lists(root)), seeds_(read_seeds(root)) {
    variants_ = read_variants(root, lists_, read_common(root, sweep));
  }

  void plan() {
    for (const Spec& scene : lists_.specs[kScene]) plan_scene(scene);
    std::string text = fmt::format("{} {}\n", kYardstickNames[static_cast<std::size_t>(sweep_.yardstick)],
                                   sweep_.frame_rows ? "frames" : "");
    const std::string machine = root_.has("machine") ? root_.text("machine") : "";
    for (const Job& job : sweep_.runs) text += describe(job, machine);
    sweep_.plan_hash = sha256(text);
  }

 private:
  void plan_scene(const Spec& spec) {
    const auto scene = scenes_.get(resolve(spec, "scene", built_in_scenes(), sweep_));
    for (const double target_s : read_targets(root_, *scene)) {
      for (const RunSpec& variant : variants_) {
        for (const Spec& policy : lists_.specs[kPolicy]) add({variant, scene}, spec, target_s, policy);
      }
    }
  }

  void add(Job job, const Spec& scene, double target_s, const Spec& policy) {
    job.spec.scene = scene;
    job.spec.target_s = target_s;
    job.spec.policy = policy;
    job.spec.seed = static_cast<std::uint64_t>(seeds_.first);
    check_parts(job.spec, *job.scene);
    if (seeds_.count > kMostRuns - static_cast<std::int64_t>(sweep_.runs.size())) {
      throw InputError(root_.where(), too_many_runs());
    }
    for (std::int64_t s = 0; s < seeds_.count; ++s) {
      sweep_.runs.push_back(job);
      ++job.spec.seed;
    }
  }

  const TableReader& root_;
  Sweep& sweep_;
  Lists lists_;
  Seeds seeds_;
  std::vector<RunSpec> variants_;
  SceneCache scenes_;
};

}  // namespace

std::string to_string(const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); }

Shard parse_shard(const std::string& text) {
  constexpr std::int64_t kMostShards = 1'000'000;
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.index);
  bool good = first == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [last, second] = std::from_chars(slash + 1, end, shard.count);
    good = second == std::errc() && last == end && shard.count >= 1 && shard.count <= kMostShards && shard.index >= 0 &&
           shard.index <= shard.count;
  }
  if (!good) {
    throw InputError(
        {"command line"},
        fmt::format("--shard: {} is not i/n with n from 1 to {} and i from 0 to n (n stands for 0, so that "
                    "job arrays may count from 0 or from 1)",
                    framesim::quoted(text), kMostShards));
  }
  shard.index %= shard.count;
  return shard;
}

Sweep read_sweep(const std::string& path) {
  Sweep sweep;
  sweep.path = path;
  const std::string text = read_text_file(path, kLargestSceneFile);
  const TomlDocument document = parse_toml(text, path);
  const TableReader root(document, document.root, "the sweep", kKeys);
  root.whole("framesim", 1, 1);
  add_input_text(std::filesystem::path(path).filename().string(), text, sweep.inputs);
  SweepPlanner(root, sweep).plan();
  if (root.has("machine")) sweep.machine = root.text("machine");
  return sweep;
}

}  // namespace framesim
