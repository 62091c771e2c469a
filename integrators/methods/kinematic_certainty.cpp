#include "integrators/methods/kinematic_certainty.h"

#include <algorithm>

#include "core/body_sizes.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// A step is certain up to this ratio of the first two corrections and up to this turn of a body or a driven angle, rad.
constexpr double kContraction = 0.25, kFullTurn = 1;
constexpr double kCorner = 0.02;    // of velocities that bend too much to be certain of where they lead
constexpr double kFarBeside = 100;  // times the way that leads to a singular position, in shares of a row
constexpr double kNothing = 1e-12;  // of positions: velocities that change so little in a step are rounding

}  // namespace

KinematicCertainty::KinematicCertainty(Problem& problem, PrescribedState& solver)
    : problem_(problem),
      solver_(solver),
      rows_change_(has_alternates(problem.model())),
      sizes_(body_sizes(problem.model())) {}

void KinematicCertainty::begin() {
  take_orientation();
  rate_from_ = problem_.counted_turn().rate, turn_from_ = problem_.fastest_turn();
}

bool KinematicCertainty::holds(const Beginning& from, const State& x, double h, double t, double part) {
  if (solver_.contraction() > kContraction) return false;
  const double rate = problem_.counted_turn().rate, turn = problem_.fastest_turn();
  if (h * std::max({rate, rate_from_, turn, turn_from_}) > kFullTurn) return false;
  if (comes_to_singular_position(from, x, h, t, part)) return false;
  const std::uint64_t here = solver_.orientation();
  if (here != orientation_ && !(rows_change_ && here == orientation_before(from, x, t))) return false;
  bent_ = bend(from, x, h, part);
  if (turns_corner(from, x, h, t)) return false;
  orientation_ = here;
  rate_from_ = rate, turn_from_ = turn;
  return true;
}

double KinematicCertainty::bend(const Beginning& from, const State& x, double h, double part) const {
  const double bent = (x.v - from.v - (0.5 * h) * (from.a + x.z.head(from.a.size()))).squaredNorm();
  const double relative = bent / x.v.squaredNorm();
  if (!(relative > kBent * kBent)) return 0;
  const double step = part > 0 ? h / part : h, nothing = kNothing * std::max(1.0, x.q.lpNorm<Eigen::Infinity>());
  return bent * step * step > nothing * nothing ? relative : 0;
}

// Beyond a singular position one of the branches has a determinant of the same sign as before, the one on which
// velocities have jumped. Drivers' kinks, at which they jump as well, are where the mechanism is regular: a row would
// have come to depend on the others, and be as far from it again, on a way that is short beside what is left of it.
bool KinematicCertainty::turns_corner(const Beginning& from, const State& x, double h, double t) {
  if (!(bent_ > kCorner * kCorner)) return false;
  const double beside = kFarBeside * way(from, x, h);
  return beside >= 1 || !(most_dependent_share(x, t) > beside);
}

// The longest of a body over h by the velocities at either end, in its sizes.
double KinematicCertainty::way(const Beginning& from, const State& x, double h) const {
  double fastest = std::max(problem_.fastest_turn(), turn_from_);
  const Eigen::Index per_body = x.v.size() / std::max<Eigen::Index>(problem_.bodies(), 1);
  for (std::size_t b = 0; b < sizes_.size(); ++b)
    for (const Vector* v : {&x.v, &from.v})
      fastest = std::max(fastest, v->segment<3>(static_cast<Eigen::Index>(b) * per_body).norm() / sizes_[b]);
  return h * fastest;
}

// At a singular position itself rates are rounding over rounding, and the determinant has no sign to compare: there
// accelerations are out of all proportion to velocities, and those jump.
bool KinematicCertainty::comes_to_singular_position(const Beginning& from, const State& x, double h, double t,
                                                    double part) {
  constexpr double kSudden = 100, kJump = 0.5;
  const auto a = x.z.head(from.a.size());
  if (part == 0 && !(h * h * a.squaredNorm() > kSudden * kSudden * x.v.squaredNorm())) return false;
  const double speed = x.v.norm() + from.v.norm();
  const bool jumps = part > 0 && (x.v - from.v).norm() > kJump * speed;
  if (!jumps && !(h * a.norm() > kSudden * speed)) return false;
  return most_dependent_share(x, t) < kSingularShare;
}

double KinematicCertainty::most_dependent_share(const State& x, double t) {
  const int rows = static_cast<int>(problem_.model_rows().size());
  const double share = most_dependent_row(problem_, rows, t, span(x.q)).share;
  problem_.set_velocity(span(x.v));
  return share;
}

// Where rows stand in for others at t: the orientation of the position before with the rows of now.
std::uint64_t KinematicCertainty::orientation_before(const Beginning& from, const State& x, double t) {
  problem_.set_position(t, span(from.q));
  const bool regular = solver_.refresh(t).ok();
  const std::uint64_t before = regular ? solver_.orientation() : 0;
  problem_.set_position(t, span(x.q));
  problem_.set_velocity(span(x.v));
  return before;
}

}  // namespace poinsot
