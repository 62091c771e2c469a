#include "integrators/stepping/coarse_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/index.h"
#include "core/mechanisms.h"
#include "formulations/registry.h"
#include "integrators/stepping/by_mechanism.h"

namespace poinsot {
namespace {

constexpr int kWindow = 32;    // looks
constexpr double kTold = 0.1;  // rad

// Whether a function of time has a part in the motion of each.
std::vector<bool> driven(const Model& model, std::span<const int> mechanism) {
  std::vector<bool> driven(mechanism_count(mechanism));
  const auto drives = [&](bool it_does, int i, int j) {
    const int body = i == kGround ? j : i;
    if (it_does && body != kGround) driven[index(mechanism[index(body)])] = true;
  };
  for (const Row& row : model.rows)
    drives(!row.f.is_constant() || (row.alternate && !row.alternate->f.is_constant()), row.i, row.j);
  for (const PointForce& force : model.point_forces) drives(any_moves(force.force), force.body, kGround);
  for (const Torque& torque : model.torques) drives(any_moves(torque.torque), torque.body, kGround);
  const auto of_law = [&](const auto& spring) {
    drives(spring.law && spring.law->depends_on_time(), spring.i, spring.j);
  };
  for (const Spring& spring : model.springs) of_law(spring);
  for (const TorsionElement& torsion : model.torsions) of_law(torsion.spring);
  for (const CallbackForce& callback : model.callbacks)
    for (const int body : callback.bodies) drives(true, body, kGround);
  return driven;
}

}  // namespace

CoarseSteps::CoarseSteps(const Run& run, const PhaseError& error)
    : mechanism_(mechanisms(run.problem.model())), error_(error) {
  constexpr double kShort = 4 * kWindow, kLong = 32;
  const Model& model = run.problem.model();
  const std::vector<bool> is_driven = driven(model, mechanism_);
  const std::vector<int> free = freedoms(run.problem, mechanism_);
  const std::vector<double> noise = kinetic_noise(model, mechanism_, run.settings.step);
  mechanisms_.resize(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    mechanisms_[k].watched = free[k] > 0;
    mechanisms_[k].driven = is_driven[k];
    mechanisms_[k].noise = noise[k];
  }
  none_ = std::ranges::none_of(mechanisms_, &Mechanism::watched);
  apart_ = static_cast<int>(std::clamp(run.settings.end / run.settings.step / kShort, 1.0, kLong));
  if (none_) return;
  bodies_.resize(model.bodies.size());
  motions_.resize(model.bodies.size());
}

void CoarseSteps::add(const Problem& problem, const State& x) {
  problem.to_bodies(x.a(), bodies_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BodyState& at = bodies_[b];
    motions_[b][index(taken_)] = {at.rd, at.A.transpose() * at.rd, at.A * at.w, at.w};
  }
  if (++taken_ < kInRow) return;
  taken_ = 0;
  take_differences(problem.model());
  // Steps from one look to the next, not always as many: whole swings of so many would be seen at one place.
  constexpr double kGolden = 0.6180339887;
  const double uneven = 0.5 + std::fmod(kGolden * static_cast<double>(looks_), 1.0);
  until_ = std::max(1, static_cast<int>(apart_ * uneven));
  if (looks_++ == 0) return;
  const int steps = kInRow - 1 + until_;
  for (Mechanism& of : mechanisms_) of.turned += steps * std::pow(std::exchange(of.fastest, 0), 3);
  window_steps_ += steps;
  if (++in_window_ == kWindow) end_window();
}

void CoarseSteps::take_differences(const Model& model) {
  for (std::size_t b = 0; b < motions_.size(); ++b) {
    Mechanism& of = mechanisms_[index(mechanism_[b])];
    if (!of.watched) continue;
    const Body& body = model.bodies[b];
    const Motions& in = motions_[b];
    struct Change {
      double first, second;
    };
    const auto change = [&](Vector3 Motion::*v, const auto& square) {
      const Vector3 before = in[1].*v - in[0].*v, after = in[2].*v - in[1].*v;
      return Change{0.5 * (square(before) + square(after)), square(Vector3(after - before))};
    };
    const auto less = [](const Change& x, const Change& y) { return x.second < y.second ? x : y; };
    const auto moved = [&](const Vector3& v) { return body.mass * v.squaredNorm(); };
    const auto turned = [&](const Vector3& w) { return w.dot(body.inertia * w); };
    const Matrix3 A_t = bodies_[b].A.transpose();
    const auto turned_in_space = [&](const Vector3& w) { return turned(A_t * w); };
    const Change translation = less(change(&Motion::rd, moved), change(&Motion::rd_body, moved));
    const Change rotation = less(change(&Motion::w, turned_in_space), change(&Motion::w_body, turned));
    if (looks_ > 0) {  // what a start lets go may be damped soon
      of.now += translation.first + rotation.first;
      of.second += translation.second + rotation.second;
    }
    of.fastest = std::max(of.fastest, in[1].w_body.norm());
    of.kinetic += 0.5 * (moved(in[1].rd) + turned(in[1].w_body));
  }
  for (Mechanism& of : mechanisms_) {
    of.most_kinetic = std::max(of.most_kinetic, of.kinetic);
    of.first += of.now;
    of.squares += of.now * of.now;
    of.kinetic = of.now = 0;
  }
}

void CoarseSteps::end_window() {
  constexpr double kOfSine = 1.5;  // looks at one, for each that counts as such: (Σ cos²)² / Σ cos⁴ of them do
  constexpr double kLong = 0.15;   // h ω, of what is driven: of forced motions (h ω)²/12 is the error
  constexpr double kMost = 3.6;    // beyond, velocities change to and fro, which is told elsewhere
  for (Mechanism& of : mechanisms_) {
    const double seen = of.second / of.first;  // 4 sin²(½ Ω h); no number at rest
    if (seen > 0 && seen < kMost && of.most_kinetic > of.noise) {
      const double looks =
          std::min<double>(in_window_, kOfSine * of.first * of.first / of.squares);  // at what vibrates
      const double square = error_.vibration > 0 ? seen : seen / (1 - seen / 4);     // (h ω)²
      const double vibrates = of.first / seen / looks;  // J: twice the mean of its kinetic energy
      const double part = std::min(1.0, std::sqrt(vibrates / of.most_kinetic));
      const double steps = looks / in_window_ * window_steps_;
      if (!of.driven || square > kLong * kLong) {
        of.phase += part * steps * square * std::sqrt(square);
        of.vibrated += part * steps * std::sqrt(square);
      }
    }
    of.first = of.second = of.squares = 0;
  }
  steps_ += window_steps_;
  in_window_ = window_steps_ = 0;
}

void CoarseSteps::say(const Run& run, double h) {
  constexpr int kEnough = 4;  // looks
  if (in_window_ >= kEnough) end_window();
  if (steps_ == 0) return;
  const double all = static_cast<double>(run.statistics.steps) / static_cast<double>(steps_);
  say_of_vibrations(run, h, all);
  say_of_turns(run, h, all);
}

void CoarseSteps::say_of_vibrations(const Run& run, double h, double scale) {
  constexpr double kTurnsOn = 0.6;  // of what vibrates: as of a slider that a crank moves, whose phase is the crank's
  const Mechanism& of = *std::ranges::max_element(mechanisms_, {}, &Mechanism::phase);
  const double off = error_.vibration * of.phase * scale, lost = std::abs(off);
  if (!(lost > kTold) || of.vibrated < 2 * std::numbers::pi) return;
  const std::string whose = of_mechanism(run.problem.model(), mechanism_, static_cast<int>(&of - mechanisms_.data()));
  const double turned = h * std::cbrt(of.turned / static_cast<double>(steps_)) * static_cast<double>(steps_);  // rad
  const bool turns_on = turned > kTurnsOn * of.vibrated;
  run.tell(fmt::format(
      "steps of {:.3g} s follow the vibrations{} coarsely: in {} they are {} {:.2g} rad {} the motion's own by "
      "the end{}{}, and what vibrates is off by as much of its amplitude; a step below {:.2g} s, or error control, "
      "keeps that below {:g} rad",
      h, whose, run.settings.integrator, turns_on ? "up to" : "about", lost, off > 0 ? "ahead of" : "behind",
      turns_on ? ", less where they are those of a body that turns on" : "",
      of.driven ? ", where functions of time do not keep them" : "", 0.9 * h * std::sqrt(kTold / lost), kTold));
}

void CoarseSteps::say_of_turns(const Run& run, double h, double scale) {
  if (formulations().require(run.problem.formulation()).space != CoordinateSpace::vector_space) return;
  const auto turned = [](const Mechanism& of) { return of.watched ? of.turned : 0; };
  const Mechanism& of = *std::ranges::max_element(mechanisms_, {}, turned);
  const double off = error_.turn * turned(of) * std::pow(h, 3) * scale, lost = std::abs(off);
  if (!(lost > kTold)) return;
  const std::string whose = of_mechanism(run.problem.model(), mechanism_, static_cast<int>(&of - mechanisms_.data()));
  run.tell(
      fmt::format("a body{} turns by some {:.2g} rad in a step: in formulation {} {} is about {:.2g} rad {} its turns "
                  "by the end{}; a step below {:.2g} s, error control or formulation rA keeps that below {:g} rad",
                  whose, h * std::cbrt(of.turned / static_cast<double>(steps_)), run.problem.formulation(),
                  run.settings.integrator, lost, off > 0 ? "ahead of" : "behind",
                  of.driven ? ", where no driver turns it" : "", 0.9 * h * std::sqrt(kTold / lost), kTold));
}

}  // namespace poinsot
