// What becomes of a run's energy, beside the largest kinetic energy on the way.
#pragma once

#include <algorithm>
#include <vector>

#include "tests/support/simulation.h"

namespace poinsot::test {

struct EnergyCourse {
  Outcome outcome;
  double first = 0, last = 0, most_kinetic = 0;  // J; T + V at the start and the end
  double percent_lost() const { return 100 * (first - last) / most_kinetic; }
};

inline EnergyCourse energy_course(const Scene& scene, const Settings& settings) {
  EnergyCourse course;
  std::vector<double> momentum;
  course.outcome = simulate(scene, settings, [&](const Sample& at) {
    course.last = at.problem.energy();
    if (at.t == 0) course.first = course.last;
    momentum.resize(at.v.size());
    at.problem.momentum(at.v, momentum);
    double twice = 0;
    for (std::size_t k = 0; k < momentum.size(); ++k) twice += at.v[k] * momentum[k];
    course.most_kinetic = std::max(course.most_kinetic, twice / 2);
  });
  return course;
}

}  // namespace poinsot::test
