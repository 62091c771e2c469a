// What Consistent knows of singular positions near: how steep the constraints are, how large accelerations.
#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

double Consistent::steepness(double t) {
  std::ranges::copy(off_by_one_, rhs_.begin());
  const bool solved = system_.solve(t, span(rhs_)).ok();
  double steepest = solved ? 0 : HUGE_VAL;
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    branches_[part].steepness = solved ? parts_.largest(part, moves()) : HUGE_VAL;
    steepest = std::max(steepest, branches_[part].steepness);
  }
  return steepest;
}

double Consistent::steepness(double t, std::size_t part) {
  (void)steepness(t);
  return branches_[part].steepness;
}

void Consistent::look(double steepness) {
  steepness_ = steepness;
  amplification_ = 1;
  steeper_ = 0;
  for (Branch& of : branches_) {
    const double now = of.usual_steepness > 0 ? of.steepness / of.usual_steepness : 0;
    of.amplification = now > kSteep ? now : 1;
    steeper_ = std::max(steeper_, now);
    amplification_ = std::max(amplification_, of.amplification);
  }
  beside_singular_ = beside_singular_ || amplification_ > 1;
}

double Consistent::error_in(const State& at, std::span<const double> moved_by, double shift, bool settled) const {
  constexpr double kRounding = 2e-15, kMore = 8, kLucky = 0.1;
  const double q = largest(moved_by.first(nv_)), v = largest(moved_by.subspan(nv_));
  const double most = steepness_ * (settled ? kMore : 1) * kRounding * std::max(1.0, largest(span(at.q)));
  const bool rounding = q <= most && v <= kMore * steepness_ * problem_.fastest_turn() * std::max(q, kLucky * most);
  return rounding ? 0 : shift / amplification_;
}

bool Consistent::made_of_rounding(const State& at) {
  for (std::size_t part = 0; part < parts_.count(); ++part)
    if (made_of_rounding(at, part)) return true;
  return false;
}

bool Consistent::made_of_rounding(const State& at, std::size_t part) {
  constexpr double kUnusual = 1e4, kAccounted = 1e3;
  constexpr double kOpen = 1e6;  // times as steep as usual: nearer than where rounding, ε/σ³, is as large as that
  const double acceleration = parts_.largest(part, at.a()), usual = branches_[part].calm.usual;
  if (usual == 0 || !(acceleration > kUnusual * usual)) return false;
  if (parts_.rests(acceleration, largest(at.a()))) return false;
  const std::span<const double> none = span(zeros_);
  problem_.equations_of_motion(none.first(nv_), {}, moves());  // −Q
  problem_.gamma(rows());
  const double loads = parts_.largest(part, moves()), gamma = parts_.largest_row(part, problem_, rows());
  problem_.momentum(at.a(), moves());
  if (!(acceleration > kAccounted * gamma && parts_.largest(part, moves()) > kAccounted * loads)) return false;
  return steepness(at.t, part) > kOpen * branches_[part].usual_steepness;
}

bool turned_round(const Parts& parts, std::size_t part, const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  constexpr double kReverse = 0.1;
  return parts.dot(part, now, before) <
         -kReverse * std::max(parts.dot(part, now, now), parts.dot(part, before, before));
}

namespace {

bool hardly_turned(const Parts& parts, std::size_t part, const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  constexpr double kHardly = 0.8;
  return parts.dot(part, now, before) > kHardly * std::max(parts.dot(part, now, now), parts.dot(part, before, before));
}

}  // namespace

// A mechanism that comes to rest in a singular position goes on by any of its branches as far as the velocities say.
// Beyond it accelerations of another one differ altogether from those before, in the direction that the constraints
// leave free there, though bodies have turned by little and did not lead to expect it; not those that turn on from step
// to step, as of a ball that is drawn in on a thread.
bool Consistent::turns_back(const State& at, std::size_t part) {
  constexpr double kTrusted = 1e4;  // times as steep as usual, beyond which rounding makes accelerations
  constexpr double kLittle = 0.1;   // rad
  constexpr double kExpected = 0.25;
  const Branch& of = branches_[part];
  if (!(of.amplification > 1 && of.amplification < kTrusted) || of.approach.rate < 0 || of.approach.turned > kLittle)
    return false;
  const Eigen::VectorXd now = at.z.head(at.v.size());
  if (!turned_round(parts_, part, approach_a_, now)) return false;
  if (of.approach.steady && hardly_turned(parts_, part, last_a_, now)) return false;
  const Eigen::VectorXd change = now - approach_a_;
  if (!(of.approach.rate * (at.t - of.approach.t) < kExpected * parts_.largest(part, span(change)))) return false;
  return lies_free(at.t, change, part);
}

