#include "integrators/stepping/turned_in_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

// Steps of h until the ends may pass one another.
double steps_until_passed(const LawPlace& at, double h) {
  constexpr double kMost = 64;
  constexpr double kFaster = 4;  // they may become meanwhile
  const double length = at.d.norm();
  return std::min({kMost, length / (kFaster * h * at.rate.norm()), std::sqrt(length / at.second.norm()) / h});
}

}  // namespace

TurnedInSteps::TurnedInSteps(const Model& model, Tell tell) : model_(model), tell_(std::move(tell)) {
  for (const SpringLaw& of : springs_that_may_turn_round(model)) springs_.push_back({of, {}});
  if (!springs_.empty()) bodies_.resize(model.bodies.size());
}

void TurnedInSteps::look(const Problem& problem, const State& at, double h) {
  problem.to_bodies(at.a(), bodies_);
  const bool goes_on = look_.goes_on(at.t, h);
  double quiet = HUGE_VAL;
  for (Spring& spring : springs_) {
    const LawPlace to = spring.of.place(model_, problem, bodies_);
    const double F = goes_on ? turns_round(spring.of, spring.from, to, at.t, h) : 0;
    if (F != 0) {
      tell_(fmt::format(
          "at t = {:.6g} s {} passes through no length within a step, and its force, {:.3g} N, turns round: "
          "that costs an error in proportion to the step, whatever the method's order; an integrator with "
          "error control steps onto it",
          at.t, spring.of.called(model_), F));
      springs_.clear();
      return;
    }
    spring.from = to;
    quiet = std::min(quiet, steps_until_passed(to, h));
  }
  look_.after(at.t, h, quiet);
}

}  // namespace poinsot
