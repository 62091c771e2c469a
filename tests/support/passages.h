// Passages through singular positions: posts in a row with couplers, all in one line where a run starts or on the way.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <ostream>
#include <vector>

#include "core/body_state.h"
#include "tests/support/loops.h"

namespace poinsot::test {

inline constexpr double kPassed = 0.2, kSpin = -3;

struct Passage {
  int loops;
  double angle;  // rad, at the start
  bool redundant;

  Scene scene() const { return posts(loops, angle, kSpin, redundant); }
  double off(const BodyState& post) const {
    const double phi = swung(loops, angle, kSpin, kPassed);
    return (post.r - Vector3(0.5 * std::cos(phi), 0.5 * std::sin(phi), 0)).norm();
  }
  friend std::ostream& operator<<(std::ostream& out, const Passage& p) {
    return out << fmt::format("{} loops from {} rad, {}", p.loops, p.angle, p.redundant ? "redundant" : "planar");
  }
};

inline std::vector<Passage> passages() {
  std::vector<Passage> all;
  for (const int loops : {1, 2})
    for (const double angle : {0.0, 1e-13, 1e-7, 0.05})
      for (const bool redundant : {true, false}) all.push_back({loops, angle, redundant});
  return all;
}

}  // namespace poinsot::test
