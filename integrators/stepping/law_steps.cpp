#include "integrators/stepping/law_steps.h"

#include <utility>

namespace poinsot {

LawSteps::LawSteps(const Model& model) : model_(model) {
  for (const SpringLaw& of : spring_laws(model)) laws_.push_back({of, {}, {}, {}});
  for (const SpringLaw& of : springs_that_turn_round(model)) laws_.push_back({of, {}, {}, {}});
  if (!laws_.empty()) bodies_.resize(model.bodies.size());
}

void LawSteps::begin(const Problem& problem, const State& from) {
  if (none()) return;
  look(problem, from);
  for (Law& law : laws_) law.from = law.to;
  from_ = to_;
}

void LawSteps::look(const Problem& problem, const State& to) {
  problem.to_bodies(to.a(), bodies_);
  for (Law& law : laws_) law.to = law.of.place(model_, problem, bodies_);
  to_ = to.t;
}

void LawSteps::accept() {
  for (Law& law : laws_) law.before = std::exchange(law.from, law.to);
  before_ = std::exchange(from_, to_);
}

void LawSteps::take_back() {
  for (Law& law : laws_) law.from = law.before;
  from_ = before_;
}

}  // namespace poinsot
