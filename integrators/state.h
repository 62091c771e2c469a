// A state of a motion: the one place where its vectors get their sizes.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/index.h"
#include "formulations/problem.h"

namespace poinsot {

struct State {
  double t = 0;
  Eigen::VectorXd q, v, z;        // z = (a, λ)
  bool multipliers_open = false;  // by the position, a singular one: λ is that of a state beside it

  // All zero.
  explicit State(const Problem& problem)
      : q(Eigen::VectorXd::Zero(problem.nq())),
        v(Eigen::VectorXd::Zero(problem.nv())),
        z(Eigen::VectorXd::Zero(problem.nv() + problem.nc())) {}

  std::span<double> a() { return {z.data(), index(v.size())}; }
  std::span<const double> a() const { return {z.data(), index(v.size())}; }
  std::span<double> lambda() { return {z.data() + v.size(), index(z.size() - v.size())}; }
  std::span<const double> lambda() const { return {z.data() + v.size(), index(z.size() - v.size())}; }
};

}  // namespace poinsot
