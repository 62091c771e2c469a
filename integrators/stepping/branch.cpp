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

// Of a mechanism; `of`: number k of a velocity.
template <class Velocity>
Most most(const Parts& parts, std::size_t part, Velocity&& of) {
  double way = 0, turn = 0;
  parts.for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
    const auto square = [&](Eigen::Index k) { return of(k) * of(k); };
    for (Eigen::Index b = first; b < first + count; b += parts.per_body()) {
      way = std::max(way, square(b) + square(b + 1) + square(b + 2));
      double turns = square(b + 3) + square(b + 4) + square(b + 5);
      for (Eigen::Index k = 6; k < parts.per_body(); ++k) turns += square(b + k);
      turn = std::max(turn, turns);
    }
  });
  return {std::sqrt(way), std::sqrt(turn)};
}

Most most(const Parts& parts, std::size_t part, const Eigen::VectorXd& v) {
  return most(parts, part, [&](Eigen::Index k) { return v[k]; });
}

// The larger of two velocities, of which points and turns are no less than a part of the other: where centres of mass
// rest while bodies turn, or bodies all but do not turn while they move, these are rounding, or begin.
Most larger(double length, const Most& a, const Most& b) {
  constexpr double kPart = 1e-2;
  const double way = std::max(a.way, b.way), turn = std::max(a.turn, b.turn);
  return {std::max(way, kPart * turn * length), std::max(turn, kPart * way / length)};
}

}  // namespace

BranchWatch::BranchWatch(const Problem& problem)
    : constrained_(!problem.model_rows().empty()),
      parts_(problem),
      changes_(parts_.count()),
      length_(longest_arm(problem.model())) {}

void BranchWatch::begin(std::span<const double> a) {
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    const Most change = most(parts_, part, [&](Eigen::Index k) { return a[index(k)]; });
    changes_[part].usual_way = change.way, changes_[part].usual_turn = change.turn;
  }
}

double BranchWatch::jump(const Eigen::VectorXd& v_n, const Eigen::VectorXd& v, double h) {
  constexpr double kUnusual = 4, kMoved = 0.1;
  if (!constrained_) return 0;  // no branches
  double most_changed = 0, fastest = -1;
  for (std::size_t n = 0; n < parts_.count(); ++n) {
    const Most change = most(parts_, n, [&](Eigen::Index k) { return v[k] - v_n[k]; });
    Changes& of = changes_[n];
    of.way = change.way / h, of.turn = change.turn / h;
    if (!(of.way > kUnusual * of.usual_way || of.turn > kUnusual * of.usual_turn)) continue;
    if (fastest < 0) fastest = largest(span(v));
    if (parts_.rests(parts_.largest(n, span(v)), fastest)) continue;
    const Most before = most(parts_, n, v_n), after = most(parts_, n, v);
    const Most size = larger(length_, before, after);
    const auto part = [&](double Most::*which) {  // of no start from rest, which has no branch to leave
      return before.*which > kMoved * after.*which ? change.*which / size.*which : 0;
    };
    most_changed = std::max({most_changed, part(&Most::way), part(&Most::turn)});
  }
  return most_changed;
}

void BranchWatch::follow() {
  const double share = begun_ ? 0.1 : 1;
  begun_ = true;
  for (Changes& of : changes_) {
    of.usual_way += share * (of.way - of.usual_way);
    of.usual_turn += share * (of.turn - of.usual_turn);
  }
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
  const Parts parts(problem);
  const double length = longest_arm(problem.model());
  double largest = 0;
  for (std::size_t n = 0; n < parts.count(); ++n) {
    const Most delta = most(parts, n, rhs), size = larger(length, most(parts, n, from.v), most(parts, n, to.v));
    for (double Most::*of : {&Most::way, &Most::turn})
      if (size.*of > 0) largest = std::max(largest, delta.*of / size.*of);
  }
  return departed(largest);
}

}  // namespace poinsot
