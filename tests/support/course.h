// A run with what it gave out and how often it chose other rows to set aside.
#pragma once

#include <vector>

#include "integrators/simulate.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

struct Course {
  Outcome outcome;
  std::vector<Snapshot> samples;
  int exchanges = 0;

  // Bodies of the last sample; none without one.
  std::vector<BodyState> end() const { return samples.empty() ? std::vector<BodyState>{} : samples.back().bodies; }
};

inline Course move(const Scene& scene, const Settings& settings) {
  Course m;
  m.outcome = simulate(scene, settings, [&](const Sample& sample) {
    m.samples.push_back(snapshot(sample));
    m.exchanges = sample.problem.revision();
  });
  return m;
}

}  // namespace poinsot::test
