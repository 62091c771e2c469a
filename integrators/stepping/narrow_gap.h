// Whether a step of error control went over the gap between two branches of a mechanism that come close to one another,
// as those of a crank-rocker do whose links are all but a parallelogram's.
//
// From afar such branches seem to cross, and a long step goes straight on, from one to the other: the constraints hold
// at both of its ends and velocities hardly change, while the motion turns round within a way as short as the gap. What
// tells is the sign of det G, where G is square and factored by itself; elsewhere the combination w of rows, |w| = 1,
// that leads out of the constraints the farthest,
//
//   δ = M⁻¹Gᵀ S⁻¹ w,  S = G M⁻¹ Gᵀ,  G δ = w
//
// which keeps its direction along a branch and has turned round beyond a crossing, and beyond a gap; it is looked at
// where a singular position is near. Where either has changed, the place of it is looked for between the ends, with all
// that w leaves of the constraints satisfied, and there
//
//   e = wᵀΦ
//
// is 0 where branches cross, else as much as keeps them apart; of velocity rows (pfaffian), which keep none apart, the
// slope |δ|⁻¹ alone is to come down to rounding. A step over a gap is to be done in shorter ones, which
// come to see it.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "integrators/state.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/parts.h"

namespace poinsot {

class NarrowGap {
 public:
  NarrowGap(Problem& problem, Consistent& consistent);

  // A step ends there that stands. The factorization at hand is that of `at`; `settled`: it is the limit of states
  // beside a singular position (passage.h), and of one of these.
  void follow(const State& at, bool settled);
  // The next step begins elsewhere.
  void forget() { forgotten_ = -1; }
  // Of a step that may stand. The problem stands at `to`, before and after; at hand is its factorization or, of a limit
  // without one, that of a state beside.
  bool goes_over(const State& from, const State& to, bool settled);

 private:
  using Vector = Eigen::VectorXd;

  bool find_first_way(double t, Vector& w, Vector& way);
  bool find_way(double t, Vector& w, Vector& way);
  // xᵀM y. By it δ of the next w is along that of the one before where nothing has moved; by xᵀy that of a light body,
  // which whips round, may seem to be reversed.
  double product(std::size_t part, const Vector& x, const Vector& y);
  double slope(std::size_t part, const Vector& way);
  // From a state to another one or, of a limit, for a time to either side of it.
  struct Path {
    const State& from;
    const State* to;
    double beside;
  };
  bool factor_beside(const State& at, double beside);
  void find_orientation(const State& from, const State& to);
  bool reversed(std::size_t part, const Vector& x, const Vector& y);
  double move_along(const Path& path, double s);
  bool stand_between(const Path& path, double s, bool first);
  bool is_gap(const Path& path);
  bool has_velocity_rows_in_it(const Vector& w);

  Problem& problem_;
  Consistent& consistent_;
  const Parts parts_;
  const bool rows_change_;
  const bool has_velocity_rows_;
  int forgotten_ = -1;             // what Consistent had when all of this was found
  std::uint64_t orientation_ = 0;  // at the end of the last step; 0: not known
  std::uint64_t began_ = 0;        // where a path begins
  bool from_limit_ = false;        // a limit is there
  bool known_ = false;             // w and δ there
  bool by_orientation_ = false;    // what the step under way is judged by
  std::size_t part_ = 0;           // whose w it is
  Vector w_, way_, w_next_, way_next_;
  // On a path: w, δ, e and how far from where that begins, or is a limit.
  Vector w_here_, way_here_, way_began_, q_, q_moved_, dq_, rhs_, rows_, sizes_, momentum_;
  double e_ = 0, moved_ = 0;
};

}  // namespace poinsot
