// Cases spread over the threads of a process.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "bench/cases/case_run.h"

namespace poinsot::cases {

// Hands out the cases of a selection that have no row, each once, by number. For several threads.
class Undone {
 public:
  Undone(const Selection& selection, const CaseTable& table) : selection_(selection), table_(table) {}

  // The next ones, at most so many; none when all are handed out or an interruption is requested.
  std::vector<std::int64_t> take(std::size_t most);

 private:
  const Selection& selection_;
  const CaseTable& table_;
  std::mutex access_;
  std::int64_t next_ = 0;
};

struct Work {
  std::function<std::vector<std::int64_t>()> take;  // the next cases of a thread; none: it has nothing more to do
  std::function<void(CaseRow&&)> put;
  std::function<void()> meanwhile;  // by the calling thread, at every interval and once more at the end
  std::chrono::microseconds interval{100'000};
};

// Runs in so many threads until all have nothing more to do. The first exception of any ends the others after the case
// they are at, and is thrown.
void run_threads(const Study& study, References& references, int threads, const Work& work);

// Cases that are timed: in this thread, those of one scene in turn. The caller keeps it on one processor core.
void run_timed(const Study& study, References& references, const Work& work);

// As many as this process may use.
int processors();

}  // namespace poinsot::cases
