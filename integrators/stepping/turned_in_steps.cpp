#include "integrators/stepping/turned_in_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

// Where a step of h lets a spring pass all but through no length: the force that turns round.
double turns_round(const SpringLaw& of, const LawPlace& from, const LawPlace& to, double t, double h) {
  constexpr double kTurned = 0.5;   // the cosine: below, steps see how the spring turns
  constexpr double kCounts = 1e-6;  // of the speed
  const double speed = std::max(from.rate.norm(), to.rate.norm());
  const bool passes = speed > 0 && from.d.dot(from.rate) <= 0 && to.d.dot(to.rate) >= 0 &&
                      from.d.dot(to.d) <= kTurned * from.d.norm() * to.d.norm();
  if (!passes) return 0;
  const double F = of.turning(std::max(from.d.norm(), to.d.norm()), t);
  return std::abs(F) * h > kCounts * of.inertia * speed ? F : 0;
}

// s, the longest step for a spring that one of h throws to the other side of no length, as its force and not the ends'
// velocities lead to; 0 where that is not what has happened. Where its force is as good as constant, as that of a long
// soft one, steps follow it. That other solution is no farther from no length than about the spring is long, and there
// is none where its force there is too small to hold the ends against their velocities: coarse steps go beyond where a
// short stiff spring leads. Nor is a side anything of springs that stand for a pin, short beside their `arm`, m.
double step_not_thrown(const SpringLaw& of, double arm, const LawPlace& from, const LawPlace& to, double t, double h) {
  constexpr double kNear = 0.5;  // of the shorter span: how close to no length the straight way passes
  constexpr double kLed = 0.5;   // of the first: what the velocities leave of it
  constexpr double kFar = 2;     // of its own length
  constexpr double kPin = 0.01;  // of the arm
  constexpr double kPart = 0.5;  // of the way: what the change of the force has to account for
  const double before = from.d.norm(), after = to.d.norm();
  const Vector3 way = to.d - from.d;
  const double side = from.d.dot(to.d);
  if (of.zero < kPin * arm || !(side < 0) || after > kFar * of.zero ||
      from.d.cross(way).norm() > kNear * std::min(before, after) * way.norm())
    return 0;
  const Vector3 led = from.d + h * from.rate;
  if (from.d.dot(led) < kLed * before * before) return 0;
  if (!(h * h * std::abs(of.at_rest(0, t)) > of.inertia * led.norm())) return 0;
  const double change = std::abs(of.at_rest(before, t) - of.at_rest(0, t));
  if (!(h * h * change > kPart * of.inertia * way.norm())) return 0;
  return std::sqrt(of.inertia * before / change);
}

// Steps of h until the ends may pass one another.
double steps_until_passed(const LawPlace& at, double h) {
  constexpr double kMost = 64;
  constexpr double kFaster = 4;  // they may become meanwhile
  const double length = at.d.norm();
  return std::min({kMost, length / (kFaster * h * at.rate.norm()), std::sqrt(length / at.second.norm()) / h});
}

}  // namespace

TurnedInSteps::TurnedInSteps(const Model& model, Tell tell) : model_(model), tell_(std::move(tell)) {
  const auto arm = [](int body, const Vector3& s) { return body == kGround ? 0 : s.norm(); };
  for (const SpringLaw& of : springs_that_may_turn_round(model)) {
    const ::poinsot::Spring& spring = model.springs[index(of.spring)];
    springs_.push_back({of, std::max(arm(spring.i, spring.s_i), arm(spring.j, spring.s_j))});
  }
  if (!springs_.empty()) bodies_.resize(model.bodies.size());
}

Status TurnedInSteps::look(const Problem& problem, const State& at, double h) {
  problem.to_bodies(at.a(), bodies_);
  for (Spring& spring : springs_) spring.to = spring.of.place(model_, problem, bodies_);
  if (look_.goes_on(at.t, h)) {
    for (const Spring& spring : springs_) {
      if (Status status = thrown_over(spring, at, h); !status.ok()) return status;
      const double F = told_ ? 0 : turns_round(spring.of, spring.from, spring.to, at.t, h);
      if (F == 0) continue;
      told_ = true;
      tell_(fmt::format(
          "at t = {:.6g} s {} passes through no length within a step, and its force, {:.3g} N, turns round: "
          "that costs an error in proportion to the step, whatever the method's order; an integrator with "
          "error control steps onto it",
          at.t, spring.of.called(model_), F));
    }
  }
  double quiet = HUGE_VAL;
  for (Spring& spring : springs_) {
    spring.from = spring.to;
    quiet = std::min(quiet, steps_until_passed(spring.to, h));
  }
  const bool first = !std::exchange(begun_, true);  // accelerations may not be known yet
  look_.after(at.t, h, first ? 1 : quiet);
  return {};
}

Status TurnedInSteps::thrown_over(const Spring& spring, const State& at, double h) const {
  const double serves = step_not_thrown(spring.of, spring.arm, spring.from, spring.to, at.t, h);
  if (serves == 0) return {};
  Status status = with_settings(
      {Failure::not_converged, at.t,
       fmt::format("at t = {:.9g} s a step has put {} through no length to the other side, where its ends' velocities "
                   "do not lead: it is too long for so stiff a spring, and its equations have a solution on either "
                   "side",
                   at.t, spring.of.called(model_))},
      fmt::format("try a step of at most {:.2g} s", serves));
  status.step = serves;
  return status;
}

}  // namespace poinsot
