// framesim explain: what a run would compute and what it leaves out, without running it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>

#include "experiments/options.h"
#include "experiments/plugin.h"
#include "experiments/verbs.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

struct ExplainOptions {
  std::string scene, policy = "robin-hood";
  SharedOptions shared;
};

const InputLocation kCommandLine{"command line"};

struct HookName {
  Hook hook;
  std::string_view name, meaning;
};
constexpr std::array<HookName, 6> kHooks = {
    {{Hook::machine, "machine", "at load: the machine is another one"},
     {Hook::frame, "frame", "before each frame: logic time, vertical blanks"},
     {Hook::workload, "workload", "each visible instance: what it is worth"},
     {Hook::commands, "commands", "each command: its times, or further commands"},
     {Hook::outcome, "outcome", "after each frame: what policy and estimator are told"},
     {Hook::after, "after", "after each frame: the effect's own state"}}};

struct ColumnName {
  Columns column;
  std::string_view name;
};
// Estimated cost is not among them: estimators price every level, because the records need it.
constexpr std::array<ColumnName, 5> kColumns = {{{Columns::depth, "depth"},
                                                 {Columns::distance, "distance"},
                                                 {Columns::view_angle, "view angle"},
                                                 {Columns::area, "un-projected area"},
                                                 {Columns::diagonal, "diagonal"}}};

constexpr bool all_columns_named() {
  Columns named = Columns::cost;
  for (const ColumnName& column : kColumns) named = named | column.column;
  return named == Columns::all;
}
static_assert(all_columns_named());

bool runs(const Plan::EffectState& effect, bool force_inert) {
  return effect.declared && (!effect.inert || force_inert);
}

std::string names_of(const Plan& plan, bool force_inert, auto&& wanted) {
  std::string names;
  for (const Plan::EffectState& effect : plan.effects) {
    if (runs(effect, force_inert) && wanted(effect)) names += (names.empty() ? "" : ", ") + effect.name;
  }
  return names;
}

std::string_view name_of(EngineKind kind) { return kEngineKindNames[static_cast<std::size_t>(kind)]; }

// What the times are exact for: the overlap, and by name every effect that takes part.
std::string exact_for(const Plan& plan, bool force_inert) {
  const std::string active = names_of(plan, force_inert, [](const Plan::EffectState&) { return true; });
  return fmt::format("exact for overlap {}{}", to_string(plan.overlap),
                     active.empty() ? ", no effect is active" : " with " + active);
}

// Why the engine that is exact for the run is the one that it is.
std::string why_exact(const Plan& plan, bool force_inert) {
  const std::string need = names_of(plan, force_inert, [](const Plan::EffectState& e) { return e.needs_events; });
  switch (plan.exact) {
    case EngineKind::closed_form:
      return "one formula a frame";
    case EngineKind::events:
      return "needed for " + need;
    case EngineKind::recurrence:
    case EngineKind::automatic:
      break;
  }
  return "one pass over the commands";
}

std::string engine_text(const Plan& plan, bool force_inert) {
  const std::string_view asked = plan.asked == EngineKind::automatic ? "" : "asked for; ";
  const std::string exact = exact_for(plan, force_inert);
  const std::string why = why_exact(plan, force_inert);
  if (!plan.parts.left_out.empty()) {
    return fmt::format("{}: {}not exact, as {} would be ({}; {})", name_of(plan.engine), asked, name_of(plan.exact),
                       exact, why);
  }
  if (plan.engine == plan.exact) return fmt::format("{}: {}{}; {}", name_of(plan.engine), asked, exact, why);
  return fmt::format("{}: {}{}; the {} gives the same times sooner", name_of(plan.engine), asked, exact,
                     name_of(plan.exact));
}

std::string effect_text(const Plan::EffectState& effect, bool force_inert) {
  if (!effect.declared) return "not declared";
  if (!effect.inert) return fmt::format("active: {}", *effect.declared);
  return fmt::format("{}: {} ({})", force_inert ? "inert, but forced in" : "inert", *effect.inert, *effect.declared);
}

