// Where Newton's method starts in a step: on the polynomial through what the last steps found.
//
// Unknowns z of steps of one length h follow a smooth motion: the parabola through the last three misses the next z by
// the third difference Δ³z, O(h³), the line through two by Δ²z, z itself by Δz. That degree is taken which would have
// come nearest in the last step: where steps do not resolve the motion, or z jumps or rings, that is the least. One
// iteration mostly does where two did from z itself. What a step finds does not change but by the stopping test's
// tolerance.
#pragma once

#include <Eigen/Core>

namespace poinsot {

class Extrapolation {
 public:
  using Vector = Eigen::VectorXd;

  explicit Extrapolation(const Vector& z) : before_(z), first_(Vector::Zero(z.size())), second_(first_) {}

  // z, what the last step found, becomes where the next one starts.
  void lead(Vector& z) {
    double by_z = 0, by_line = 0, by_parabola = 0;  // |Δz|², |Δ²z|², |Δ³z|²
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      const double first = z[k] - before_[k], second = first - first_[k], third = second - second_[k];
      by_z += first * first, by_line += second * second, by_parabola += third * third;
      before_[k] = z[k], first_[k] = first, second_[k] = second;
    }
    if (by_parabola < by_line && by_parabola < by_z)
      z += first_ + second_;
    else if (by_line < by_z)
      z += first_;
  }
  // z is all that is known: the next step starts from it.
  void restart(const Vector& z) {
    before_ = z;
    first_.setZero(), second_.setZero();
  }
  // The next step is `ratio` times as long as the last one, which found z.
  void resize(const Vector& z, double ratio) {
    before_ = z + ratio * (before_ - z);
    first_ *= ratio, second_ *= ratio * ratio;
  }
  // During a step: what the last one found.
  const Vector& before() const { return before_; }

 private:
  Vector before_, first_, second_;  // z, Δz and Δ²z of the last step
};

}  // namespace poinsot
