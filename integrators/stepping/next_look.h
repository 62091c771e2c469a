// When what springs pass within steps of a fixed length is looked at next: a look at every step would cost as much as
// many a step.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace poinsot {

class NextLook {
 public:
  // Whether it is at the end of the step of h under way.
  bool due(double h) { return --wait_ <= 0 || h != h_; }
  // Whether the step of h that ends at t begins where the last look was.
  bool goes_on(double t, double h) const {
    constexpr double kSame = 1e-6;  // of a step
    return std::abs(t - h - t_) <= kSame * h;
  }
  // After a look at t: the next one is after so many steps of h, at least one.
  void after(double t, double h, double steps) {
    t_ = t, h_ = h;
    wait_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
  }

 private:
  double t_ = 0, h_ = 0;  // of the last look, of the steps from there
  std::int64_t wait_ = 0;
};

}  // namespace poinsot
