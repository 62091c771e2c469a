#include "bench/cases/executor.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <thread>

#include "core/interruption.h"

namespace poinsot::cases {

std::vector<std::int64_t> Undone::take(std::size_t most) {
  std::vector<std::int64_t> numbers;
  if (interruption_requested) return numbers;
  const std::lock_guard lock(access_);
  for (; next_ < selection_.size() && numbers.size() < most; ++next_)
    if (const std::int64_t number = selection_.at(next_); !table_.has(number)) numbers.push_back(number);
  return numbers;
}

void run_threads(const Study& study, References& references, int threads, const Work& work) {
  std::mutex access;
  std::condition_variable ended;
  std::exception_ptr first;
  std::atomic<bool> stop = false;
  int running = threads;
  const auto compute = [&] {
    try {
      CaseRunner runner(study, references);
      for (std::vector<std::int64_t> numbers; !stop && !(numbers = work.take()).empty();) {
        for (const std::int64_t number : numbers) {
          if (stop) break;
          if (std::optional<CaseRow> row = runner.run(number)) work.put(std::move(*row));
        }
      }
    } catch (...) {
      stop = true;
      const std::lock_guard lock(access);
      if (!first) first = std::current_exception();
    }
    const std::lock_guard lock(access);
    if (--running == 0) ended.notify_one();
  };
  std::vector<std::jthread> pool;
  for (int k = 0; k < threads; ++k) pool.emplace_back(compute);
  std::unique_lock lock(access);
  while (running > 0) {
    ended.wait_for(lock, work.interval);
    lock.unlock();
    try {
      work.meanwhile();
    } catch (...) {  // the threads are waited for
      stop = true;
      throw;
    }
    lock.lock();
  }
  pool.clear();
  if (first) std::rethrow_exception(first);
}

void run_timed(const Study& study, References& references, const Work& work) {
  CaseRunner runner(study, references);
  std::vector<std::int64_t> block;
  for (bool more = true; more && !interruption_requested;) {
    const std::vector<std::int64_t> next = work.take();
    more = !next.empty();
    if (!block.empty() && (!more || !same_scene(study, block.front(), next.front()))) {
      for (CaseRow& row : runner.run_timed(block)) work.put(std::move(row));
      block.clear();
      work.meanwhile();
    }
    block.insert(block.end(), next.begin(), next.end());
  }
}

int processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? std::max(1, CPU_COUNT(&set)) : 1;
}

}  // namespace poinsot::cases
