// What a registry holds: one entry a plug-in, in the order of its list. Lookup by name; an unknown name is the user's
// error and is answered with the legal set.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters.h"

namespace framesim {

// `Made` is the interface that the plug-ins of this registry implement; `Args` is what making one needs beside settings.
template <class Made, class... Args>
struct RegistryEntry {
  std::string_view name;
  std::string_view summary;  // one sentence, for `framesim list`
  std::vector<ParameterInfo> parameters;
  std::unique_ptr<Made> (*make)(const Settings& settings, Args... args);
};

[[noreturn]] void unknown_name(std::string_view kind, const Spec& spec, const std::vector<std::string_view>& known);

// The entry called spec.name. Throws InputError (at spec.where) with all names if there is none.
template <class Entry>
const Entry& find_entry(std::string_view kind, std::span<const Entry> entries, const Spec& spec) {
  std::vector<std::string_view> known;
  for (const Entry& entry : entries) {
    if (entry.name == spec.name) return entry;
    known.push_back(entry.name);
  }
  unknown_name(kind, spec, known);
}

}  // namespace framesim
