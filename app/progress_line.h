// One line on stderr that says how far a long computation is and how long it still takes; to a terminal only.
#pragma once

#include <chrono>
#include <string_view>

#include "bench/study/progress.h"

namespace poinsot::app {

class ProgressLine {
 public:
  // Counts in `unit` ("s", "runs"). Silent unless `wanted` and stderr is a terminal.
  ProgressLine(std::string_view unit, bool wanted);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // `more` stands at the end of the line.
  void at(const study::Progress& progress, std::string_view more = {});
  study::ProgressCallback callback();  // must not outlive the line
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string_view unit_;
  bool enabled_, drawn_ = false;
  Clock::time_point start_, next_;
};

}  // namespace poinsot::app
