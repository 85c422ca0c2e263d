// The two ways in which something can be wrong, and the one place that each is reported from.
//
// InputError: what a person gave us is wrong. Carries file:line:column, what was found and what is allowed. Exit code 3
//             (2 where the input is the command line).
// InternalError: an invariant of framesim itself is broken. Carries the values. Exit code 4.
#pragma once

#include <stdexcept>
#include <string>

namespace framesim {

// Where a piece of input came from. `line` 0 means that there is no line (a folder, a command-line argument).
struct InputLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

// "file:line:column", "file:line" or "file", whichever is known.
std::string to_string(const InputLocation& where);

class InputError : public std::runtime_error {
 public:
  InputError(InputLocation where, const std::string& message)
      : std::runtime_error(to_string(where) + ": " + message), where_(std::move(where)) {}
  const InputLocation& where() const { return where_; }

 private:
  InputLocation where_;
};

// A word on the command line that cannot be taken (unknown name, value out of range). Exit code 2.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

class InternalError : public std::logic_error {
  using std::logic_error::logic_error;
};

// Throws InternalError with source position, the failed condition and `detail`.
[[noreturn]] void fail_check(const char* file, int line, const char* condition, const std::string& detail);

// What a machine, a scene or an effect asks for takes longer than simulated time can hold: a day for one stage of one frame,
// 106 days in all. Throws InputError with `detail`: costs and times come from people, and only the run shows that they are
// too much together.
[[noreturn]] void refuse_time(const std::string& detail);

}  // namespace framesim

// FRAMESIM_CHECK(condition, fmt::format(...)): the detail is only built when the condition is false.
#define FRAMESIM_CHECK(condition, detail) \
  (static_cast<bool>(condition) ? void(0) : ::framesim::fail_check(__FILE__, __LINE__, #condition, (detail)))
