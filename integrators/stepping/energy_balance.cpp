#include "integrators/stepping/energy_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/index.h"
#include "core/mechanisms.h"
#include "formulations/law_potential.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

Vector3 place(std::span<const BodyState> bodies, int body, const Vector3& s) {
  if (body == kGround) return s;
  const BodyState& at = bodies[index(body)];
  return at.r + at.A * s;
}

}  // namespace

EnergyBalance::EnergyBalance(const Problem& problem) : parts_(problem), of_(parts_.count()) {
  const std::vector<int> mechanism = mechanisms(problem.model());
  const std::vector<EnergyFate> fates = energy_fates(problem.model(), mechanism);
  for (std::size_t k = 0; k < of_.size(); ++k) of_[k].fate = fates[k];
  none_ = std::ranges::all_of(fates, [](EnergyFate fate) { return fate == EnergyFate::unknown; });
  if (none_) return;
  momentum_.resize(problem.nv());
  no_accelerations_.setZero(problem.nv());
  for (std::size_t b = 0; b < problem.model().bodies.size(); ++b)
    of_[parts_.of_body(static_cast<int>(b))].mass += problem.model().bodies[b].mass;
  bodies_.resize(problem.model().bodies.size());
  x_first_.reserve(problem.model().springs.size() + problem.model().torsions.size());
}

void EnergyBalance::begin(const Sample& start, int order) {
  if (none_) return;
  order_ = order;
  add_energies(start.problem, start.t, &Mechanism::first);
  for (Mechanism& of : of_) of.least = of.first;
}

void EnergyBalance::end(const Sample& end) {
  if (none_) return;
  add_energies(end.problem, end.t, &Mechanism::last);
  ended_ = true;
}

void EnergyBalance::look(const Problem& problem, double t, const Eigen::VectorXd& v) {
  problem.momentum(span(v), span(momentum_));
  for (std::size_t k = 0; k < of_.size(); ++k) {
    if (of_[k].fate == EnergyFate::unknown) continue;
    of_[k].kinetic = 0.5 * parts_.dot(k, v, momentum_);
    of_[k].most_kinetic = std::max(of_[k].most_kinetic, of_[k].kinetic);
  }
  if (--until_ == 0) look_on_the_way(problem, t);
}

void EnergyBalance::look_on_the_way(const Problem& problem, double t) {
  constexpr int kMost = 128;
  if (++energies_ == kMost) apart_ *= 2, energies_ /= 2;
  until_ = apart_;
  constexpr double kPart = 1e-3;  // of the work of a law
  add_energies(problem, t, &Mechanism::now, kPart);
  const double late = order_ == 1 ? kLate / static_cast<double>(steps_) : 0;
  for (Mechanism& of : of_) {
    const double more = of.fate == EnergyFate::taken ? of.now - of.least : std::abs(of.now - of.first);
    of.least = std::min(of.least, of.now);
    if (const double off = more - late * of.kinetic; off > of.most_off) of.most_off = off, of.t_off = t;
  }
}

void EnergyBalance::add_energies(const Problem& problem, double t, double Mechanism::*sum, double part) {
  constexpr double kRounding = 2e3 * std::numeric_limits<double>::epsilon();
  const Model& model = problem.model();
  problem.to_bodies(span(no_accelerations_), bodies_);
  for (Mechanism& of : of_) of.*sum = of.loads = of.rounding = 0;
  const auto add = [&](Mechanism& of, double energy, double load) {
    of.*sum += energy;
    of.loads += std::abs(load);
    of.rounding += kRounding * std::abs(energy);
  };
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = model.bodies[b];
    const BodyState& state = bodies_[b];
    Mechanism& of = of_[parts_.of_body(static_cast<int>(b))];
    add(of, 0.5 * (body.mass * state.rd.squaredNorm() + state.w.dot(body.inertia * state.w)), 0);
    add(of, -body.mass * model.gravity.dot(state.r), body.mass * model.gravity.norm());
  }
  std::size_t springs = 0;
  const auto add_spring = [&](const auto& spring, double x) {
    if (springs == x_first_.size()) x_first_.push_back(x);
    const double from = x_first_[springs++];
    if (spring.i == kGround && spring.j == kGround) return;
    Mechanism& of = of_[parts_.of_body(spring.i == kGround ? spring.j : spring.i)];
    if (of.fate == EnergyFate::unknown) return;
    if (spring.law)
      add(of, law_work(*spring.law, from, x, t, part), spring.law->law(Arguments<double>{t, x, 0}).F);
    else
      add(of, 0.5 * spring.stiffness * x * x, spring.stiffness * x);
  };
  for (const Spring& spring : model.springs) {
    const Vector3 d = place(bodies_, spring.j, spring.s_j) - place(bodies_, spring.i, spring.s_i);
    add_spring(spring, d.norm() - spring.length);
  }
  for (std::size_t k = 0; k < model.torsions.size(); ++k) {
    const TorsionSpring& spring = model.torsions[k].spring;
    add_spring(spring, problem.twist(static_cast<int>(k)) - spring.angle);
  }
  for (const PointForce& force : model.point_forces) {
    Mechanism& of = of_[parts_.of_body(force.body)];
    if (of.fate == EnergyFate::unknown) continue;
    const Vector3 F(force.force[0].at(t).f, force.force[1].at(t).f, force.force[2].at(t).f);
    add(of, -F.dot(place(bodies_, force.body, force.point)), F.norm());
  }
}

