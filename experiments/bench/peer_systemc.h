// SystemC wants to own the program: what is to run with it runs inside its sc_main.
#pragma once

#include <functional>

namespace framesim::bench {

// Calls `body` from sc_main, after the model of peer_systemc.cpp has been built.
void run_in_systemc(const std::function<void()>& body);

}  // namespace framesim::bench
