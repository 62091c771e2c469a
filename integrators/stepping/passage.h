// Consistent states next to a singular position, where the constraints themselves leave them to rounding.
//
// At the distance s in time, rounding ε moves a position by ε/s, its velocity by ε/s² and its acceleration by ε/s³. But
// on the branch that the velocities lead along all three are smooth through the position. So they are interpolated
// from those on either side: with c(s) what puts q ⊞ s v back onto Φ = 0, v(s) and a(s) velocity and acceleration
// there,
//
//   x(0) = (56 x̄(τ) − 28 x̄(2τ) + 8 x̄(3τ) − x̄(4τ))/35 + O(τ⁸),   x̄(s) = ½ (x(s) + x(−s))
//
// Time goes on with s where constraints depend on it. No stage, end of a step or sample has to keep away from the
// position, and steps go over it at their usual length.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "integrators/stepping/consistent.h"

namespace poinsot {

class Passage {
 public:
  Passage(Problem& problem, Consistent& consistent);
  ~Passage();

  // Whether `at`, off the constraints by the error of a step, lies nearer to a singular position than those beside:
  // then it is made the limit of theirs: λ, too, or, where it has none and the position leaves it open, that of the
  // state at τ. The problem stands at `at`, before and after. The factorization at hand is that of `at` before, where
  // it has one (`factored`: else it is as singular as can be); after, where it was settled, that of a state beside.
  Status settle(State& at, bool factored, bool& settled);
  // Makes q, v and a of `at` the limit of those at ±τ, ... ±4τ along a velocity of the branch, which are as they are no
  // nearer to a singular position than rows off by one move positions by `steepest`. Says whether there is one: fails
  // nowhere.
  bool limit(State& at, const Eigen::VectorXd& along, double tau, double steepest);
  // Of the same states: makes λ of `at` the limit of theirs. Says whether there is one: λ is left where they grow
  // without bound.
  bool limit_multipliers(State& at);
  // The same as settle() for the end of a step that began with v_n: what the constraints leave to rounding there is in
  // `at`. Fails nowhere. The problem stands at `at`, before and after.
  bool settle_end(State& at, const Eigen::VectorXd& v_n);
  // The consistent state beside (q, v), λ included: Consistent's, or the limit.
  Status complete(State& at);
  // Where other rows are kept than before: what steps have left of these, which no shorter step would make smaller,
  // goes where it can; else the state stays as it is. The problem stands at `at`, before and after.
  void stand_on_rows(State& at);
  // The same of a sample, which is refused where it is made of rounding, as singular_position.
  Status complete_sample(State& at);
  // Of a state in which a step has ended, and that is to be given out: next to a singular position the same. `spare` is
  // written over.
  Status give(State& at, State& spare);
  // Whether the last one was made a limit.
  bool settled() const { return settled_; }
  // How far the last one was moved, δq and then δv; by Consistent, where it was not settled.
  std::span<const double> moved_by() const;

 private:
  struct Beside;
  Status stand_beside(const State& at, const Eigen::VectorXd& along, double s, Beside& beside);
  // Whether that is much steeper than somewhere before, or nothing is known yet.
  bool is_steep(double here);
  double least_seen() const { return std::min(least_, consistent_.least_steepness()); }
  void give_multipliers(State& at);
  Status multipliers(State& at);

  Problem& problem_;
  Consistent& consistent_;
  const Parts parts_;
  State given_;
  const bool driven_;        // rows depend on time
  double least_ = HUGE_VAL;  // steepness
  bool settled_ = false;
  struct Work;
  std::unique_ptr<Work> work_;  // once it is needed
};

}  // namespace poinsot