// What would keep it.
std::string EnergyBalance::remedy(const Settings& settings, const IntegratorEntry& integrator, double share) {
  constexpr double kKnown = 0.5;  // up to there a step to offer follows from what was lost
  if (integrator.controls_error) return fmt::format("rtol {:.0e} or less keeps more of it", settings.rtol / 100);
  if (share > kKnown) return "of so much it cannot be told which step would keep it; error control does";
  const double shorter = kTold * std::pow(1 - share, 2) / share;
  return fmt::format("a step below {:.2g} s, or error control, keeps it to {:.0f} %",
                     0.9 * settings.step * std::pow(shorter, 1.0 / integrator.order), 100 * kTold);
}

double EnergyBalance::noise(const Mechanism& of, const Run& run) const {
  constexpr double kStill = 1e-10;  // of an arm, in all of the run: it rests
  const double arm = longest_arm(run.problem.model()), speed = kStill * arm / run.settings.end;
  const double off = 10 * run.statistics.violation.position * std::max(1.0, arm);
  return of.rounding + off * of.loads + 0.5 * of.mass * speed * speed;
}

void EnergyBalance::conclude(const Run& run, const IntegratorEntry& integrator) const {
  if (ended_ && !tell_at_end(run, integrator)) tell_on_the_way(run, integrator);
}

bool EnergyBalance::tell_at_end(const Run& run, const IntegratorEntry& integrator) const {
  double most = -1, most_of_all = -1;
  const Mechanism* told = nullptr;
  for (const Mechanism& of : of_) {
    const double more = of.last - of.first;
    if (of.fate == EnergyFate::unknown || !(of.most_kinetic > noise(of, run))) continue;
    const double share = std::abs(more) / of.most_kinetic;
    if (of.fate == EnergyFate::kept) most = std::max(most, share);
    if (!(share > most_of_all) || (of.fate == EnergyFate::taken && more <= 0)) continue;
    most_of_all = share;
    told = std::abs(more) > noise(of, run) ? &of : nullptr;
  }
  if (most >= 0) run.statistics.energy_change = most;
  const double late = integrator.order == 1 ? kLate / static_cast<double>(run.statistics.steps) : 0;
  if (!told || most_of_all < kTold + late) return false;
  const Model& model = run.problem.model();
  const std::string whose = of_mechanism(model, mechanisms(model), static_cast<int>(told - of_.data()));
  run.tell(fmt::format(
      "{} leaves the energy{} {:.3g} J {} at t = {:.6g} s than at the start, by {:.3g} % of {} largest "
      "kinetic energy: {}; {}",
      run.settings.integrator, whose, std::abs(told->last - told->first), told->last < told->first ? "lower" : "higher",
      run.state.t, 100 * most_of_all, whose.empty() ? "the" : "its",
      told->fate == EnergyFate::kept ? "nothing drives or damps it, so it should stay as it is"
                                     : "dampers take of it and nothing gives",
      remedy(run.settings, integrator, most_of_all)));
  return true;
}

void EnergyBalance::tell_on_the_way(const Run& run, const IntegratorEntry& integrator) const {
  const Mechanism* told = nullptr;
  double most = kTold;
  for (const Mechanism& of : of_) {
    if (of.fate == EnergyFate::unknown || !(std::min(of.most_kinetic, of.most_off) > noise(of, run))) continue;
    if (const double share = of.most_off / of.most_kinetic; share > most) most = share, told = &of;
  }
  if (!told) return;
  const Model& model = run.problem.model();
  const std::string whose = of_mechanism(model, mechanisms(model), static_cast<int>(told - of_.data()));
  run.tell(fmt::format(
      "at t = {:.6g} s {} has the energy{} {:.3g} J off what it was {}, by {:.3g} % of {} largest kinetic energy, "
      "though no more at the end: {}; {}",
      told->t_off, run.settings.integrator, whose, told->most_off,
      told->fate == EnergyFate::kept ? "at the start" : "at the least before", 100 * most,
      whose.empty() ? "the" : "its",
      told->fate == EnergyFate::kept ? "nothing drives or damps it, so it should stay as it is"
                                     : "dampers take of it and nothing gives",
      remedy(run.settings, integrator, most)));
}

}  // namespace poinsot
