// What of the law of a spring is to be looked at: the whole, and what that hides, each as the law of a spring by
// itself. What is narrow in a term shows little in a whole that varies far more beside it (Expression::hidden_terms()),
// and what is narrow in v does not where v stays what it is in the middle of a step.
#pragma once

#include <vector>

#include "integrators/stepping/law_path.h"

namespace poinsot {

class LawTerms {
 public:
  struct Part {
    SpringLaw law;
    bool whole;  // else steps are cut for what is known of it alone
    bool steep;  // it is looked at whether steps see how it turns over
  };

  explicit LawTerms(const SpringLaw& of) : terms_(of.F ? of.F->hidden_terms() : std::vector<Expression>()) {
    if (!of.F) return;
    parts_.push_back({of, true, true});
    if (terms_.empty() && by_rate(*of.F)) parts_.push_back({of, false, false});
    for (const Expression& term : terms_) {
      parts_.push_back({of, false, &term == &terms_.front()});
      parts_.back().law.F = &term;
    }
    for (Part& part : parts_) part.law.by_rate = !part.whole && by_rate(*part.law.F);
  }
  LawTerms(LawTerms&&) = default;  // and no copies: laws point to their terms
  LawTerms& operator=(LawTerms&&) = default;

  const std::vector<Part>& parts() const { return parts_; }

 private:
  static bool by_rate(const Expression& F) { return F.depends_on_rate() && !F.depends_on_elongation(); }

  std::vector<Expression> terms_;
  std::vector<Part> parts_;
};

}  // namespace poinsot
