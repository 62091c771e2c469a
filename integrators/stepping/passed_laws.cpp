#include "integrators/stepping/passed_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace poinsot {

PassedLaws::PassedLaws(const Model& model, double end, double rtol, double atol, Tell tell)
    : model_(model), end_(end), rtol_(rtol), atol_(atol), tell_(std::move(tell)) {
  for (const SpringLaw& of : spring_laws(model)) laws_.push_back({of, {}, {}, {}});
  if (!laws_.empty()) bodies_.resize(model.bodies.size());
}

void PassedLaws::look(const Problem& problem, const State& at) {
  problem.to_bodies(at.a(), bodies_);
  for (Law& law : laws_) law.to = law.of.place(model_, problem, bodies_);
}

void PassedLaws::begin(const Problem& problem, const State& from) {
  if (laws_.empty()) return;
  look(problem, from);
  for (Law& law : laws_) law.from = law.to;
  t_ = from.t;
}

double PassedLaws::reach(const Problem& problem, const State& to) {
  if (laws_.empty()) return to.t;
  look(problem, to);
  double reach = to.t;
  for (Law& law : laws_) {
    reach = std::min(reach, cut(law, LawPath(law.of, law.from, law.to, t_, to.t), t_, to.t));
  }
  if (reach < to.t) {
    leave_unknown(reach);
    return reach;
  }
  for (Law& law : laws_) law.before = std::exchange(law.from, law.to);
  before_ = std::exchange(t_, to.t);
  return reach;
}

void PassedLaws::take_back() {
  for (Law& law : laws_) law.from = law.before;
  t_ = before_;
}

double PassedLaws::ahead(double to) {
  double reach = to;
  for (Law& law : laws_) reach = std::min(reach, cut(law, LawPath(law.of, law.from, t_, to), t_, to));
  if (reach < to) leave_unknown(reach);
  return reach;
}

double PassedLaws::cut(Law& law, const LawPath& path, double from, double to) const {
  const double h = to - from, before = path.force(0), after = path.force(1);
  law.largest = std::max({law.largest, std::abs(before), std::abs(after)});
  if (h <= kResolved * end_) return to;
  const double nothing = kUnseen * std::max(rtol_ * law.largest, atol_ * law.of.inertia / h);
  const UnseenForce first = first_unseen(path, {std::min(before, after), std::max(before, after)}, nothing);
  if (!(first.s < 1)) return to;
  law.unknown = first.known ? 0 : law.unknown + 1;
  return from + h * (first.known || first.s > kPart ? first.s : 0.5);
}

// Arithmetic on intervals may not say what a law comes to, or no more than bounds far from the truth.
void PassedLaws::leave_unknown(double t) {
  std::erase_if(laws_, [&](const Law& law) {
    if (law.unknown < kMostUnknown) return false;
    tell_(
        fmt::format("from t = {:.6g} s on '{}' is not watched for what it does within less than a step, since it has "
                    "no close bounds there",
                    t, law.of.F->text()));
    return true;
  });
}

}  // namespace poinsot
