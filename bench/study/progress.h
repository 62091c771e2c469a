// How far a long computation is, told to whoever asked for it: a program that draws a line, or nobody.
#pragma once

#include <functional>

namespace poinsot::study {

struct Progress {
  double done, all;    // in runs, or in what the computation says
  double skipped = 0;  // of `done`, what took no time: found done already
};
using ProgressCallback = std::function<void(const Progress&)>;  // empty: nobody asks

// Tells it before each of so many runs.
class RunCounter {
 public:
  RunCounter(std::size_t runs, const ProgressCallback& told) : all_(static_cast<double>(runs)), told_(told) {}

  void next() {
    if (told_) told_({done_, all_});
    ++done_;
  }

 private:
  double done_ = 0, all_;
  const ProgressCallback& told_;
};

}  // namespace poinsot::study
