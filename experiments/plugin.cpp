#include "experiments/plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "experiments/version.h"
#include "policies/registry.h"
#include "sim/plugin.h"

namespace framesim {
namespace {

// A name without a slash means a file here, as everywhere else on the command line, not one on the loader's search
// path.
std::string loader_path(const std::string& path) { return path.find('/') == std::string::npos ? "./" + path : path; }

// Why it cannot be taken; empty if it can.
std::string misfit(const PluginInfo& info) {
  if (info.magic != PluginInfo::kMagic) return "its symbol framesim_plugin is no PluginInfo";
  if (info.interface != kPluginInterface) {
    return fmt::format(
        "it was compiled for plug-in interface {}, this is framesim {} with interface {}; compile it again",
        info.interface, version(), kPluginInterface);
  }
  if (info.layout != plugin_layout()) {
    return fmt::format(
        "its types have another layout than those of this framesim {} ({:016x}, not {:016x}); compile it again with "
        "this "
        "version's headers and the same compiler family",
        version(), info.layout, plugin_layout());
  }
  return info.register_policies == nullptr ? "it registers nothing" : "";
}

}  // namespace

void load_plugin(const std::string& path) {
  const InputLocation where{path};
  if (!std::filesystem::is_regular_file(path))
    throw InputError(where, "there is no such file; a plug-in is a shared library");
  void* library = dlopen(loader_path(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw InputError(where, fmt::format("this is no shared library that can be loaded: {}", dlerror()));
  const auto* info = static_cast<const PluginInfo*>(dlsym(library, "framesim_plugin"));
  const std::string reason = info == nullptr ? "it has no symbol framesim_plugin; see sim/plugin.h" : misfit(*info);
  if (!reason.empty()) {
    dlclose(library);
    throw InputError(where, "this plug-in cannot be taken: " + reason);
  }
  try {
    info->register_policies(register_policy);
  } catch (const InputError& error) {
    throw InputError(where, fmt::format("plug-in '{}': {}", info->name, error.what()));
  }
}

void add_plugin_option(CLI::App& verb) {
  verb.add_option("--plugin", "Shared library with policies of your own; may be repeated; see sim/plugin.h")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->each([](const std::string& path) { load_plugin(path); });
}

}  // namespace framesim
