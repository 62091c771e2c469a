// Accelerations and multipliers of index 3 measured by those of index 1, and given way where rounding has spoilt them.
//
// A method that solves Φ/h² = 0 finds a and λ as second differences of positions: with rounding of the size ε|q|/s
// beside the error of its order, where s = δq/δa of a step is h² in the Euler schemes and about a quarter of it in
// generalized-α. At index 1, from M a + Gᵀλ = Q and G a = γ at the same (q, v, t), there is no such
// rounding. At an output time
//
//   ε|q|/s of no account beside a         what the step has computed is given out; nothing is computed for it
//   |a₃ − a₁| explained by ε|q|/s         a₁ and λ₁ are given out
//   |a₃ − a₁| larger                      the order of the method is in it: what the step has computed is given out
//
// A step that began with a velocity that is none of its scheme's may have an a₃ of another kind: where that is farther
// from a₁ than a₁, three times over, from the a where the step began, a₁ and λ₁ are given out, too. How far they are
// apart is what is known of their error.
//
// At the last output time both are found in any case: what they differ by is about the error of a₃ and λ₃. That of a₁
// and λ₁ is what rounding leaves in q, ε|q|, and in v, which of index 3 is a difference of positions and off the
// constraints by its rounding: by how much a₁ and λ₁ change where q moves by so much and v onto G v = ν.
#pragma once

#include <optional>
#include <vector>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/observe.h"

namespace poinsot {

class Index1Output {
 public:
  explicit Index1Output(const Settings& settings) : choice_(settings.linear()) {}

  // The state to be given out for `at`, where the problem stands before and after; s is `scale`. `began`: of a step of
  // that kind (a, λ) where it began, else null.
  const State& choose(Problem& problem, const State& at, double scale, bool last, const Eigen::VectorXd* began,
                      Statistics& statistics);

 private:
  bool solve(Problem& problem, const State& at);
  bool is_of_another_kind(Problem& problem, const State& at, const Eigen::VectorXd& began);
  // What rounding of the state found makes of its accelerations and multipliers.
  void add_rounding_of_state(Problem& problem, double rounding, AccelerationError& error);

  LinearChoice choice_;
  Problem* of_ = nullptr;
  std::optional<Consistent> consistent_;
  std::optional<State> found_;
  Eigen::VectorXd as_it_is_;  // of a step of another kind, (a, λ) of its own velocity
  std::vector<BodyState> one_, other_;
};

}  // namespace poinsot
