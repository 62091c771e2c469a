// Jumps of laws of springs by the state: on which side of each one a motion is, and how a step comes over one at which
// an implicit equation has no solution, the force of either side leading to the other. So it is, too, where the force
// of a spring turns round that passes through no length: that is looked for where a step has failed alone.
#pragma once

#include <cstddef>
#include <vector>

#include "formulations/problem.h"
#include "integrators/state.h"
#include "integrators/stepping/law_path.h"
#include "linsolve/linear_system.h"

namespace poinsot {

class LawJumps {
 public:
  struct Sides {
    std::vector<double> of;             // by their signs
    std::vector<Arguments<double>> at;  // of each law
  };

  explicit LawJumps(const Model& model);  // which has to live as long

  bool none() const { return laws_.empty(); }
  bool steps_may_fail() const { return !none() || !springs_.empty(); }  // because of them
  Sides sides() const { return {std::vector<double>(size_), std::vector<Arguments<double>>(laws_.size())}; }
  // Those of a state, where the problem stands.
  void look(const Problem& problem, const State& at, Sides& sides);
  // A law that jumps between the two; none: null. One that passes continuously through a switch, as
  // sign(v)*min(1, abs(v)) does, is none.
  const SpringLaw* crossed(const Sides& before, const Sides& after);
  // How the springs stretch where the problem stands, and whether one has done nothing but turn round between the two.
  std::vector<Vector3> stretches(const Problem& problem, const State& at) const;
  bool turned_round(const std::vector<Vector3>& before, const std::vector<Vector3>& after, double t) const;

 private:
  bool jumps_between(const Expression& F, int k, Arguments<double> from, Arguments<double> to);

  std::vector<SpringLaw> laws_;     // that jump
  std::vector<SpringLaw> springs_;  // whose force turns round
  std::vector<BodyState> bodies_;
  std::vector<double> switches_;  // of a law
  std::size_t size_ = 0;
};

// Whether accelerations as they are at `from` lead over a jump, or a spring through no length, before t or as far
// again, to which the motion does not stick and on which it does not rest (sticking.h).
bool comes_to_jump(LawJumps& jumps, const Problem& problem, const LinearChoice& choice, const State& from, double t);
// x becomes the state at t, near to it, to which its accelerations lead, consistent there.
Status lead_on(const Problem& problem, const LinearChoice& choice, State& x, double t);

}  // namespace poinsot
