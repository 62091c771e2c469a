#include "formulations/callback_loads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/so3.h"

namespace poinsot {

CallbackLoads::CallbackLoads(const CallbackForce& of)
    : force(&of), states(of.bodies.size()), loads(of.bodies.size()), beside_(of.bodies.size()) {
  const auto n = static_cast<Eigen::Index>(6 * of.bodies.size());
  by.position.setZero(n, n);
  by.velocity.setZero(n, n);
}

void CallbackLoads::evaluate(double t) {
  std::ranges::fill(loads, Load());
  force->loads(t, states, loads);
}

void CallbackLoads::differentiate(double t) {
  if (!force->sensitivity) return difference(t);
  by.position.setZero();
  by.velocity.setZero();
  force->sensitivity(t, states, by);
}

void CallbackLoads::difference(double t) {
  evaluate(t);
  std::swap(loads, beside_);  // the loads here, from now on
  const double rounding = std::sqrt(std::numeric_limits<double>::epsilon());
  const auto column = [&](Eigen::MatrixXd& of, Eigen::Index k, double h) {
    evaluate(t);
    for (std::size_t a = 0; a < loads.size(); ++a) {
      const auto row = static_cast<Eigen::Index>(6 * a);
      of.block<3, 1>(row, k) = (loads[a].force - beside_[a].force) / h;
      of.block<3, 1>(row + 3, k) = (loads[a].torque - beside_[a].torque) / h;
    }
  };
  const auto by_entries = [&](Vector3& x, Eigen::MatrixXd& of, Eigen::Index k) {
    for (Eigen::Index l = 0; l < 3; ++l) {
      const double here = x[l];
      x[l] = here + rounding * std::max(1.0, std::abs(here));
      column(of, k + l, x[l] - here);
      x[l] = here;
    }
  };
  for (std::size_t b = 0; b < states.size(); ++b) {
    const auto k = static_cast<Eigen::Index>(6 * b);
    BodyState& state = states[b];
    by_entries(state.r, by.position, k);
    const Matrix3 A = state.A;
    for (Eigen::Index l = 0; l < 3; ++l) {
      state.A = A * exp_so3<double>(Vector3(rounding * Vector3::Unit(l)));
      column(by.position, k + 3 + l, rounding);
    }
    state.A = A;
    by_entries(state.rd, by.velocity, k);
    by_entries(state.w, by.velocity, k + 3);
  }
  std::swap(loads, beside_);
}

double sensitivity_error(const CallbackForce& force, std::span<const BodyState> states) {
  CallbackLoads given(force), differenced(force);
  given.states.assign(states.begin(), states.end());
  differenced.states = given.states;
  given.differentiate(0);
  differenced.difference(0);
  double error = 0;
  for (const auto& [x, y] : {std::pair(&given.by.position, &differenced.by.position),
                             std::pair(&given.by.velocity, &differenced.by.velocity)}) {
    const double size = std::max(x->cwiseAbs().maxCoeff(), y->cwiseAbs().maxCoeff());
    const double off = (*x - *y).cwiseAbs().maxCoeff();
    if (!(off <= error * size)) error = size > 0 ? off / size : std::numeric_limits<double>::infinity();
  }
  return error;
}

}  // namespace poinsot
