// Redundant rows on the way: which to set aside now, and what the others' multipliers leave open.
//
// With the rows G_K kept, a row set aside is g_d = Σ c_k g_k, on unit vectors. No |c_k| much above 1 means that the
// kept rows are nearly as independent as any choice could be; as the mechanism turns the coefficients grow, and a kept
// row whose coefficient has become large takes the place of the one set aside.
//
//   c = argmin ‖G_Kᵀ c − g_d‖,   (G_K G_Kᵀ) c = G_K g_d, refined once
//
// e_d − Σ c_k e_k is a null vector of Gᵀ: reactions that balance one another. Time grows with the number of rows for
// each row set aside; beyond kMost of these the choice is left as it is.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "integrators/start/row_space.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {

class RowChoice {
 public:
  static constexpr std::size_t kMost = 200;

  // `rows`: those of loops (loop_rows.h); `aside`: rows of the model among them without which they are independent.
  RowChoice(std::shared_ptr<const Model> model, std::vector<int> rows, std::vector<int> aside);

  const std::vector<int>& aside() const { return aside_; }
  void look(double t, std::span<const BodyState> states) { space_.stand(t, states); }
  // Chooses anew where the present choice has worn out: true where other rows are set aside now.
  bool renew(double t, std::span<const BodyState> states);
  // What Φ of a row is where the bodies are off it by their own size, at the position last looked at.
  double size_of(int row) const;
  // Null vectors of Gᵀ by row of the model: one for each row set aside. Empty beyond kMost and where the
  // kept rows are not independent.
  std::vector<SparseEntries> null_vectors(double t, std::span<const BodyState> states);

 private:
  std::vector<SparseEntries> unit_null_vectors(double t, std::span<const BodyState> states);

  RowSpace space_;
  std::vector<int> aside_;
};

}  // namespace poinsot
