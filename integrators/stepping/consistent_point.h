// Points of a motion on the constraints: accelerations and multipliers of a state, mass-orthogonal projection.
//
//   [M Gᵀ; G 0] [a; λ] = [Q; γ],   Φ(q, t) = 0,   G v = ν
//
// A method that leaves the constraints by the size e of its local error is brought back by simplified Newton steps with
// the factorization that belongs to the accelerations: one correction leaves e². One step of iterative refinement makes
// a and λ belong to the projected state, again up to e². Neither costs a factorization or the order.
#pragma once

#include <Eigen/Core>
#include <span>

#include "integrators/stepping/step_system.h"

namespace poinsot {

struct Point {
  double t = 0;
  Eigen::VectorXd q, v, z;  // z = (a, λ)
};

class ConsistentPoints {
 public:
  ConsistentPoints(Problem& problem, LinearSolver& solver, Statistics& statistics, PhaseClock& clock);

  // Analyses the pattern. Call once, before the clock starts.
  Status prepare() { return system_.prepare(); }
  Point make() const;
  Point make(double t, const State& state) const;
  void stand(const Point& at);

  // M a + Gᵀλ − Q and G a − γ of a point the problem stands at.
  void residual(const Point& at, std::span<double> out);
  // Makes (a, λ) those of (q, v); the problem stands there and the factorization belongs to it.
  Status accelerations(Point& at);
  // Moves q and v onto the constraints with the factorization at hand, which belongs to a point nearby, and says
  // whether they moved; the problem stands at the result.
  Status project(Point& at, bool& moved);
  // (a, λ) of the point the problem stands at, from those of a point nearby and its factorization.
  Status refine(Point& at);
  // All three: the consistent point beside (q, v).
  Status complete(Point& at);

  std::span<const double> a(const Point& at) const { return std::span(at.z.data(), nv_); }
  std::span<const double> lambda(const Point& at) const { return std::span(at.z.data() + nv_, nc_); }
  void give(const Point& at, State& state) const;

 private:
  std::span<double> rates() { return std::span(rhs_.data(), nv_); }
  std::span<double> rows() { return std::span(rhs_.data() + nv_, nc_); }

  Problem& problem_;
  StepSystem system_;
  const std::size_t nv_, nc_;
  Eigen::VectorXd rhs_, zeros_, rows_, q_moved_;
};

}  // namespace poinsot
