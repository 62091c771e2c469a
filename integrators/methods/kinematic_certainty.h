// Whether a step of kinematics, or a part of one, ends where the motion leads, and not on another branch: another way
// to put the mechanism together. By Newton's corrections, by how far bodies turn, by the sign of det G, which differs
// between branches that meet somewhere, and by velocities, which jump from one to another where they meet
// (integrators/README.md, "Branches").
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "integrators/integrator.h"
#include "integrators/methods/prescribed_state.h"
#include "integrators/state.h"

namespace poinsot {

// A row is independent of the others by no more than this share of its length in a singular position: beside one
// positions are known to rounding's root.
inline constexpr double kSingularShare = 1e-6;
// Where so small a part of a step is not certain the position is examined.
inline constexpr double kSuspicious = 0x1p-10;

class KinematicCertainty {
 public:
  using Vector = Eigen::VectorXd;

  // Where a step, or a part of it, begins.
  struct Beginning {
    Vector q, v, a;

    void take(const State& x) { q = x.q, v = x.v, a = x.z.head(v.size()); }
  };

  // `solver` stands, whenever anything is asked, at what it found last.
  KinematicCertainty(Problem& problem, PrescribedState& solver);

  // Where a run begins, and where coordinates or rows are others: this is what ends are compared with.
  void begin();
  void take_orientation() { orientation_ = solver_.orientation(); }
  bool has_turned_over() { return solver_.orientation() != orientation_; }

  // Whether x, at t, is where the motion leads over h; if so it is what the next end is compared with. `part`: what h
  // is of a step that is done in parts; 0 where it is done as one.
  bool holds(const Beginning& from, const State& x, double h, double t, double part);
  // Whether velocities bend sharply over what was certain last, as beside a singular position: there those of positions
  // beside x, too, are others.
  bool bends() const { return bent_ > 0; }

 private:
  static constexpr double kBent = 1e-4;

  double bend(const Beginning& from, const State& x, double h, double part) const;
  double way(const Beginning& from, const State& x, double h) const;
  bool comes_to_singular_position(const Beginning& from, const State& x, double h, double t, double part);
  bool turns_corner(const Beginning& from, const State& x, double h, double t);
  double most_dependent_share(const State& x, double t);
  std::uint64_t orientation_before(const Beginning& from, const State& x, double t);

  Problem& problem_;
  PrescribedState& solver_;
  const bool rows_change_;
  const std::vector<double> sizes_;  // of bodies, m
  std::uint64_t orientation_ = 0;
  double rate_from_ = 0, turn_from_ = 0;  // rad/s, of counted turns and of bodies, where it begins
  // By what part of themselves velocities changed beside what the accelerations at both ends tell, squared; 0 up to
  // kBent.
  double bent_ = 0;
};

}  // namespace poinsot
