#include "integrators/stepping/narrow_gap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/vectors.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

constexpr double kGapNear = 4;     // times as steep as usual: from there on w is looked at
constexpr double kReversed = 0.1;  // of the product of sizes, at least, below 0
constexpr int kBisections = 40;
constexpr double kOffMiddle = 0.47;        // not half: in the middle of a limit there may be no matrix to be factored
constexpr double kBeside = 0.03;           // rad, of a limit: where the states are that it is made of
constexpr double kRoundingOfGaps = 1e-14;  // of Φ, relative to the largest coordinate

}  // namespace

NarrowGap::NarrowGap(Problem& problem, Consistent& consistent)
    : problem_(problem),
      consistent_(consistent),
      parts_(problem),
      rows_change_(has_alternates(problem.model())),
      has_velocity_rows_(!velocity_rows(problem).empty()) {}

// δ of w, and the next w, which comes nearer to the one that leads out the farthest; both by mechanism.
bool NarrowGap::find_way(double t, Vector& w, Vector& way) {
  const Eigen::Index nv = problem_.nv(), nc = problem_.nc();
  rhs_.setZero(nv + nc);
  rhs_.tail(nc) = w;
  if (!consistent_.solve(t, span(rhs_)).ok()) return false;
  way = rhs_.head(nv);
  w = -rhs_.tail(nc);
  sizes_.setZero(static_cast<Eigen::Index>(parts_.count()));
  const auto part_of = [&](Eigen::Index k) {
    return static_cast<Eigen::Index>(parts_.of_row(problem_, static_cast<std::size_t>(k)));
  };
  for (Eigen::Index k = 0; k < nc; ++k) sizes_[part_of(k)] += w[k] * w[k];
  for (Eigen::Index k = 0; k < nc; ++k)
    if (const double size = sizes_[part_of(k)]; size > 0) w[k] /= std::sqrt(size);
  return w.allFinite() && way.allFinite();
}

// Of a w that no step before has found.
bool NarrowGap::find_first_way(double t, Vector& w, Vector& way) {
  constexpr int kIterations = 4;
  const std::span<const double> signs = consistent_.signs();
  w = Eigen::Map<const Vector>(signs.data(), problem_.nc()).normalized();
  for (int k = 0; k < kIterations; ++k)
    if (!find_way(t, w, way)) return false;
  return true;
}

void NarrowGap::follow(const State& at, bool settled) {
  const bool goes_on = std::exchange(forgotten_, consistent_.forgotten()) == consistent_.forgotten();
  from_limit_ = settled;
  orientation_ = rows_change_ || settled ? 0 : consistent_.orientation();
  const bool near = !settled && problem_.nc() > 0 && consistent_.steeper() > kGapNear;
  if (near && known_ && goes_on)
    w_.swap(w_next_), way_.swap(way_next_);
  else
    known_ = near && orientation_ == 0 && find_first_way(at.t, w_, way_);
}

bool NarrowGap::goes_over(const State& from, const State& to, bool settled) {
  bool looks = settled;
  const bool goes_on = forgotten_ == consistent_.forgotten();
  const std::uint64_t here = rows_change_ ? 0 : consistent_.orientation();
  by_orientation_ = here != 0;
  if (!settled && by_orientation_) {
    if (!goes_on || (orientation_ == 0 && !from_limit_)) find_orientation(from, to);
    looks = orientation_ != 0 && orientation_ != here;
  } else if (!settled && goes_on && known_) {
    w_next_ = w_;
    known_ = find_way(to.t, w_next_, way_next_);
    for (std::size_t part = 0; known_ && part < parts_.count() && !looks; ++part)
      if (looks = reversed(part, way_, way_next_); looks) part_ = part;
  }
  if (!looks) return false;
  const double beside = settled ? kBeside / problem_.fastest_turn() : 0;
  const bool gap = settled ? is_gap({to, nullptr, beside}) : is_gap({from, &to, 0});
  consistent_.stand(to);
  if (consistent_.factor(to.t).ok()) return gap;
  known_ = false;
  return gap || !factor_beside(to, beside);
}

// Where `at`, a limit, has no matrix to be factored.
bool NarrowGap::factor_beside(const State& at, double beside) {
  q_.resize(at.q.size());
  const double t = move_along({at, nullptr, beside}, 1);
  problem_.retract(span(at.q), span(dq_), span(q_));
  problem_.set_position(t, span(q_));
  const bool factored = consistent_.factor(t).ok();
  consistent_.stand(at);
  return factored;
}

// Of the first step, that begins at `from`.
void NarrowGap::find_orientation(const State& from, const State& to) {
  forgotten_ = consistent_.forgotten();
  consistent_.stand(from);
  orientation_ = consistent_.factor(from.t).ok() ? consistent_.orientation() : 0;
  consistent_.stand(to);
  if (!consistent_.factor(to.t).ok()) orientation_ = 0;
}

double NarrowGap::product(std::size_t part, const Vector& x, const Vector& y) {
  momentum_.resize(y.size());
  problem_.momentum(span(y), span(momentum_));
  return parts_.dot(part, x, momentum_);
}

bool NarrowGap::reversed(std::size_t part, const Vector& x, const Vector& y) {
  const double along = product(part, x, y);
  return along < 0 && along * along > kReversed * kReversed * product(part, x, x) * product(part, y, y);
}

