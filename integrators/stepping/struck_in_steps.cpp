#include "integrators/stepping/struck_in_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/stepping/vectors.h"

namespace poinsot {

StruckInSteps::StruckInSteps(const Model& model, Tell tell) : model_(model), tell_(std::move(tell)) {
  for (const SpringLaw& of : spring_laws(model)) laws_.push_back({of});
  if (!laws_.empty()) bodies_.resize(model.bodies.size());
  before_.resize(laws_.size());
}

bool StruckInSteps::due(const Eigen::VectorXd& v, const Eigen::VectorXd& v_n) {
  const auto per_body = v.size() / static_cast<Eigen::Index>(bodies_.size());
  for (Eigen::Index b = 0; b < v.size(); b += per_body) {
    for (const auto& [first, count] : {std::pair<Eigen::Index, Eigen::Index>{0, 3}, {3, per_body - 3}}) {
      const auto now = v.segment(b + first, count), then = v_n.segment(b + first, count);
      const double size = std::max(now.squaredNorm(), then.squaredNorm());
      if ((now - then).squaredNorm() > kStruck * kStruck * size) return true;
    }
  }
  return false;
}

StruckInSteps::End StruckInSteps::end(const Law& law, const Problem& problem, double t) const {
  const LawPlace place = law.of.place(model_, problem, bodies_);
  return {law.of.arguments(place, t), place.rate.norm()};
}

void StruckInSteps::look(Problem& problem, const State& at, const Eigen::VectorXd& q_n, const Eigen::VectorXd& v_n,
                         double h) {
  constexpr double kResolved = 0.1;  // h w
  problem.set_position(at.t - h, span(q_n));
  problem.set_velocity(span(v_n));
  problem.to_bodies(at.a(), bodies_);
  for (std::size_t k = 0; k < laws_.size(); ++k) before_[k] = end(laws_[k], problem, at.t - h);
  problem.set_position(at.t, span(at.q));
  problem.set_velocity(span(at.v));
  problem.to_bodies(at.a(), bodies_);
  for (std::size_t k = 0; k < laws_.size();) {
    Law& law = laws_[k];
    const End after = end(law, problem, at.t);
    law.fastest = std::max({law.fastest, after.rate, before_[k].rate});
    const auto force = [&](const End& end) {  // friction turns round with the rate, and makes no energy; nor does time
      return law.of.F->law(Arguments<double>{before_[k].at.t, end.at.x, before_[k].at.v}).F;
    };
    const double change = std::abs(force(after) - force(before_[k]));
    const double struck = h * change / (law.of.inertia * law.fastest);
    if (!(struck > kStruck)) {
      ++k;
      continue;
    }
    tell_(fmt::format(
        "at t = {:.6g} s {} changes by {:.3g} {} within a step of {:g} s, which is {:.2g} of what stops its lighter "
        "body: what it gives back is made by the step, and energy with it; take a step of at most {:.1g} s, or an "
        "integrator with error control",
        at.t, law.of.called(model_), change, law.of.unit(), h, struck, kResolved * h / std::sqrt(struck)));
    laws_.erase(laws_.begin() + static_cast<std::ptrdiff_t>(k));
    before_.erase(before_.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

}  // namespace poinsot
