// What is asked of a motion beside positions and reactions: energies and momenta, the coordinates that joints leave
// free, what drivers do, what springs and lines carry.
//
//   settings.signals = true;                      // angles are followed through the run, so that turns are counted
//   std::optional<Signals> signals;               // outside the observer
//   if (!signals) signals.emplace(sample.problem);
//   signals->update(sample);
//   signals->values();                            // by Signals::names(model)
//
// With T the kinetic and V the potential energy (gravity, springs), J; momentum p = Σ m ṙ and, about the origin,
// L = Σ r × m ṙ + A J ω̄:
//
//   kinetic, potential, energy = T + V, px py pz, Lx Ly Lz
//   joint            free coordinates, then their rates: of body j relative to body i, about or along the joint's axis
//     revolute       angle                rad, turns counted
//     cylindrical    angle, slide         rad, m
//     translational  slide                m
//     universal      angle_i, angle_j     of the cross about axis_i, of body j about axis_j
//     spherical      rx ry rz, wx wy wz   rotation vector of A_iᵀA_j, at most π long, and the angular velocity of j
//                                         relative to i, both in body i's frame
//   driver           value f(t), effort (N or N m along the driven coordinate: what it exerts to increase it), power
//   D, distance      tension              N, what pulls the two points together, 2 λ |d|
//   spring           length, rate, force  m, m/s, N: what pulls the two points together
//   torsion spring   angle, rate, torque  rad, turns counted; N m: what turns body j back
//
// The power of a driver is −λ ν (λ its multiplier, ν = −∂Φ/∂t), its effort −λ ν/ḟ. Angles are zero at the pose the
// scene gives, or where a_i and a_j coincide.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "integrators/start/reactions.h"

namespace poinsot {

class Signals {
 public:
  // The columns, "hinge.angle". What a force shares its name with goes first: "hinge (torsion_spring).angle".
  static std::vector<std::string> names(const Model& model);

  // The problem stands at a sample of a run with Settings::signals.
  explicit Signals(const Problem& problem);

  void update(const Sample& sample);
  std::span<const double> values() const { return values_; }

 private:
  void add(double value) { values_.push_back(value); }
  void add(const Vector3& x) { values_.insert(values_.end(), x.data(), x.data() + 3); }
  void add_totals();
  void add_joints();
  void add_joint(const Group& group, const JointFrames& f, std::size_t& followed);
  void add_rows();
  void add_springs();

  const Sample* sample_ = nullptr;
  std::optional<Reactions> reactions_;  // where something needs multipliers
  std::vector<BodyState> bodies_;
  std::vector<double> values_;
};

// The angles of a model's joints, to be followed.
std::vector<FollowedAngle> joint_angles(const Model& model);

}  // namespace poinsot
