// The law of a spring as the terms of its sum (core/expression_terms.h), each as the law of a spring by itself: what is
// narrow in one is not hidden by what varies far more beside it.
#pragma once

#include <vector>

#include "integrators/stepping/law_path.h"

namespace poinsot {

class LawTerms {
 public:
  explicit LawTerms(const SpringLaw& of) : terms_(of.F ? of.F->terms() : std::vector<Expression>()) {
    for (const Expression& term : terms_) {
      laws_.push_back(of);
      laws_.back().F = &term;
    }
  }
  LawTerms(LawTerms&&) = default;  // and no copies: laws point to their terms
  LawTerms& operator=(LawTerms&&) = default;

  const std::vector<SpringLaw>& laws() const { return laws_; }

 private:
  std::vector<Expression> terms_;
  std::vector<SpringLaw> laws_;
};

}  // namespace poinsot
