// Laws of springs over the steps of a run under error control, those of linear ones that push or pull without length
// included: where the ends of each spring stand at either end of a step, and how they go in between.
#pragma once

#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/state.h"
#include "integrators/stepping/law_path.h"

namespace poinsot {

class LawSteps {
 public:
  struct Law {
    SpringLaw of;
    LawPlace before, from, to;
  };

  // Of a model that has to live as long.
  explicit LawSteps(const Model& model);

  bool none() const { return laws_.empty(); }
  std::size_t size() const { return laws_.size(); }
  const Law& law(std::size_t k) const { return laws_[k]; }
  // The problem stands at `from`, where a step begins.
  void begin(const Problem& problem, const State& from);
  // The problem stands at `to`, where the step that began there ends.
  void look(const Problem& problem, const State& to);
  void accept();     // that step: the next one begins where it ends
  void take_back();  // the step that was accepted

  double from() const { return from_; }  // s, of the step
  double to() const { return to_; }
  // The way of a law over the step looked at, or of one of its terms, and as the motion goes on from its beginning up
  // to a time.
  LawPath path(std::size_t k) const { return path(k, laws_[k].of); }
  LawPath path(std::size_t k, const SpringLaw& term) const { return {term, laws_[k].from, laws_[k].to, from_, to_}; }
  LawPath ahead(std::size_t k, double to) const { return ahead(k, laws_[k].of, to); }
  LawPath ahead(std::size_t k, const SpringLaw& term, double to) const { return {term, laws_[k].from, from_, to}; }

 private:
  const Model& model_;
  std::vector<Law> laws_;
  std::vector<BodyState> bodies_;
  double before_ = 0, from_ = 0, to_ = 0;
};

}  // namespace poinsot
