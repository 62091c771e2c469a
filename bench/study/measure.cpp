#include "bench/study/measure.h"

#include <sched.h>

#include <algorithm>
#include <cmath>

#include "core/input_error.h"
#include "core/interruption.h"

namespace poinsot::study {
namespace {

// Linear between the two neighbours in rank.
double quantile(const std::vector<double>& sorted, double share) {
  const double rank = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

}  // namespace

Timing timing(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double median = quantile(values, 0.5);
  return {median, median > 0 ? (quantile(values, 0.75) - quantile(values, 0.25)) / median : 0};
}

Timing us_per_step(const Cell& cell, PhaseSeconds phase) {
  if (cell.runs.empty()) return {};
  std::vector<double> us;
  for (const Statistics& run : cell.runs) us.push_back(1e6 * phase(run) / static_cast<double>(run.steps));
  return timing(us);
}

double iterations_per_step(const Cell& cell) {
  if (cell.runs.empty()) return 0;
  return static_cast<double>(cell.runs[0].newton_iterations) / static_cast<double>(cell.runs[0].steps);
}

int pin_to_one_core() {
  const int core = sched_getcpu();
  if (core < 0) return -1;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(core), &set);
  return sched_setaffinity(0, sizeof set, &set) == 0 ? core : -1;
}

void in_turn(std::size_t runs, const Rounds& rounds, const std::function<void(std::size_t, int)>& run) {
  for (int round = rounds.warm_up ? -1 : 0; round < rounds.repetitions; ++round) {
    for (std::size_t k = 0; k < runs; ++k) {
      if (interruption_requested) return;
      run(k, round);
      if (rounds.after) rounds.after(k);
    }
  }
}

void measure(std::vector<Cell>& cells, const Rounds& rounds) {
  in_turn(cells.size(), rounds, [&](std::size_t k, int round) {
    Cell& cell = cells[k];
    if (!cell.failure.empty()) return;
    try {
      const Outcome outcome = simulate(*cell.scene, cell.settings, [](const Sample&) {});
      if (outcome.status.failure == Failure::interrupted) return;  // the runs before it count
      cell.refused = outcome.status.failure == Failure::refused;
      if (!outcome.status.ok())
        cell.failure = outcome.status.message;
      else if (round >= 0)
        cell.runs.push_back(outcome.statistics);
    } catch (const InputError& refused) {
      cell.failure = refused.what();
    }
    if (!cell.failure.empty()) cell.runs.clear();
  });
}

}  // namespace poinsot::study
