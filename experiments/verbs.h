// The verbs of the command line. Each adds its subcommand, whose callback does the work.
#pragma once

namespace CLI {
class App;
}

namespace framesim {

// What verbs share with main.
struct Session {
  bool quiet = false;  // no progress, no remarks on stderr
  int exit_code = 0;   // 1: `check` found a difference, `compare` a regression, `stability` a row outside its bound
};

void add_list(CLI::App& app, Session& session);
void add_run(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_explain(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_tradeoff(CLI::App& app, Session& session);
void add_reproduce(CLI::App& app, Session& session);
void add_stability(CLI::App& app, Session& session);
void add_fit(CLI::App& app, Session& session);
void add_import(CLI::App& app, Session& session);
void add_sweep(CLI::App& app, Session& session);
void add_merge(CLI::App& app, Session& session);
void add_query(CLI::App& app, Session& session);
void add_report(CLI::App& app, Session& session);
void add_man(CLI::App& app);  // both read the finished app: add them last
void add_completion(CLI::App& app);

}  // namespace framesim
