// What to solve a scene with, found by running it: a reference, the cheapest way to an accuracy (calibration.h), and
// what in the scene costs without mattering.
#pragma once

#include <string>
#include <vector>

#include "bench/study/calibration.h"

namespace poinsot::study {

struct Advice {
  Reference reference;                  // without one nothing can be checked, and the rest is empty
  std::vector<std::size_t> unresolved;  // quantities asked for that the reference resolves less than the accuracy
  Calibration calibration;
  std::vector<std::string> waste;  // sentences, scene_waste.h
};

// To t = `end`, s. Notices are for the user.
Advice advise(const Scene& scene, double end, const Asked& asked, const Cache& cache,
              std::vector<std::string>& notices);

}  // namespace poinsot::study
