// Redundant rows on the way: which to set aside now, chosen for each loop by itself (block_choice.h), and what the
// others' multipliers leave open.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "integrators/start/block_choice.h"
#include "integrators/start/row_space.h"
#include "linsolve/separation.h"

namespace poinsot {

class RowChoice {
 public:
  // `rows`: those of loops (loop_rows.h); `aside`: rows of the model among them without which they are independent.
  RowChoice(std::shared_ptr<const Model> model, std::vector<int> rows, std::vector<int> aside,
            Steps steps = Steps::fixed);

  const std::vector<int>& aside() const { return aside_; }
  const RowSpace& space() const { return space_; }  // of its rows, where they were last looked at
  void look(double t, std::span<const BodyState> states);
  bool worn() const;  // where it was last looked at
  // Chooses anew where the present choice has worn out, or will within the next step: true where other rows are set
  // aside now. Bodies have turned by `turned` since it was looked at, and will by `ahead` in that step.
  // `asked`: as rows kept have turned out to depend on one another there; the best choice is wanted.
  bool renew(double t, std::span<const BodyState> states, double turned, double ahead, bool asked = false);
  // Of the choice where it was last looked at, rad: what bodies may turn by until it is to be looked at again.
  double good_for() const { return good_for_; }
  // After renew() has chosen others: λ, by row of the model, of rows kept before ← that of those kept now, which are
  // the same forces.
  void carry_over(std::span<double> lambda);
  // What Φ of a row is where the bodies are off it by their own size, at the position last looked at.
  double size_of(int row) const;
  double own_size_of(int row) const { return space_.own_size_of_row(place_of(row)); }  // m
  double size_of_body(int body) const { return space_.size_of_body(body); }            // m
  // Whether there are null vectors for all rows set aside: no loops hang together that have more than
  // BlockChoice::kMostNull of them.
  bool has_null_vectors() const;
  // Those with a row in a loop, or in loops that hang together, that has redundant ones; ascending.
  std::vector<int> groups_of_redundant_loops(const Model& model) const;
  // Null vectors of Gᵀ by row of the model: one for each row set aside, but for loops that have none, and where the
  // kept rows are not independent or those set aside no combinations of them.
  std::vector<SparseEntries> null_vectors(double t, std::span<const BodyState> states);

 private:
  void take_good_for();
  std::size_t place_of(int row) const;  // in the space

  RowSpace space_;
  std::vector<int> aside_;
  std::vector<BlockChoice> blocks_;  // those with redundant rows
  std::vector<char> renewed_;        // by block, the last time
  double good_for_ = 0;
};

}  // namespace poinsot
