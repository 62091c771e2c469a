// Whether steps of fixed length have gone over the gap between two branches of a mechanism that come close to one
// another (narrow_gap.h).
//
// Constraints hold on the other branch as well, and velocities go straight on to it, so no step shows it. But the
// constraints are steep there (Consistent::steepness). How steep is looked at, at the price of a factorization,
// whenever bodies have turned, or moved in arms of the mechanism, by half a radian, or a twentieth of the run is over,
// and more often where it is steeper than elsewhere: about as many times less far a singular position may be. Once it
// has been several times its least, and is not any more, what lies between is done again under error control, which
// does not go over gaps: where velocities come to be altogether others, at two looks, the steps have left the branch.
// The same is done where the constraints' gradients are reversed from one look to the next (branch_side.h), however
// steep it was: then, or beside what is as good as a singular position, one body with other velocities is enough, as of
// several degrees of freedom a gap may touch few. Where gradients are reversed and error control finds no way, it is
// told that the branch is not certain; after three stretches without a way no more are looked at.
//
// Mechanisms without loops, of hinges and driven angles alone, have no such positions; those of more than a thousand
// bodies are not looked at, nor are runs that begin in a singular position.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "integrators/integrator.h"
#include "integrators/stepping/branch_side.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/parts.h"

namespace poinsot {

class GapWatch {
 public:
  GapWatch(const Problem& problem, const Settings& settings, Tell tell);

  // Before the run, which begins at `at`: later looks allocate nothing.
  void begin(const Problem& problem, const State& at);
  // Whether the end of a step is to be looked at in which a body has turned by `turned`, rad.
  bool due(double turned, const Eigen::VectorXd& v, double h);
  // That end, `at`. Fails where the branch was left.
  Status look(const Problem& problem, const State& at);
  // Rows or coordinates are others from here on.
  void rewritten() {
    if (side_) side_->forget();
  }
  // The run ends there.
  Status end(const Problem& problem, const State& at);

 private:
  void prepare(const Problem& problem);
  double steepness(const Problem& problem, const State& at);
  // By how much of their size velocities are others than those of error control, in the mechanism where they are most.
  struct Apart {
    double of_all = 0;     // by kinetic energy
    double of_a_body = 0;  // by that which moves or turns differently most
  };
  std::optional<Apart> judge(const Problem& problem, const State& at);
  bool are_others(const Apart& velocities) const;
  void tell_unjudged(const Problem& problem, const State& at);
  std::string place(const Problem& problem);
  Status gone_over(const Problem& problem, const State& at, const Apart& apart);

  const Settings& settings_;
  const Tell tell_;
  const Parts parts_;
  bool looks_;
  double length_;                 // m, the longest arm
  std::unique_ptr<Problem> own_;  // with the rows of the run's
  std::optional<Consistent> consistent_;
  std::optional<BranchSide> side_;
  int revision_ = 0;
  const double of_run_;  // part of the way to the next look, of a step at least
  double way_ = 0;       // since the last look, of 1
  double due_ = 0;       // when the next is
  double least_;         // steepness
  bool steep_ = false, known_ = false;
  bool crossed_ = false;    // to another branch, since, as gradients say
  bool suspected_ = false;  // it seems so, at one look
  int unjudged_ = 0;        // stretches that error control could not do
  double t_ = 0;            // where it was not steep at last
  Eigen::VectorXd q_, v_;
  double steepest_ = 0, t_steepest_ = 0;  // since
  Eigen::VectorXd q_steepest_;
};

}  // namespace poinsot
