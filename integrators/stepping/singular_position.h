// Whether a run that stopped did so beside a singular position of its mechanism, and which constraint row says so.
//
// The part of a row that is independent of the others (unit_rows.h) goes to 0 with the distance from a position where
// the row depends on them. How small it is elsewhere is a matter of the mechanism (of its lengths, of the number of its
// loops): it is compared with what it was at the start.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "formulations/problem.h"
#include "integrators/state.h"

namespace poinsot {

// The row of the first `rows` of G that is the least independent of the others at (t, q), and the part of its length
// that is; row −1 where thousands of rows hold one body. The problem stands there afterwards, at rest.
struct DependentRow {
  int row = -1;
  double share = 1;
  // Drivers ask there for velocities that the rows do not have: of μᵀG = 0 besides, which is what makes the row
  // dependent, μᵀν is not 0. Velocities grow without bound towards such a position, and none lies beyond.
  bool barred = false;
};
DependentRow most_dependent_row(Problem& problem, int rows, double t, std::span<const double> q);
// Of all of these rows that part; none where thousands of rows hold one body.
Eigen::VectorXd independent_shares(Problem& problem, int rows, double t, std::span<const double> q);

// A sentence; empty where every row is as independent as at the start, or nearly, and where thousands of rows hold one
// body. `rows`: rows of G that are constraints of the scene (before normalizations). The problem stands at (t, q)
// afterwards, at rest.
struct NearSingular {
  std::string sentence;
  bool barred = false;  // see DependentRow: no method passes
  bool driven = false;  // which may bar it all the same: the nearer, the surer one is
};
NearSingular near_singular_position(Problem& problem, int rows, std::span<const double> q_start, double t,
                                    std::span<const double> q);
// What to do where a position is barred.
inline constexpr const char* kBarred =
    "drivers ask there for more than the mechanism reaches: its velocities grow without bound, and no method passes; "
    "end before it, or change the drivers";

// From farther off, where a motion that passes beside it looks the same.
inline constexpr const char* kSeemsBarred =
    "drivers seem to ask there for more than the mechanism reaches: if so its velocities grow without bound, and no "
    "method passes; end before it, or change the drivers; much smaller steps show whether it passes beside";

// Likewise where it may be.
inline constexpr const char* kMayBeBarred =
    "where a driver asks for more than the mechanism reaches nothing does: end before it";

// Of steps that get shorter towards the time `limit`, so that they never come there; at `at`, where the problem stands.
Status never_beyond(const Problem& problem, const State& at, double limit);

// A sentence about steps that became too small where no row says why: who moves, what it may be, what may help.
std::string growing_motion(const Problem& problem, const State& state);

// A sentence about a row whose gradient has vanished by itself where a run stopped: a distance (D) that has come to
// zero, relative to the longest of its arms in bodies and its length at the start, or two directions at a prescribed
// cosine (DP1) that have come to lie in a line; else empty. The problem stands there afterwards.
std::string vanished_gradient(Problem& problem, const State& state);

}  // namespace poinsot
