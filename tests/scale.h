// How many repetitions a randomized test makes: POINSOT_TEST_SCALE scales the count, so that the build with sanitizers,
// ten times as slow, runs every test and ends in time. At least one is always made.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace poinsot {

inline int scaled(int count) {
  const char* scale = std::getenv("POINSOT_TEST_SCALE");
  return std::max(1, static_cast<int>(std::lround(count * (scale ? std::atof(scale) : 1.0))));
}

}  // namespace poinsot
