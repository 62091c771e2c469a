#include "integrators/stepping/numerical_damping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/index.h"
#include "core/mechanisms.h"
#include "integrators/stepping/by_mechanism.h"
#include "integrators/stepping/energy_balance.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

NumericalDamping::NumericalDamping(const Run& run)
    : mechanism_(mechanisms(run.problem.model())), momentum_(run.problem.nv()) {
  const Problem& problem = run.problem;
  const Model& model = problem.model();
  const std::vector<int> free = freedoms(problem, mechanism_);
  const std::vector<double> noise = kinetic_noise(model, mechanism_, run.settings.step);
  mechanisms_.resize(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    mechanisms_[k].noise = noise[k];
    const bool known = run.energy && run.energy->covers(k);  // what it lost
    mechanisms_[k].freedoms = known ? 0 : free[k];
  }
  moves_ = std::ranges::any_of(mechanisms_, [](const Mechanism& of) { return of.freedoms > 0; });
  if (!moves_) return;
  bodies_.resize(model.bodies.size());
  problem.to_bodies(run.state.a(), bodies_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) then_.push_back(motion(model.bodies[b], bodies_[b]));
  list_pushes(model);
  if (!pushes_.empty()) impulses_.resize(bodies_.size());
  pushed_until_ = run.state.t;
}

void NumericalDamping::list_pushes(const Model& model) {
  for (const PointForce& force : model.point_forces)
    if (any_moves(force.force)) pushes_.push_back({force.body, &force, nullptr});
  for (const Torque& torque : model.torques)
    if (any_moves(torque.torque)) pushes_.push_back({torque.body, nullptr, &torque});
}

// What a step to x gives: a function of time as it is at its end.
void NumericalDamping::push(const Problem& problem, const State& x) {
  problem.to_bodies(x.a(), bodies_);
  const double h = x.t - std::exchange(pushed_until_, x.t);
  for (const Push& push : pushes_) {
    const Matrix3& A = bodies_[index(push.body)].A;
    const auto given = [&](const Expression(&of)[3], Frame frame) {
      const Vector3 f(of[0].at(x.t).f, of[1].at(x.t).f, of[2].at(x.t).f);
      return Vector3(h * (frame == Frame::body ? A * f : f));
    };
    Impulse& all = impulses_[index(push.body)];
    if (push.torque) {
      all.moment += given(push.torque->torque, push.torque->frame);
    } else {
      const Vector3 J = given(push.force->force, push.force->frame);
      all.force += J;
      all.moment += (A * push.force->point).cross(J);
    }
  }
}

NumericalDamping::Motion NumericalDamping::motion(const Body& body, const BodyState& at) {
  return {at.rd, at.A * (body.inertia * at.w), at.A * at.w};
}

void NumericalDamping::add(const Problem& problem, const State& x) {
  since_ = 0;
  if (!moves_) return;
  steps_ += kApart;
  problem.to_bodies(x.a(), bodies_);
  problem.momentum(span(x.v), span(momentum_));
  const Eigen::Index per_body = x.v.size() / problem.bodies();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = problem.model().bodies[b];
    const Motion now = motion(body, bodies_[b]), &then = then_[b];
    const double turning = std::max(0.0, (now.L - then.L).dot(now.w - then.w));
    Mechanism& of = mechanisms_[index(mechanism_[b])];
    of.taken += (body.mass * (now.rd - then.rd).squaredNorm() + turning) / kApart;
    if (!impulses_.empty()) {
      const Impulse J = std::exchange(impulses_[b], {});
      of.taken -= (J.force.dot(now.rd - then.rd) + J.moment.dot(now.w - then.w)) / kApart;
    }
    const Eigen::Index first = static_cast<Eigen::Index>(b) * per_body;
    of.kinetic += 0.5 * x.v.segment(first, per_body).dot(momentum_.segment(first, per_body));
    then_[b] = now;
  }
  for (Mechanism& of : mechanisms_) {
    of.most_kinetic = std::max(of.most_kinetic, of.kinetic);
    of.kinetic = 0;
  }
}

void NumericalDamping::say(const Run& run, double h) const {
  constexpr double kTold = 0.06;     // of the kinetic energy: 3 % of speeds
  constexpr double kKnown = 0.5;     // up to there a step to offer follows from what was lost
  constexpr double kFromRest = 2.5;  // steps: a constant force makes 2/n of that in n of them, with the motion it makes
  if (steps_ == 0) return;           // nor where nothing moves freely
  const auto share_of = [](const Mechanism& of) {
    return of.freedoms > 0 && of.most_kinetic > of.noise ? of.taken / of.most_kinetic : 0;
  };
  const Mechanism& of = *std::ranges::max_element(mechanisms_, {}, share_of);
  const double share = share_of(of);
  if (!(share > kTold + kFromRest / static_cast<double>(steps_))) return;
  // Less is taken of what is left, of the more the finer the motion is followed: a step is known where not much is
  // lost.
  const std::string enough =
      share < kKnown ? fmt::format("a step below {:.2g} s, rattle or error control take less than {:.0f} %",
                                   0.9 * h * kTold * std::pow(1 - share, 2) / share, 100 * kTold)
                     : "of so much it cannot be told which step would take little; rattle or error control do";
  const std::string whose = of_mechanism(run.problem.model(), mechanism_, static_cast<int>(&of - mechanisms_.data()));
  run.tell(fmt::format(
      "{} has taken some {:.3g} J or more out of the motion{} by itself, {:.3g} % of {} largest kinetic energy (what "
      "drivers put back included): it damps in proportion to the step; {}",
      run.settings.integrator, of.taken, whose, 100 * share, whose.empty() ? "the" : "its", enough));
}

}  // namespace poinsot