// A path at s, 0 to 1: from one end of a step to the other, by velocities and accelerations at both, or by those of a
// limit from one side of it to the other. Its time; dq_ from path.from.
double NarrowGap::move_along(const Path& path, double s) {
  const State& from = path.from;
  const auto a = from.z.head(problem_.nv());
  if (!path.to) {
    const double x = (2 * s - 1) * path.beside;
    dq_ = x * (from.v + 0.5 * x * a);
    return from.t + x;
  }
  const State& to = *path.to;
  const double h = to.t - from.t, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
  dq_ = h * ((s4 / 2 - s3 + s) * from.v + (s3 - s4 / 2) * to.v) +
        h * h * ((s4 / 4 - 2 * s3 / 3 + s2 / 2) * a + (s4 / 4 - s3 / 3) * to.z.head(problem_.nv()));
  return from.t + s * h;
}

// On the path, with what w leaves of the constraints satisfied; w and δ there. From the first such place on w is that
// of the one before.
bool NarrowGap::stand_between(const Path& path, double s, bool first) {
  constexpr int kCorrections = 3, kIterations = 2;
  const Eigen::Index nv = problem_.nv(), nc = problem_.nc();
  const double t = move_along(path, s);
  q_.resize(path.from.q.size()), q_moved_.resize(path.from.q.size()), rows_.resize(nc);
  problem_.retract(span(path.from.q), span(dq_), span(q_));
  for (int k = 0; k <= kCorrections; ++k) {
    problem_.set_position(t, span(q_));
    if (!consistent_.factor(t).ok()) return false;
    if (k == 0 && (first || by_orientation_) && !find_first_way(t, w_here_, way_here_)) return false;
    for (int i = 0; i < kIterations; ++i)
      if (!find_way(t, w_here_, way_here_)) return false;
    if (k == 0 && by_orientation_) {
      for (std::size_t part = part_ = 0; part < parts_.count(); ++part)
        if (slope(part, way_here_) < slope(part_, way_here_)) part_ = part;
    }
    if (k == 0) moved_ = std::sqrt(product(part_, dq_, dq_));
    problem_.position_residual(span(rows_));
    e_ = 0;
    for (Eigen::Index i = 0; i < nc; ++i)
      if (parts_.of_row(problem_, static_cast<std::size_t>(i)) == part_) e_ += w_here_[i] * rows_[i];
    if (has_velocity_rows_in_it(w_here_)) e_ = 0;
    if (k == kCorrections) break;
    rhs_.setZero(nv + nc);
    for (Eigen::Index i = 0; i < nc; ++i)
      if (parts_.of_row(problem_, static_cast<std::size_t>(i)) == part_) rhs_[nv + i] = e_ * w_here_[i] - rows_[i];
    if (!consistent_.solve(t, span(rhs_)).ok()) return false;
    dq_ = rhs_.head(nv);
    problem_.retract(span(q_), span(dq_), span(q_moved_));
    q_.swap(q_moved_);
  }
  return true;
}

// Whether what w leaves of the constraints, wᵀG, would be far more without its velocity rows. These keep no branches of
// positions apart.
bool NarrowGap::has_velocity_rows_in_it(const Vector& w) {
  constexpr double kFarMore = 10;
  if (!has_velocity_rows_) return false;
  Vector of_velocities = Vector::Zero(w.size()), force(problem_.nv());
  for (const int k : velocity_rows(problem_)) of_velocities[k] = w[k];
  problem_.constraint_forces(span(std::as_const(of_velocities)), span(force));
  const double theirs = force.norm();
  problem_.constraint_forces(span(w), span(force));
  return theirs > kFarMore * force.norm();
}

double NarrowGap::slope(std::size_t part, const Vector& way) {
  return 1 / std::sqrt(product(part, way, way));
}

// At the distance ξ from where wᵀG vanishes wᵀΦ differs by H ξ²/2 and wᵀG is H ξ, 1/|δ|; H is about what brings it from
// 0 there to what it is at an end of the path. What cannot be told a shorter step will.
bool NarrowGap::is_gap(const Path& path) {
  const double rounding = kRoundingOfGaps * std::max(1.0, largest(span(path.from.q)));
  if (!path.to || by_orientation_) {
    if (!stand_between(path, 0, true)) return true;
    began_ = consistent_.orientation();
    way_began_ = way_here_;
  } else {
    w_here_ = w_, way_began_ = way_;
  }
  const auto beyond = [&] {
    return by_orientation_ ? consistent_.orientation() != began_ : product(part_, way_here_, way_began_) < 0;
  };
  if (!stand_between(path, 1, false)) return true;
  if (!beyond()) {  // it ends elsewhere than the step does, or that began in the position
    return path.to && (!by_orientation_ || began_ == orientation_);
  }
  const double length = moved_ * (path.to ? 1 : 2), steep = slope(part_, way_here_);
  double low = 0, high = 1;
  for (int k = 0; k < kBisections; ++k) {
    const double s = low + kOffMiddle * (high - low);
    if (!stand_between(path, s, false)) return true;
    const double here = slope(part_, way_here_), unknown = here * here * length / steep + rounding;
    if (std::abs(e_) > 4 * unknown) return true;
    if (unknown < 2 * rounding) return false;
    (beyond() ? high : low) = s;
  }
  return true;
}

}  // namespace poinsot
