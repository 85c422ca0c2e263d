// How far a long command is: one line on stderr, rewritten in place.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace framesim {

// Silent unless stderr is a terminal and `quiet` is false. `advance` may be called from any thread.
class Progress {
 public:
  Progress(std::string unit, std::int64_t total, bool quiet);
  ~Progress();  // wipes the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance();

 private:
  void draw(std::int64_t done);

  using Clock = std::chrono::steady_clock;
  std::string unit_;
  std::int64_t total_;
  bool visible_;
  bool color_;
  std::atomic<std::int64_t> done_{0};
  std::mutex drawing_;
  Clock::time_point start_;
  Clock::time_point next_draw_;
  bool drawn_ = false;
};

}  // namespace framesim
