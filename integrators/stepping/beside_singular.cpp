// What Consistent knows of singular positions near: how steep the constraints are, how large accelerations.
#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

double Consistent::steepness(double t) {
  std::ranges::copy(off_by_one_, rhs_.begin());
  return system_.solve(t, span(rhs_)).ok() ? largest(moves()) : HUGE_VAL;
}

void Consistent::look(double steepness) {
  const double now = usual_steepness_ > 0 ? steepness / usual_steepness_ : 0;
  steepness_ = steepness;
  amplification_ = now > kSteep ? now : 1;
  beside_singular_ = beside_singular_ || amplification_ > 1;
}

double Consistent::error_in(const State& at, std::span<const double> moved_by, double shift) const {
  constexpr double kRounding = 2e-15, kMore = 8, kLucky = 0.1;
  const double q = largest(moved_by.first(nv_)), v = largest(moved_by.subspan(nv_));
  const double most = steepness_ * kRounding * std::max(1.0, largest(span(at.q)));
  const bool rounding = q <= most && v <= kMore * steepness_ * problem_.fastest_turn() * std::max(q, kLucky * most);
  return rounding ? 0 : shift / amplification_;
}

bool Consistent::made_of_rounding(const State& at) {
  constexpr double kUnusual = 1e4, kAccounted = 1e3;
  const double acceleration = largest(at.a());
  if (calm_.usual == 0 || !(acceleration > kUnusual * calm_.usual)) return false;
  const std::span<const double> none = span(zeros_);
  problem_.equations_of_motion(none.first(nv_), {}, moves());  // −Q
  problem_.gamma(rows());
  const double loads = largest(moves()), gamma = largest(rows());
  problem_.momentum(at.a(), moves());
  return acceleration > kAccounted * gamma && largest(moves()) > kAccounted * loads;
}

bool turned_round(const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  constexpr double kReverse = 0.1;
  return now.dot(before) < -kReverse * std::max(now.squaredNorm(), before.squaredNorm());
}

namespace {

bool hardly_turned(const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  constexpr double kHardly = 0.8;
  return now.dot(before) > kHardly * std::max(now.squaredNorm(), before.squaredNorm());
}

}  // namespace

// A mechanism that comes to rest in a singular position goes on by any of its branches as far as the velocities say.
// Beyond it accelerations of another one differ altogether from those before, in the direction that the constraints
// leave free there, though bodies have turned by little and did not lead to expect it; not those that turn on from step
// to step, as of a ball that is drawn in on a thread.
bool Consistent::turns_back(const State& at) {
  constexpr double kTrusted = 1e4;  // times as steep as usual, beyond which rounding makes accelerations
  constexpr double kLittle = 0.1;   // rad
  constexpr double kExpected = 0.25;
  if (!(amplification_ > 1 && amplification_ < kTrusted) || approach_.rate < 0 || approach_.turned > kLittle)
    return false;
  const Eigen::VectorXd now = at.z.head(at.v.size());
  if (!turned_round(approach_.a, now) || (approach_.steady && hardly_turned(approach_.last, now))) return false;
  const Eigen::VectorXd change = now - approach_.a;
  if (!(approach_.rate * (at.t - approach_.t) < kExpected * change.cwiseAbs().maxCoeff())) return false;
  return lies_free(at.t, change);
}

bool Consistent::lies_free(double t, const Eigen::VectorXd& x) {
  constexpr double kAlong = 0.9;
  if (steepness(t) == HUGE_VAL) return false;
  const Eigen::VectorXd free = rhs_.head(x.size());
  const auto product = [&](const Eigen::VectorXd& with, const Eigen::VectorXd& of) {
    problem_.momentum(span(of), moves());
    return rhs_.head(x.size()).dot(with);
  };
  const double along = product(x, free);
  return along * along > kAlong * product(free, free) * product(x, x);
}

bool Consistent::leaves_branch(const State& at) {
  constexpr double kJumped = 0.01, kExplained = 10;
  if (turns_back(at)) return true;
  if (!made_of_rounding(at)) return false;
  double jump = 0, size = 0;
  for (Eigen::Index k = 0; k < at.v.size(); ++k) {
    jump = std::max(jump, std::abs(at.v[k] - calm_.v[k]));
    size = std::max({size, std::abs(at.v[k]), std::abs(calm_.v[k])});
  }
  return jump > kJumped * size + kExplained * calm_.usual * std::abs(at.t - calm_.t);
}

void Consistent::expect(double t, std::span<const double> a, double turned, const Consistent& other) {
  usual_steepness_ = other.usual_steepness_;
  not_looked_ = kSeldom - 1;
  approach_.t = t, approach_.turned = turned, approach_.rate = 0, approach_.known = true;
  approach_.a = Eigen::Map<const Eigen::VectorXd>(a.data(), static_cast<Eigen::Index>(a.size()));
  approach_.last = approach_.a;
  approach_.steady = true;
}

void Consistent::approach(const State& at) {
  if (approach_.known && at.t > approach_.t)
    approach_.rate = (at.z.head(at.v.size()) - approach_.a).cwiseAbs().maxCoeff() / (at.t - approach_.t);
  approach_.a = at.z.head(at.v.size());
  approach_.t = at.t;
  approach_.turned = 0;
  approach_.steady = true;
  approach_.known = true;
}

void Consistent::follow(const State& at) {
  constexpr double kGrows = 10, kSlow = 0.1;
  const double turned = problem_.fastest_turn() * (at.t - std::exchange(followed_, at.t));
  turned_ += turned;
  approach_.turned += turned;
  if (++not_looked_ == kSeldom || amplification_ > 1 || usual_steepness_ == 0) {
    const double now = steepness(at.t);
    if (usual_steepness_ == 0 || now < usual_steepness_) usual_steepness_ = now;
    usual_steepness_ += std::min(kSlow, turned_) * (now - usual_steepness_);
    look(now);
    not_looked_ = 0;
    turned_ = 0;
  }
  if (amplification_ == 1) {
    approach(at);
  } else {
    approach_.steady = approach_.steady && hardly_turned(approach_.last, at.z.head(at.v.size()));
  }
  approach_.last = at.z.head(at.v.size());
  const double acceleration = largest(at.a());
  if (calm_.usual == 0) calm_.usual = std::max(acceleration, problem_.model().gravity.norm());
  if (acceleration > kGrows * calm_.usual) return;
  calm_.usual += kSlow * (std::max(acceleration, problem_.model().gravity.norm()) - calm_.usual);
  calm_.t = at.t;
  calm_.v = at.v;
}

}  // namespace poinsot
