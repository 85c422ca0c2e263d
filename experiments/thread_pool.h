// Independent tasks on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace framesim {

// Calls task(i) for each i in [0, count) on at most `jobs` threads (on the calling thread if `jobs` is 1). Tasks are
// started in ascending i and may end in any order: a task stores its result by its index, so that nothing depends on
// the number of threads. If tasks throw, no further one is started and the exception of the lowest index is rethrown,
// which is the same one for any `jobs`.
void parallel_for(std::size_t count, int jobs, const std::function<void(std::size_t)>& task);

// Threads to use when the user names no number: the processors that there are, at least 1.
int default_jobs();

}  // namespace framesim
