// Two folders of results: what changed beyond the noise, what is missing, what cannot be compared and why.
//
// Times are compared of one processor, compiler and flags only. Of raw.csv the k-th repetition of a cell in B is
// divided by the k-th in A, and a time has changed where the interval of the median of the quotients does not hold 1;
// all cells moving alike is the machine as well as the program, so the median of all quotients is told beside them. Of
// charts and studies, which keep no repetitions, a time has changed where it did by a tenth and by three times what the
// two spreads allow: spreads are those of a run, while two runs of one program, minutes apart, differ by some
// hundredths. Counts and statuses have changed where they differ, errors of a chart where they do by more than its
// reference resolves. Studies are compared case by case, also those in folders of the two.
#pragma once

#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/study/interval.h"

namespace poinsot::report {

// Of an interval that is to say that one of some hundred times has changed.
inline constexpr double kOfChange = 0.999;

struct TimeChange {
  std::string file, cell;
  double before = 0, after = 0;  // µs a step, of charts and studies s
  study::Interval ratio;         // after / before; of those what the spreads allow, with no confidence
};

struct OtherChange {
  std::string file, cell, quantity, before, after;
};

struct Comparison {
  struct Origin {
    std::string key, a, b;
  };
  std::vector<Origin> origins;              // that differ
  std::vector<std::string> only_a, only_b;  // files, and cells as "FILE: CELL"
  std::vector<std::string> not_compared;    // sentences
  std::size_t times = 0;                    // compared
  double common = 1;                        // median of their quotients
  double by_chance = 0;                     // changed times to be expected where nothing changed, of raw.csv
  std::vector<TimeChange> changed_times;
  std::vector<OtherChange> changed;

  bool incomparable = false;  // something was computed otherwise, so that nothing of it could be compared

  bool same() const {
    return !incomparable && changed_times.empty() && changed.empty() && only_a.empty() && only_b.empty();
  }
};

Comparison compare(const Results& a, const Results& b);

}  // namespace poinsot::report
