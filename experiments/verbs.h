// The verbs of the command line. Each adds its subcommand, whose callback does the work.
#pragma once

namespace CLI {
class App;
}

namespace framesim {

// What verbs share with main.
struct Session {
  bool quiet = false;  // no progress, no remarks on stderr
  int exit_code = 0;   // 1 if `check` found a difference, or `stability` a row outside its bound
};

void add_list(CLI::App& app, Session& session);
void add_run(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_explain(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_tradeoff(CLI::App& app, Session& session);
void add_stability(CLI::App& app, Session& session);

}  // namespace framesim
