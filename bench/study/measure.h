// Timing of many runs side by side: a warm-up of each, then repetitions that go through all of them in turn, so that
// what disturbs the machine disturbs them alike. Medians and quartiles, never the one best run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/study/progress.h"
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

// Microseconds of a phase for one step, over the repetitions.
using PhaseSeconds = double (*)(const Statistics&);  // seconds of a run
Timing us_per_step(const Cell& cell, PhaseSeconds phase);

double total(const Statistics& s);
double assembly(const Statistics& s);
double factor(const Statistics& s);
double solve(const Statistics& s);
double rest(const Statistics& s);

double iterations_per_step(const Cell& cell);

// Keeps the calling thread on one processor core; returns its number, -1 where the system does not allow it.
int pin_to_one_core();

void measure(std::vector<Cell>& cells, int repetitions, const ProgressCallback& progress);

}  // namespace poinsot::study
