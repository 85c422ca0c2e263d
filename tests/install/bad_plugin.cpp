#include "sim/plugin.h"

#if defined(BAD_name)
FRAMESIM_PLUGIN("bad",
                add({.name = "static",
                     .make = [](const framesim::Settings&) -> std::unique_ptr<framesim::Policy> { return nullptr; }}))
#else
extern "C" const framesim::PluginInfo framesim_plugin;
#if defined(BAD_interface)
const framesim::PluginInfo framesim_plugin = {.interface = framesim::kPluginInterface + 1, .name = "bad"};
#else
const framesim::PluginInfo framesim_plugin = {.layout = framesim::plugin_layout() + 1, .name = "bad"};
#endif
#endif
