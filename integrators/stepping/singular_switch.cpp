#include "integrators/stepping/singular_switch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr double kApart = 0.006;  // rad, τ: rounding 63 ε/τ³ of accelerations and 720 (τ/R)⁶ of velocities are small
constexpr double kNearby = 0.06;  // rad: so far on it is near
constexpr int kOnASide = 6;
// What one place less may change of velocities and positions, of accelerations and multipliers: R is as small as that
// allows. And what velocities of either side may differ by, further on by some of how far that is in rad.
constexpr double kSameVelocity = 1e-6, kSameForce = 3e-3, kOfBeyond = 10;
constexpr double kLinear = 3e-3;  // rad: so far accelerations vary linearly
// Of the velocity: what rounding makes of that across, it makes the square of along.
constexpr double kMostNoise = 1e-4;
// rad, and tolerances: so far from the switch errors of the position do not decide on its side.
constexpr double kBeyondLeast = 1e-6, kBeyondMost = 1e-5, kBeyondTolerances = 10;

// Lagrange's, of place k of so many, at τ, 2 τ, ..., for s = x τ.
double weight(int k, int places, double x) {
  double w = 1;
  for (int j = 1; j <= places; ++j)
    if (j != k) w *= (x - j) / (k - j);
  return k <= places ? w : 0;
}

struct Beside {
  Eigen::VectorXd c, v, a, lambda;

  void add(double by, const Beside& x) { c += by * x.c, v += by * x.v, a += by * x.a, lambda += by * x.lambda; }
};

class OneSided {
 public:
  OneSided(Problem& problem, Consistent& consistent) : problem_(problem), consistent_(consistent), place_(problem) {}

  // At x τ, of places that a τ of either sign leads to.
  bool find(const State& at, double tau, double x = 0) {
    Beside less;
    for (int k = 1; k <= kOnASide; ++k) {
      if (!stand_beside(at, tau * k)) return false;
      if (k == 1) {
        limit = less = beside_;
        limit.add(-1, beside_), less.add(-1, beside_);
      }
      limit.add(weight(k, kOnASide, x), beside_), less.add(weight(k, kOnASide - 1, x), beside_);
    }
    const auto same = [](const Eigen::VectorXd& y, const Eigen::VectorXd& z, double of) {
      return (y - z).lpNorm<Eigen::Infinity>() <= of;
    };
    const double speed = largest(span(limit.v));
    has_multipliers = same(limit.lambda, less.lambda, kSameForce * largest(span(limit.lambda)));
    return same(limit.v, less.v, kSameVelocity * speed) &&
           same(limit.c, less.c, kSameVelocity * speed * std::abs(tau)) &&
           same(limit.a, less.a, kSameForce * largest(span(limit.a)));
  }

  Beside limit;
  bool has_multipliers = false;

 private:
  bool stand_beside(const State& at, double s) {
    place_.t = at.t;
    place_.v = at.v;
    const Eigen::VectorXd way = s * at.v;
    problem_.retract(span(at.q), span(way), span(place_.q));
    beside_.c.setZero(at.v.size());
    if (!consistent_.project_position(place_.t, span(place_.q), span(beside_.c)).ok()) return false;
    consistent_.stand(place_);
    if (!consistent_.project_velocity(place_.t, span(place_.v)).ok() || !consistent_.accelerations(place_).ok())
      return false;
    beside_.v = place_.v;
    beside_.a = place_.z.head(at.v.size());
    beside_.lambda = place_.z.tail(place_.z.size() - at.v.size());
    return true;
  }

  Problem& problem_;
  Consistent& consistent_;
  State place_;
  Beside beside_;
};

}  // namespace

double cross_singular_switch(Problem& problem, Consistent& consistent, const State& before, double t, double rtol,
                             State& at) {
  consistent.stand(before);
  const double rate = problem.fastest_turn(), tau = kApart / rate, h = t - before.t;
  if (!(rate > 0) || !(h * rate <= kLinear)) return 0;
  OneSided side(problem, consistent);
  const Eigen::VectorXd a = before.z.head(before.v.size());
  Eigen::VectorXd a_end = a;
  const auto lead_on = [&] {
    const Eigen::VectorXd way = h * (before.v + h * (a / 3 + a_end / 6));
    problem.retract(span(before.q), span(way), span(at.q));
    at.v = before.v + 0.5 * h * (a + a_end);
    at.t = t;
    return side.find(at, -tau);
  };
  at.z = before.z;
  if (!lead_on()) return 0;
  a_end = side.limit.a;
  if (!lead_on()) return 0;
  const Beside near = side.limit;
  if (const Eigen::VectorXd noise = near.v - at.v; !(largest(span(noise)) <= kMostNoise * largest(span(near.v))))
    return 0;
  const double beyond = std::clamp(kBeyondTolerances * rtol, kBeyondLeast, kBeyondMost);
  if (!side.find(at, tau, beyond / kApart)) return 0;
  const Eigen::VectorXd apart = side.limit.v - near.v;
  if (!(largest(span(apart)) <= (kSameVelocity + kOfBeyond * beyond) * largest(span(near.v)))) return 0;
  const Eigen::VectorXd q = at.q;
  problem.retract(span(q), span(near.c), span(at.q));
  at.v = near.v;
  at.z << side.limit.a, side.limit.lambda;
  at.multipliers_open = !side.has_multipliers;
  consistent.forget_approach();
  consistent.lead(at, t + beyond / rate);
  consistent.stand(at);
  return kNearby / rate;
}

}  // namespace poinsot
