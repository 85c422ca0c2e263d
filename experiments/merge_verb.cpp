// framesim merge: shards of a sweep into one store.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/store/merge.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct MergeOptions {
  std::string out;
  std::vector<std::string> in;
  bool partial = false;
};

void merge(const MergeOptions& options, const Session& session) {
  check_writable(options.out);
  const MergeOutcome outcome = merge_stores(options.out, options.in, options.partial);
  if (!session.quiet) fmt::print(stderr, "{}: {} of {} runs\n", options.out, outcome.runs, outcome.of);
}

}  // namespace

void add_merge(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("merge", "Join the stores of a sweep's shards into one");
  const auto options = std::make_shared<MergeOptions>();
  verb->add_option("OUT", options->out, "The store to make; it must not be there yet")->type_name("")->required();
  verb->add_option("IN", options->in, "Stores of shards of one sweep")->type_name("")->required();
  verb->add_flag("--partial", options->partial, "Join what there is, even if runs are missing");
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "The result has the content of one undisturbed run of the whole sweep. Refused, with nothing written: stores of\n"
      "different sweeps, inputs or programs; stores that disagree about a run; missing runs (the message says which "
      "shards\n"
      "to run again with --resume).\n"
      "Examples:\n"
      "  framesim merge results.sqlite part-*.sqlite\n"
      "  framesim merge --partial so-far.sqlite part-0.sqlite part-2.sqlite");
  verb->callback([options, &session] { merge(*options, session); });
}

}  // namespace framesim
