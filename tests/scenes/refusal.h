// What an input is refused with.
#pragma once

#include <string>

#include "sim/check.h"
#include "tests/catch.h"

// The message of the InputError that `act` throws, or "" if it throws none. Any other exception fails the test.
template <class Act>
std::string refusal(Act act) {
  try {
    act();
  } catch (const framesim::InputError& error) {
    return error.what();
  }
  return "";
}

// Whether `message` is "<where>: ...<words>...".
inline bool says(const std::string& message, const std::string& where, const std::string& words) {
  UNSCOPED_INFO("message: " << message << "\nexpected: " << where << ": ..." << words << "...");
  return message.rfind(where + ": ", 0) == 0 && message.find(words) != std::string::npos;
}
