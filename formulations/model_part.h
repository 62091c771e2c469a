// One constraint, joint, driver or force of a model alone, with the bodies it acts on, and the size of what it
// computes.
#pragma once

#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

// A model of its own, of the bodies it acts on without mass and inertia, and their states.
struct Part {
  Model model;
  std::vector<BodyState> states;
};

Part part_of(const Model& model, std::span<const BodyState> states, const Group& group);
Part part_of(std::span<const BodyState> states, Spring spring);
Part part_of(std::span<const BodyState> states, TorsionElement torsion);
Part part_of(std::span<const BodyState> states, PointForce force);
Part part_of(std::span<const BodyState> states, Torque torque);
Part part_of(std::span<const BodyState> states, LinearDrag drag);
Part part_of(std::span<const BodyState> states, CallbackForce force);

// Size at t = 0 of the terms that Φ = u·v − f and its first and second time derivatives are sums of, without regard to
// what cancels. Of a pfaffian row, which has no Φ: of its gradient, of Ψv and of d(Ψv)/dt.
struct TermSize {
  double value = 0, rate = 0, second = 0;
};
TermSize term_size(const Part& part, const Row& row);

}  // namespace poinsot
