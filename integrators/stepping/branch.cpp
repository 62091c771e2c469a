#include "integrators/stepping/branch.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// Of a velocity, the largest of a body: of its point, and of its turn in the formulation's coordinates.
struct Most {
  double way, turn;
};

// `of`: number k of a velocity.
template <class Velocity>
Most most(const Problem& problem, Velocity&& of) {
  const Eigen::Index nv = problem.nv(), per_body = nv / problem.bodies();
  double way = 0, turn = 0;
  for (Eigen::Index b = 0; b < nv; b += per_body) {
    double squares[2] = {0, 0};
    for (Eigen::Index k = 0; k < per_body; ++k) squares[k > 2] += of(b + k) * of(b + k);
    way = std::max(way, squares[0]);
    turn = std::max(turn, squares[1]);
  }
  return {std::sqrt(way), std::sqrt(turn)};
}

Most most(const Problem& problem, const Eigen::VectorXd& v) {
  return most(problem, [&](Eigen::Index k) { return v[k]; });
}

// The larger of two velocities, of which points and turns are no less than a part of the other: where centres of mass
// rest while bodies turn, or bodies all but do not turn while they move, these are rounding, or begin.
Most larger(double length, const Most& a, const Most& b) {
  constexpr double kPart = 1e-2;
  const double way = std::max(a.way, b.way), turn = std::max(a.turn, b.turn);
  return {std::max(way, kPart * turn * length), std::max(turn, kPart * way / length)};
}

}  // namespace

void BranchWatch::begin(const Problem& problem, std::span<const double> a) {
  const Most change = most(problem, [&](Eigen::Index k) { return a[index(k)]; });
  usual_way_ = change.way, usual_turn_ = change.turn;
  length_ = longest_arm(problem.model());
}

double BranchWatch::jump(const Problem& problem, const Eigen::VectorXd& v_n, const Eigen::VectorXd& v, double h) {
  constexpr double kUnusual = 4, kMoved = 0.1;
  if (problem.model_rows().empty()) return 0;  // no constraints, no branches
  const Most change = most(problem, [&](Eigen::Index k) { return v[k] - v_n[k]; });
  way_ = change.way / h, turn_ = change.turn / h;
  if (!(way_ > kUnusual * usual_way_ || turn_ > kUnusual * usual_turn_)) return 0;
  const Most before = most(problem, v_n), after = most(problem, v);
  const Most size = larger(length_, before, after);
  const auto part = [&](double Most::*of) {  // of no start from rest, which has no branch to leave
    return before.*of > kMoved * after.*of ? change.*of / size.*of : 0;
  };
  return std::max(part(&Most::way), part(&Most::turn));
}

void BranchWatch::follow() {
  const double share = begun_ ? 0.1 : 1;
  begun_ = true;
  usual_way_ += share * (way_ - usual_way_);
  usual_turn_ += share * (turn_ - usual_turn_);
}

Departure departure(Problem& problem, const LinearChoice& choice, const StepEnd& from, const StepEnd& to) {
  const Eigen::Index nv = problem.nv(), nc = problem.nc();
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(nv + nc), now(nc), nu(nc);
  // G v_n at the place set.
  const auto rates = [&](const StepEnd& at, std::span<double> out) {
    problem.set_position(at.t, span(at.q));
    problem.set_velocity(span(from.v));
    problem.velocity_residual(out);
    problem.nu(span(nu));
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += span(nu)[k];
  };
  rates(from, span(rhs, nv, nc));
  rates(to, span(now));
  problem.set_velocity(span(to.v));
  rhs.tail(nc) -= now;
  const Eigen::Index rows = static_cast<Eigen::Index>(problem.model_rows().size());  // of the scene, which come first
  const auto departed = [&](double share) {
    Eigen::Index row = 0;
    rhs.segment(nv, rows).cwiseAbs().maxCoeff(&row);
    return Departure{share, static_cast<int>(nv + row)};
  };
  Consistent consistent(problem, choice);
  if (!consistent.factor(to.t).ok() || !consistent.solve(to.t, span(rhs)).ok()) return departed(HUGE_VAL);
  const Most delta = most(problem, rhs),
             size = larger(longest_arm(problem.model()), most(problem, from.v), most(problem, to.v));
  const auto share = [&](double Most::*of) { return size.*of > 0 ? delta.*of / size.*of : 0; };
  return departed(std::max(share(&Most::way), share(&Most::turn)));
}

}  // namespace poinsot
