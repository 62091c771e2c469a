// One line on stderr that says how far a long run is and how long it still takes; to a terminal only.
#pragma once

#include <chrono>
#include <string_view>

namespace poinsot::app {

class Progress {
 public:
  // Counts from 0 to `end` in `unit` ("s", "runs"). Silent unless `wanted` and stderr is a terminal.
  Progress(double end, std::string_view unit, bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done);
  void skip(double amount) { skipped_ += amount; }  // of `done`, what took no time: found done already
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  double end_, skipped_ = 0;
  std::string_view unit_;
  bool enabled_, drawn_ = false;
  Clock::time_point start_ = Clock::now(), next_;
};

}  // namespace poinsot::app
