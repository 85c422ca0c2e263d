// What the command line takes: lists of specs of every kind of plug-in, quantities, targets, overlaps.
#include <cstring>

#include "experiments/options.h"
#include "policies/registry.h"
#include "scenes/generator.h"
#include "sim/effect.h"
#include "sim/estimator.h"
#include "sim/planner.h"
#include "sim/quantity.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

namespace {

const InputLocation kWhere{"command line"};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void quantities(const std::string& text) {
  for (const auto parse : {&parse_number, &parse_duration_s, &parse_length_m, &parse_angle_rad}) {
    const QuantityResult result = parse(text);
    fuzz::require(result.value.has_value() == result.error.empty(), "a value or an error, not both");
    if (result.value) fuzz::require(*result.value - *result.value == 0, "a finite quantity");
  }
  const QuantityResult duration = parse_duration_s(text);
  if (!duration.value) return;
  const QuantityResult again = parse_duration_s(format_duration(*duration.value));
  fuzz::require(again.value && same_bits(*again.value, *duration.value), "a duration reads back as it was written");
}

void plug_ins(const Spec& spec) {
  fuzz::accepts([&] { find_entry("policy", policies(), spec).make(spec.settings); });
  fuzz::accepts([&] { find_entry("estimator", estimators(), spec).make(spec.settings); });
  fuzz::accepts([&] { find_entry("planner", planners(), spec).make(spec.settings); });
  fuzz::accepts([&] { find_entry("generator", generators(), spec).make(spec.settings); });
  fuzz::accepts([&] { find_entry("effect", effects(), spec).make(spec.settings, 1); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of(data, size));
  quantities(text);
  fuzz::accepts([&] { read_target_s(text, kWhere); });
  fuzz::accepts([&] { parse_overlap(text, kWhere); });
  std::vector<Spec> specs;
  fuzz::accepts([&] { specs = read_specs({text}, kWhere); });
  for (const Spec& spec : specs) {
    fuzz::require(to_string(parse_spec(to_string(spec), kWhere)) == to_string(spec),
                  "a spec reads back as it was written");
    plug_ins(spec);
  }
  return 0;
}
