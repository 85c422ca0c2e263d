// framesim stability: how exact the formulas are on hard cases, beside their naive forms.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/options.h"
#include "experiments/stability/report.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

void stability(const std::string& format, Session& session) {
  const std::vector<StabilityRow> rows = stability_rows();
  if (format == "csv") fmt::print("{}", stability_csv(rows));
  if (format == "markdown") fmt::print("{}", stability_markdown({{this_compiler(), rows}}));
  if (format == "html") fmt::print("{}", stability_html({{this_compiler(), rows}}));
  std::fflush(stdout);
  for (const StabilityRow& row : rows) {
    if (row.within()) continue;
    fmt::print(stderr, "framesim: {}, {}: {} eps, bound {} eps\n", row.group, row.quantity, row.ours.max_eps,
               row.bound_eps);
    session.exit_code = 1;
  }
}

}  // namespace

void add_stability(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand(
      "stability", "Errors of the formulas on hard cases against 50 digits; exit code 1 if one is outside its bound");
  const auto format = std::make_shared<std::string>("markdown");
  verb->add_option("--format", *format, "markdown, csv or html")
      ->type_name("FORMAT")
      ->check(CLI::Validator(CLI::IsMember({"markdown", "csv", "html"})).description(""))
      ->capture_default_str();
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "csv has no compiler in it: what two builds print is compared with cmp.\n"
      "Examples:\n"
      "  framesim stability\n"
      "  framesim stability --format csv");
  verb->callback([format, &session] { stability(*format, session); });
}

}  // namespace framesim
