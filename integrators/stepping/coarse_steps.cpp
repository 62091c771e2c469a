#include "integrators/stepping/coarse_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/index.h"
#include "core/mechanisms.h"

namespace poinsot {
namespace {

constexpr int kWindow = 32;  // looks

bool is_still(const Expression (&components)[3]) {
  return std::ranges::all_of(components, [](const Expression& f) { return f.is_constant(); });
}

// Whether a function of time has a part in the motion of each.
std::vector<bool> driven(const Model& model, std::span<const int> mechanism) {
  std::vector<bool> driven(mechanism_count(mechanism));
  const auto drives = [&](bool it_does, int i, int j) {
    const int body = i == kGround ? j : i;
    if (it_does && body != kGround) driven[index(mechanism[index(body)])] = true;
  };
  for (const Row& row : model.rows)
    drives(!row.f.is_constant() || (row.alternate && !row.alternate->f.is_constant()), row.i, row.j);
  for (const PointForce& force : model.point_forces) drives(!is_still(force.force), force.body, kGround);
  for (const Torque& torque : model.torques) drives(!is_still(torque.torque), torque.body, kGround);
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

CoarseSteps::CoarseSteps(const Run& run, double phase_error)
    : mechanism_(mechanisms(run.problem.model())), phase_error_(phase_error) {
  constexpr double kNoise = 1e3 * std::numeric_limits<double>::epsilon();  // of a position, from step to step
  constexpr double kShort = 4 * kWindow, kLong = 32;
  const Model& model = run.problem.model();
  const std::vector<bool> is_driven = driven(model, mechanism_);
  for (const bool it_is : is_driven) mechanisms_.emplace_back().watched = !it_is;
  none_ = std::ranges::none_of(mechanisms_, &Mechanism::watched);
  apart_ = static_cast<int>(std::clamp(run.settings.end / run.settings.step / kShort, 1.0, kLong));
  if (none_) return;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const double speed = kNoise / run.settings.step;
    mechanisms_[index(mechanism_[b])].noise +=
        0.5 * speed * speed * (body.mass * body.position.squaredNorm() + body.inertia.trace());
  }
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
  window_steps_ += kInRow - 1 + until_;
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
  constexpr double kMost = 3.6;    // beyond, velocities change to and fro, which is told elsewhere
  for (Mechanism& of : mechanisms_) {
    const double seen = of.second / of.first;  // 4 sin²(½ Ω h); no number at rest
    if (seen > 0 && seen < kMost && of.most_kinetic > of.noise) {
      const double looks =
          std::min<double>(in_window_, kOfSine * of.first * of.first / of.squares);  // at what vibrates
      const double square = phase_error_ > 0 ? seen : seen / (1 - seen / 4);         // (h ω)²
      const double vibrates = of.first / seen / looks;  // J: twice the mean of its kinetic energy
      const double part = std::min(1.0, std::sqrt(vibrates / of.most_kinetic));
      const double steps = looks / in_window_ * window_steps_;
      of.phase += part * steps * square * std::sqrt(square);
      of.turns += part * steps * std::sqrt(square);
    }
    of.first = of.second = of.squares = 0;
  }
  steps_ += window_steps_;
  in_window_ = window_steps_ = 0;
}

void CoarseSteps::say(const Run& run, double h) {
  constexpr double kTold = 0.2;  // rad
  constexpr int kEnough = 4;     // looks
  if (in_window_ >= kEnough) end_window();
  if (steps_ == 0) return;
  const Mechanism& of = *std::ranges::max_element(mechanisms_, {}, &Mechanism::phase);
  const double lost =
      std::abs(phase_error_) * of.phase * static_cast<double>(run.statistics.steps) / static_cast<double>(steps_);
  if (!(lost > kTold) || of.turns < 2 * std::numbers::pi) return;
  const std::string whose = of_mechanism(run.problem.model(), mechanism_, static_cast<int>(&of - mechanisms_.data()));
  run.tell(fmt::format(
      "steps of {:.3g} s follow the vibrations{} coarsely: in {} they are about {:.2g} rad {} of the motion's own by "
      "the end, and what vibrates is off by as much of its amplitude; a step below {:.2g} s, or error control, keeps "
      "that below {:g} rad",
      h, whose, run.settings.integrator, lost, phase_error_ > 0 ? "ahead" : "behind", 0.9 * h * std::sqrt(kTold / lost),
      kTold));
}

}  // namespace poinsot
