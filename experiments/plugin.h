// Plug-ins at run time: shared libraries whose policies join the registry (sim/plugin.h).
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace framesim {

// Opens the library and registers its policies; it stays open to the end of the program. Throws InputError (the library
// is the file at fault: exit code 3) if it cannot be opened, is no plug-in, was compiled against another interface or
// layout, or brings a policy whose name is taken. Not to be called while a run goes on.
void load_plugin(const std::string& path);

// `--plugin FILE`, which may be repeated: loaded while the command line is read, before the verb begins.
void add_plugin_option(CLI::App& verb);

}  // namespace framesim
