// A factorization whose pivots are chosen anew: by which units of rows, what its solutions are worth, and which pivots
// are to blame where they are worth little.
//
// What an order of elimination takes for granted is checked by numbers here: sizes without cancellation
// (cancellation.h), Bauer's condition (condition.h), and residuals of solves.
#pragma once

#include <span>
#include <vector>

#include "linsolve/block/factor.h"
#include "linsolve/block/refinement.h"
#include "linsolve/block/schedule.h"
#include "linsolve/csc_layout.h"

namespace poinsot::block {

// What pivots are worth.
enum class Pivots {
  good,
  doubtful,  // solutions are good once they are refined, but some pivots are mostly rounding
  bad,       // or some are nothing else
};

// Which of the solutions with pivots near these are to be looked at.
enum class LookAt { none, some, all };

class FreshFactors {
 public:
  // All have to live as long. Pivots are chosen in the units `first` of rows, where those do not serve in those of the
  // equilibrated matrix, and then in those the condition estimate finds. Residuals up to `good` are not refined.
  FreshFactors(const CscLayout& layout, std::span<const double> values, Factor& factor, Refinement& refinement,
               std::span<const double> first, double good)
      : layout_(layout), values_(values), factor_(factor), refinement_(refinement), first_(first), good_(good) {}

  // Factorizes in an order.
  Pivots factor(const Schedule& schedule);
  // Does so without looking at single pivots: whether solutions are good once they are refined.
  bool trustworthy(const Schedule& schedule);

  // Of the last factorization: places of the pivots that may be why it is not to be trusted, ascending.
  const std::vector<int>& bad() const { return bad_; }
  LookAt look_at() const { return look_at_; }
  double reciprocal_condition() const { return reciprocal_condition_; }

 private:
  const CscLayout& layout_;
  const std::span<const double> values_;
  Factor& factor_;
  Refinement& refinement_;
  const std::span<const double> first_;
  const double good_;
  std::vector<double> weight_;  // the units of rows that were chosen
  std::vector<int> bad_;
  LookAt look_at_ = LookAt::none;
  double reciprocal_condition_ = 0;
};

}  // namespace poinsot::block