bool Consistent::lies_free(double t, const Eigen::VectorXd& x, std::size_t part) {
  constexpr double kAlong = 0.9;
  if (steepness(t) == HUGE_VAL) return false;
  Eigen::VectorXd free = Eigen::VectorXd::Zero(x.size()), with = free;
  parts_.for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
    free.segment(first, count) = rhs_.segment(first, count);
    with.segment(first, count) = x.segment(first, count);
  });
  const auto product = [&](const Eigen::VectorXd& one, const Eigen::VectorXd& of) {
    problem_.momentum(span(of), moves());
    return rhs_.head(x.size()).dot(one);
  };
  const double along = product(with, free);
  return along * along > kAlong * product(free, free) * product(with, with);
}

bool Consistent::leaves_branch(const State& at) {
  for (std::size_t part = 0; part < parts_.count(); ++part)
    if (turns_back(at, part) || (made_of_rounding(at, part) && jumps(at, part))) return true;
  return false;
}

bool Consistent::jumps(const State& at, std::size_t part) const {
  constexpr double kJumped = 0.01, kExplained = 10;
  double jump = 0, size = 0;
  parts_.for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index k = first; k < first + count; ++k) {
      jump = std::max(jump, std::abs(at.v[k] - calm_v_[k]));
      size = std::max({size, std::abs(at.v[k]), std::abs(calm_v_[k])});
    }
  });
  const Branch::Calm& calm = branches_[part].calm;
  return jump > kJumped * size + kExplained * calm.usual * std::abs(at.t - calm.t);
}

void Consistent::expect(double t, std::span<const double> a, double turned, const Consistent& other) {
  usual_steepness_ = other.usual_steepness_;
  least_steepness_ = other.least_steepness_;
  not_looked_ = kSeldom - 1;
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    branches_[part].usual_steepness = other.branches_[part].usual_steepness;
    branches_[part].approach = {true, t, turned, 0, true};
  }
  approach_a_ = last_a_ = Eigen::Map<const Eigen::VectorXd>(a.data(), static_cast<Eigen::Index>(a.size()));
}

void Consistent::forget_approach() {
  ++forgotten_;
  for (Branch& of : branches_) of.approach.known = false, of.approach.rate = -1;
}

void Consistent::approach(const State& at, std::size_t part) {
  Branch::Approach& of = branches_[part].approach;
  double change = 0;
  parts_.for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
    change = std::max(change, (at.z.segment(first, count) - approach_a_.segment(first, count)).cwiseAbs().maxCoeff());
    approach_a_.segment(first, count) = at.z.segment(first, count);
  });
  if (of.known && at.t > of.t) of.rate = change / (at.t - of.t);
  of.known = true, of.t = at.t, of.turned = 0, of.steady = true;
}

void Consistent::follow(const State& at) {
  constexpr double kGrows = 10, kSlow = 0.1;
  const double since = at.t - std::exchange(followed_, at.t);
  turned_ += problem_.fastest_turn() * since;
  for (std::size_t part = 0; part < parts_.count(); ++part)
    branches_[part].approach.turned += parts_.fastest_turn(part, problem_) * since;
  if (++not_looked_ == kSeldom || amplification_ > 1 || usual_steepness_ == 0) {
    const double now = steepness(at.t);
    const auto get_used = [&](double& usual, double to) {
      if (usual == 0 || to < usual) usual = to;
      usual += std::min(kSlow, turned_) * (to - usual);
    };
    get_used(usual_steepness_, now);
    least_steepness_ = std::min(least_steepness_, now);
    for (Branch& of : branches_) get_used(of.usual_steepness, of.steepness);
    look(now);
    not_looked_ = 0;
    turned_ = 0;
  }
  const double gravity = problem_.model().gravity.norm();
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    Branch& of = branches_[part];
    if (of.amplification == 1)
      approach(at, part);
    else
      of.approach.steady = of.approach.steady && hardly_turned(parts_, part, last_a_, at.z);
    const double acceleration = parts_.largest(part, at.a());
    if (of.calm.usual == 0) of.calm.usual = std::max(acceleration, gravity);
    const bool calm = acceleration <= kGrows * of.calm.usual;
    if (calm) of.calm.usual += kSlow * (std::max(acceleration, gravity) - of.calm.usual), of.calm.t = at.t;
    parts_.for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
      last_a_.segment(first, count) = at.z.segment(first, count);
      if (calm) calm_v_.segment(first, count) = at.v.segment(first, count);
    });
  }
}

}  // namespace poinsot