std::string items_text(const Plan& plan) {
  const WorkloadRequest& request = plan.policy.request;
  return fmt::format("{}, {}", request.curves ? "discrete levels and curves" : "discrete levels",
                     request.hierarchy ? "in their hierarchy" : "as a flat list");
}

std::string column_text(const Plan& plan, Columns column, bool force_inert) {
  std::string readers = has(plan.policy.request.columns, column) ? "policy " + plan.parts.policy : "";
  const std::string effects =
      names_of(plan, force_inert, [&](const Plan::EffectState& e) { return has(e.columns, column); });
  if (!effects.empty()) readers += (readers.empty() ? "effects " : "; effects ") + effects;
  return readers.empty() ? "not computed" : "computed for " + readers;
}

std::string describe_plan(const Plan& plan, bool force_inert) {
  const RunResult& parts = plan.parts;
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<14} {}\n", name, value);
  };
  const auto row = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<18} {}\n", name, value);
  };
  line("scene", parts.title.empty() ? parts.scene : fmt::format("{}: {}", parts.scene, parts.title));
  line("machine", parts.machine);
  line("policy", fmt::format("{}, planner {}, estimator {}", parts.policy, parts.planner, parts.estimator));
  line("engine", engine_text(plan, force_inert));
  for (const std::string& loss : parts.left_out) line("leaves out", loss);
  text += "effects, in the order in which they apply\n";
  for (const Plan::EffectState& effect : plan.effects) row(effect.name, effect_text(effect, force_inert));
  text += "hooks\n";
  for (const HookName& hook : kHooks) {
    const std::string users =
        names_of(plan, force_inert, [&](const Plan::EffectState& e) { return has(e.hooks, hook.hook); });
    row(hook.name, fmt::format("{} ({})", users.empty() ? "empty" : users, hook.meaning));
  }
  text += fmt::format("visible instances: {}\n", items_text(plan));
  row("projected area", "always computed");
  row("benefit", "always computed");
  row("estimated cost", "always computed");
  for (const ColumnName& column : kColumns) row(column.name, column_text(plan, column.column, force_inert));
  return text;
}

void explain(const ExplainOptions& options) {
  RunSpec spec = read_shared(options.shared, kCommandLine);
  spec.scene = parse_spec(options.scene, kCommandLine);
  spec.policy = parse_spec(options.policy, kCommandLine);
  const Scene scene = load_scene(spec.scene, spec.limits);
  spec.target_s = scene.targets_s.front();
  fmt::print("{}", describe_plan(plan(spec, scene), spec.force_inert));
}

}  // namespace

void add_explain(CLI::App& app, Session&) {
  CLI::App* verb = app.add_subcommand("explain", "Say what a run would compute and what it leaves out, and why");
  const auto options = std::make_shared<ExplainOptions>();
  verb->add_option("SCENE", options->scene,
                   "A name from 'framesim list scenes', with parameters as name:key=value, or a scene file")
      ->type_name("")
      ->required();
  verb->add_option("--policy", options->policy, "A name from 'framesim list policies', with parameters")
      ->type_name("SPEC")
      ->capture_default_str();
  add_plugin_option(*verb);
  add_shared_options(*verb, options->shared);
  verb->footer(
      "An effect is active, inert (declared, but it cannot change the result, and is left out) or not declared.\n"
      "Examples:\n"
      "  framesim explain street\n"
      "  framesim explain street --policy distance --effect vsync:rate=60Hz --effect jitter\n"
      "  framesim explain auditorium --overlap serial --effect frames-in-flight:n=2\n"
      "  framesim explain dong-forest --effect streaming:memory=16 --fidelity recurrence");
  verb->callback([options] { explain(*options); });
}

}  // namespace framesim
