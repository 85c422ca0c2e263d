// framesim sweep: many runs into a store that survives.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>

#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/plugin.h"
#include "experiments/store/sweep.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct SweepOptions {
  std::string file, store, shard = "0/1";
  std::vector<std::string> plugins;
  bool resume = false;
  int jobs = default_jobs();
};

void sweep(const SweepOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  const Shard shard = parse_shard(options.shard);
  check_writable(options.store);
  Sweep plan = read_sweep(options.file);
  std::string command = "framesim sweep " + options.file;
  for (const std::string& plugin : options.plugins) {
    add_input_files("plug-in " + std::filesystem::path(plugin).filename().string(), plugin, plan.inputs);
    command += " --plugin " + plugin;
  }
  SweepOutcome outcome;
  {
    Store store =
        Store::begin(options.store, identity_of(plan, shard), this_program(std::move(command)), options.resume);
    outcome = run_sweep(plan, shard, store, options.jobs, session.quiet);
  }
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (outcome.signal != 0) {
    fmt::print(stderr, "framesim: interrupted: {} of {} runs are in {}; --resume goes on with it\n",
               outcome.already + outcome.made, outcome.due, options.store);
    std::raise(outcome.signal);  // by now with its default action: the shell sees what ended us
  }
  if (session.quiet) return;
  const std::string before = outcome.already > 0 ? fmt::format(", {} were there before", outcome.already) : "";
  fmt::print(stderr, "{}: {} runs{}{}; took {:.1f} s\n", options.store, outcome.due,
             shard.count > 1 ? fmt::format(" of shard {}", to_string(shard)) : "", before, took_s);
}

}  // namespace

void add_sweep(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("sweep", "Run scenes x policies x parameters x targets x seeds into a store");
  const auto options = std::make_shared<SweepOptions>();
  verb->add_option("SPEC", options->file, "TOML file that says what to run: see below")->type_name("")->required();
  verb->add_option("--store", options->store, "SQLite file for the results")->type_name("FILE")->required();
  verb->add_flag("--resume", options->resume,
                 "Go on with a store that is there: run what is missing. Without it, a store with content is refused");
  verb->add_option(
          "--shard", options->shard,
          "i/n: only the runs whose number leaves remainder i when divided by n. i from 0 to n; n stands for 0, so "
          "that job arrays may count from 0 or from 1. Each shard has a store of its own; see 'framesim merge'")
      ->type_name("i/n")
      ->capture_default_str();
  add_plugin_option(*verb);
  add_jobs_option(*verb, options->jobs);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "SPEC has framesim = 1 and the lists scenes and policies; it may have the lists targets (or [\"all\"]), "
      "estimators,\n"
      "planners, overlaps, effects, no_effects, and machine, seeds (how many), first_seed, frames, fidelity, "
      "yardstick\n"
      "(none, bound, least, parts; least and parts make ideal runs for each run), frame_rows (true: keep every frame), "
      "and\n"
      "tables [[vary]] with of (scene, policy, estimator, planner, effect), name, key, values: a run for each value.\n"
      "Each run is one transaction: kill the program at any point, and --resume gives what an undisturbed sweep "
      "gives.\n"
      "Examples:\n"
      "  framesim sweep sweep.toml --store results.sqlite --jobs 4\n"
      "  framesim sweep sweep.toml --store results.sqlite --resume\n"
      "  framesim sweep sweep.toml --store part-$SLURM_ARRAY_TASK_ID.sqlite --resume \\\n"
      "    --shard $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT\n"
      "  framesim query results.sqlite");
  verb->callback([options, verb, &session] {
    options->plugins = verb->get_option("--plugin")->results();
    sweep(*options, session);
  });
}

}  // namespace framesim
