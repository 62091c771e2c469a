#include "integrators/stepping/sticking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/index.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr Eigen::Index kMostVelocities = 3000;  // a law's rate is differentiated by each velocity

// The motion at a state and beside it, as far as it concerns one law.
class BesideJump {
 public:
  BesideJump(const Problem& problem, const LinearChoice& choice, const State& state, const SpringLaw& law)
      : own_(problem.clone()),
        consistent_(*own_, choice),
        state_(state),
        law_(law),
        z_(state.z),
        bodies_(index(problem.bodies())) {
    own_->set_position(state.t, span(state.q));
  }

  // The law's arguments where velocities are v.
  Arguments<double> arguments(const Eigen::VectorXd& v) {
    own_->set_velocity(span(v));
    own_->to_bodies(span(z_).first(index(v.size())), bodies_);
    return law_.arguments(place(), state_.t);
  }
  // How fast the law's v changes there.
  double change(const Eigen::VectorXd& v) {
    own_->set_velocity(span(v));
    if (!consistent_.accelerations(state_.t, span(z_)).ok()) return NAN;
    own_->to_bodies(span(z_).first(index(v.size())), bodies_);
    return law_.change(place());
  }
  // The direction in which the law's v moves velocities, by so much that v changes by 1; empty where nothing does.
  Eigen::VectorXd direction() {
    const Eigen::Index nv = state_.v.size();
    Eigen::VectorXd v = state_.v, gradient = Eigen::VectorXd::Zero(state_.z.size());
    const double here = arguments(v).v;
    for (Eigen::Index k = 0; k < nv; ++k) {
      v[k] += 1;
      gradient[k] = arguments(v).v - here;
      v[k] = state_.v[k];
    }
    Eigen::VectorXd u = gradient;
    own_->set_velocity(span(v));
    if (!consistent_.factor(state_.t).ok() || !consistent_.solve(state_.t, span(u)).ok()) return {};
    const double moved = gradient.head(nv).dot(u.head(nv));
    if (!(moved > 0)) return {};
    return u.head(nv) / moved;
  }

 private:
  LawPlace place() const { return law_.place(own_->model(), *own_, bodies_); }

  std::unique_ptr<Problem> own_;
  Consistent consistent_;
  const State& state_;
  const SpringLaw& law_;
  Eigen::VectorXd z_;
  std::vector<BodyState> bodies_;
};

// F on either side of a jump that the motion cannot leave.
struct Trap {
  double v, before, after;
};
std::optional<Trap> trap_of(BesideJump& beside, const SpringLaw& law, const State& state, int k, double instant) {
  constexpr double kAside = 1e-3;  // of how far away it may be
  constexpr double kFar = 4;       // an inertia is smaller about some axes, and other forces act besides
  std::vector<double> switches(index(law.F->switch_count()));
  Arguments<double> there = beside.arguments(state.v);
  const auto value = [&](double v) {
    there.v = v;
    law.F->switches(there, switches);
    return switches[index(k)];
  };
  const auto force = [&](double v) {
    there.v = v;
    return law.F->law(there).F;
  };
  const double from = there.v, part = 1e-6 * (1 + std::abs(from)), here = value(from);
  const double slope = (value(from + part) - value(from - part)) / (2 * part), at = from - here / slope;
  const double reach =
      kFar * std::max(std::abs(force(from - part)), std::abs(force(from + part))) / law.inertia * instant;
  if (!(std::abs(at - from) <= reach)) return {};
  // The place of the jump moves by what x and t do to it: v = c t, x + c v.
  const Arguments<double> now = there;
  there.t += part, there.x += from * part;
  const double moves = -(value(from) - here) / part / slope;
  there = now;
  const Eigen::VectorXd direction = beside.direction();
  if (direction.size() == 0) return {};
  const double aside = kAside * reach;
  const auto change = [&](double v) { return beside.change(state.v + (v - from) * direction) - moves; };
  if (!(change(at - aside) > 0) || !(change(at + aside) < 0)) return {};
  return Trap{std::abs(at) < aside ? 0 : at, force(at - aside), force(at + aside)};
}

}  // namespace

StickingWatch::StickingWatch(const Model& model, const LinearChoice& choice, double instant)
    : choice_(choice), instant_(instant) {
  std::size_t most = 0, all = 0;
  for (const SpringLaw& law : spring_laws(model)) {
    const int count = law.F->switch_count();
    bool jumps = false;
    for (int k = 0; k < count; ++k) jumps = jumps || law.F->switch_jumps(k);
    if (!jumps) continue;
    laws_.push_back(law);
    most = std::max(most, index(count));
    all += index(count);
  }
  if (laws_.empty()) return;
  switches_.resize(most);
  sides_.assign(all, 0);
  bodies_.resize(model.bodies.size());
}

Status StickingWatch::look(const Problem& problem, const State& at) {
  constexpr double kBetween = 0.05;  // of a crossing, that a step without one takes back
  constexpr double kToAndFro = 30;
  constexpr double kShort = 0.1;
  constexpr int kSeldomer = 4;
  if (laws_.empty()) return {};
  problem.to_bodies(at.a(), bodies_);
  bool crossed = false;
  auto side = sides_.begin();
  for (const SpringLaw& law : laws_) {
    const std::span<double> switches(switches_.data(), index(law.F->switch_count()));
    law.F->switches(law.arguments(law.place(problem.model(), problem, bodies_), at.t), switches);
    for (int k = 0; k < law.F->switch_count(); ++k, ++side) {
      if (!law.F->switch_jumps(k)) continue;
      crossed = crossed || switches[index(k)] * *side < 0;
      *side = switches[index(k)];
    }
  }
  crossings_ = crossed ? crossings_ + 1 : std::max(0.0, crossings_ - kBetween);
  short_ = at.t - std::exchange(t_, at.t) < kShort * instant_ ? short_ + 1 : 0;
  if (crossings_ < kToAndFro && short_ < many_) return {};
  if (short_ >= many_) many_ *= kSeldomer;
  crossings_ = 0;
  if (sticking_law(problem, choice_, at, instant_).empty()) return {};
  return {Failure::step_size_too_small, at.t,
          fmt::format("at t = {:.9g} s steps go to and fro about a jump of a force, and do not get on", at.t)};
}

std::string sticking_law(const Problem& problem, const LinearChoice& choice, const State& state, double instant) {
  if (state.v.size() > kMostVelocities) return {};
  const Model& model = problem.model();
  for (const SpringLaw& law : spring_laws(model)) {
    for (int k = 0; k < law.F->switch_count(); ++k) {
      if (!law.F->switch_jumps(k)) continue;
      BesideJump beside(problem, choice, state, law);
      const std::optional<Trap> trap = trap_of(beside, law, state, k, instant);
      if (!trap) continue;
      const bool turns = law.torsion >= 0;
      const std::string& name =
          turns ? model.torsions[index(law.torsion)].spring.name : model.springs[index(law.spring)].name;
      return fmt::format(
          "the law of force '{}' jumps from {:.3g} to {:.3g} {} where v passes {:.3g}, and either side leads back "
          "there: no motion follows such a law, as of a body that sticks; one that is steep instead, as "
          "min(max(v/c, -1), 1) with a small c in the place of sign(v), does not stop it",
          name, trap->before, trap->after, turns ? "N m" : "N", trap->v);
    }
  }
  return {};
}

}  // namespace poinsot
