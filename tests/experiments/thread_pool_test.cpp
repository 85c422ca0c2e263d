#include "experiments/thread_pool.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/catch.h"

namespace framesim {

TEST_CASE("thread pool: every task runs exactly once, whatever the number of threads") {
  for (const int jobs : {1, 2, 7}) {
    CAPTURE(jobs);
    std::vector<std::atomic<int>> runs(100);
    parallel_for(runs.size(), jobs, [&](std::size_t i) { ++runs[i]; });
    for (const auto& count : runs) CHECK(count == 1);
  }
}

TEST_CASE("thread pool: no tasks is no work") {
  parallel_for(0, 4, [](std::size_t) { FAIL("there is nothing to run"); });
}

TEST_CASE("thread pool: of several failures the one with the lowest index is reported") {
  // Tasks 3, 4, 5 ... all fail. Whichever thread meets its failure first, 3 was started before 4 and must be the answer.
  for (const int jobs : {1, 2, 8}) {
    CAPTURE(jobs);
    std::string message;
    try {
      parallel_for(50, jobs, [](std::size_t i) {
        if (i >= 3) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    CHECK(message == "3");
  }
}

}  // namespace framesim
