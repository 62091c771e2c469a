// Timing of many runs side by side: repetitions that go through all of them in turn, so that what disturbs the machine
// disturbs them alike. Medians and quartiles, never the one best run. Whatever is timed goes through here: tables,
// charts, advice, growth and the timed cases of studies.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "integrators/simulate.h"

namespace poinsot::study {

struct Cell {
  std::string_view name;  // of the scene, in tables
  const Scene* scene;
  Settings settings;

  std::vector<Statistics> runs;  // by repetition
  std::string failure;           // why there are none: refused or failed
  bool refused = false;          // by the linear solver, which does not take such matrices
};

// Of repeated measurements.
struct Timing {
  double median = 0;
  double spread = 0;  // distance of the quartiles relative to the median
};
Timing timing(std::vector<double> values);

// What spreads of measurements made together say of one of them. Few repetitions may agree by chance, and one that was
// disturbed moves their quartiles but not the median: a spread counts as the common one at least, and as four times
// that at the most.
class CommonSpread {
 public:
  explicit CommonSpread(const std::vector<double>& spreads) : median_(spreads.empty() ? 0 : timing(spreads).median) {}
  double of(double spread) const {
    constexpr double kMost = 4;
    return median_ > 0 ? std::clamp(spread, median_, kMost * median_) : spread;
  }

 private:
  double median_;
};

// Microseconds of a phase for one step, over the repetitions.
using PhaseSeconds = double (*)(const Statistics&);  // seconds of a run
Timing us_per_step(const Cell& cell, PhaseSeconds phase);

inline constexpr PhaseSeconds total = [](const Statistics& s) { return s.seconds.total; };
inline constexpr PhaseSeconds assembly = [](const Statistics& s) { return s.seconds.assembly; };
inline constexpr PhaseSeconds factor = [](const Statistics& s) { return s.seconds.factor; };
inline constexpr PhaseSeconds solve = [](const Statistics& s) { return s.seconds.solve; };
inline constexpr PhaseSeconds rest = [](const Statistics& s) { return s.seconds.other; };

double iterations_per_step(const Cell& cell);

// Keeps the calling thread on one processor core; returns its number, -1 where the system does not allow it.
int pin_to_one_core();

// So many rounds, each of them through all that is timed.
struct Rounds {
  int repetitions;
  bool warm_up = true;                                 // a round before them, −1, that does not count
  std::function<void(std::size_t number)> after = {};  // told of each run, and of those that are left out
};
// Comes to an end before the next run where that is asked for (core/interruption.h).
void in_turn(std::size_t runs, const Rounds& rounds, const std::function<void(std::size_t number, int round)>& run);

// Those that have failed are left out.
void measure(std::vector<Cell>& cells, const Rounds& rounds);

}  // namespace poinsot::study
