// Where Newton's method starts in a step: on the line through what the last two steps found.
//
// Unknowns z of steps of one length h follow a smooth motion, so that the line misses the next z by h² z̈ in the place
// of h ż: one iteration does where two did. What the steps find does not change by it, but by the stopping test's
// tolerance.
#pragma once

#include <Eigen/Core>

namespace poinsot {

class Extrapolation {
 public:
  using Vector = Eigen::VectorXd;

  explicit Extrapolation(const Vector& z) : before_(z) {}

  // z, what the last step found, becomes where the next one starts.
  void lead(Vector& z) {
    before_ = 2 * z - before_;
    before_.swap(z);
  }
  // z is all that is known: the next step starts from it.
  void restart(const Vector& z) { before_ = z; }
  // The next step is `ratio` times as long as the last one, which found z.
  void resize(const Vector& z, double ratio) { before_ = z + ratio * (before_ - z); }
  // During a step: what the last one found.
  const Vector& before() const { return before_; }

 private:
  Vector before_;
};

}  // namespace poinsot
