#include "integrators/stepping/law_jumps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "core/index.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/sticking.h"

namespace poinsot {

LawJumps::LawJumps(const Model& model) : springs_(springs_that_may_turn_round(model)) {
  for (const SpringLaw& law : spring_laws(model)) {
    std::size_t jumps = 0;
    for (int k = 0; k < law.F->switch_count(); ++k) jumps += law.F->switch_jumps(k) ? 1 : 0;
    if (jumps == 0) continue;
    laws_.push_back(law);
    switches_.resize(std::max(switches_.size(), index(law.F->switch_count())));
    size_ += jumps;
  }
  if (!laws_.empty()) bodies_.resize(model.bodies.size());
}

void LawJumps::look(const Problem& problem, const State& at, Sides& sides) {
  if (none()) return;
  problem.to_bodies(at.a(), bodies_);
  auto side = sides.of.begin();
  auto arguments = sides.at.begin();
  for (const SpringLaw& law : laws_) {
    const std::span<double> switches(switches_.data(), index(law.F->switch_count()));
    *arguments = law.arguments(law.place(problem.model(), problem, bodies_), at.t);
    law.F->switches(*arguments++, switches);
    for (int k = 0; k < law.F->switch_count(); ++k)
      if (law.F->switch_jumps(k)) *side++ = switches[index(k)];
  }
}

const SpringLaw* LawJumps::crossed(const Sides& before, const Sides& after) {
  std::size_t side = 0;
  for (std::size_t k = 0; k < laws_.size(); ++k) {
    const Expression& F = *laws_[k].F;
    for (int j = 0; j < F.switch_count(); ++j) {
      if (!F.switch_jumps(j)) continue;
      if (before.of[side] * after.of[side] < 0 && jumps_between(F, j, before.at[k], after.at[k])) return &laws_[k];
      ++side;
    }
  }
  return nullptr;
}

// F jumps where the switch k changes its sign on the straight way from one to the other.
bool LawJumps::jumps_between(const Expression& F, int k, Arguments<double> from, Arguments<double> to) {
  constexpr int kHalvings = 60;
  constexpr double kJump = 1e-6;  // of F
  const std::span<double> switches(switches_.data(), index(F.switch_count()));
  const auto side = [&](const Arguments<double>& at) {
    F.switches(at, switches);
    return switches[index(k)] > 0;
  };
  const auto between = [](double a, double b) { return a + 0.5 * (b - a); };
  const bool one = side(from);
  double most = std::max(std::abs(F.law(from).F), std::abs(F.law(to).F));
  for (int j = 0; j < kHalvings; ++j) {
    const Arguments<double> middle{between(from.t, to.t), between(from.x, to.x), between(from.v, to.v)};
    (side(middle) == one ? from : to) = middle;
  }
  const double before = F.law(from).F, after = F.law(to).F;
  most = std::max({most, std::abs(before), std::abs(after)});
  return !(std::abs(after - before) <= kJump * most);
}

std::vector<Vector3> LawJumps::stretches(const Problem& problem, const State& at) const {
  std::vector<BodyState> bodies(problem.model().bodies.size());
  problem.to_bodies(at.a(), bodies);
  std::vector<Vector3> stretches;
  for (const SpringLaw& spring : springs_) stretches.push_back(spring.place(problem.model(), problem, bodies).d);
  return stretches;
}

bool LawJumps::turned_round(const std::vector<Vector3>& before, const std::vector<Vector3>& after, double t) const {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const double length = std::max(before[k].norm(), after[k].norm());
    if (before[k].dot(after[k]) < 0 && springs_[k].turning(length, t) != 0) return true;
  }
  return false;
}

bool comes_to_jump(LawJumps& jumps, const Problem& problem, const LinearChoice& choice, const State& from, double t) {
  const double h = t - from.t;
  if (!sticking_law(problem, choice, from, h).empty() || !resting_law(problem, choice, from, h).empty()) return false;
  const std::unique_ptr<Problem> own = problem.clone();
  Consistent consistent(*own, choice);
  State ahead = from;
  consistent.stand(ahead);
  if (!consistent.accelerations(ahead).ok()) return false;
  LawJumps::Sides before = jumps.sides(), after = before;
  jumps.look(*own, ahead, before);
  const std::vector<Vector3> stretched = jumps.stretches(*own, ahead);
  consistent.lead(ahead, t + h);
  consistent.stand(ahead);
  jumps.look(*own, ahead, after);
  return jumps.crossed(before, after) || jumps.turned_round(stretched, jumps.stretches(*own, ahead), t);
}

Status lead_on(const Problem& problem, const LinearChoice& choice, State& x, double t) {
  const std::unique_ptr<Problem> own = problem.clone();
  Consistent consistent(*own, choice);
  consistent.stand(x);
  if (Status status = consistent.accelerations(x); !status.ok()) return status;
  return consistent.cross(x, t);
}

}  // namespace poinsot
