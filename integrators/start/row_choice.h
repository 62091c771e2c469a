// Redundant rows on the way: which to set aside now, and what the others' multipliers leave open.
//
// With the rows G_K kept, a row set aside is g_d = Σ c_k g_k, on unit vectors. No |c_k| much above 1 means that the
// kept rows are nearly as independent as any choice could be; as the mechanism turns the coefficients grow, and a kept
// row whose coefficient has become large takes the place of the one set aside. Rows set aside are those of few joints
// where that keeps the coefficients small (linsolve/separation.h): a loop that is held by few rows at one of its joints
// is eliminated by small fronts, and such a choice wears out late.
//
//   c = argmin ‖G_Kᵀ c − g_d‖,   (G_K G_Kᵀ) c = G_K g_d, refined once
//
// e_d − Σ c_k e_k is a null vector of Gᵀ: reactions that balance one another. Time grows with the number of rows for
// each row set aside; beyond kMost of these the choice is left as it is.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "integrators/start/row_space.h"
#include "linsolve/separation.h"

namespace poinsot {

class RowChoice {
 public:
  static constexpr std::size_t kMost = 200;

  // `rows`: those of loops (loop_rows.h); `aside`: rows of the model among them without which they are independent.
  RowChoice(std::shared_ptr<const Model> model, std::vector<int> rows, std::vector<int> aside);

  const std::vector<int>& aside() const { return aside_; }
  void look(double t, std::span<const BodyState> states);
  // Chooses anew where the present choice has worn out: true where other rows are set aside now.
  bool renew(double t, std::span<const BodyState> states);
  // Of the choice where it was last looked at, rad: what bodies may turn by until it is to be looked at again.
  double good_for() const { return good_for_; }
  // After renew() has chosen others: λ, by row of the model, of rows kept before ← that of those kept now, which are
  // the same forces.
  void carry_over(std::span<double> lambda) const;
  // What Φ of a row is where the bodies are off it by their own size, at the position last looked at.
  double size_of(int row) const;
  // Null vectors of Gᵀ by row of the model: one for each row set aside. Empty beyond kMost and where the
  // kept rows are not independent.
  std::vector<SparseEntries> null_vectors(double t, std::span<const BodyState> states);

 private:
  // C_ for the rows kept where the bodies are; false, and 0, beyond kMost and where these are not independent.
  bool find_coefficients();
  bool dense() const;
  bool find_dense();
  bool find_sparse();
  void refine();
  void take_parts();
  double dot(int k, int l) const;
  void find_beside(const Model& model);
  void sort_rows();
  void weigh();
  std::vector<SparseEntries> unit_null_vectors() const;

  struct Parts {
    int body[2];  // −1: the ground
    Eigen::Matrix<double, 6, 1> part[2];
  };

  RowSpace space_;
  std::vector<int> aside_;
  std::vector<int> group_;                // by row of space_
  std::vector<std::vector<int>> beside_;  // by row of space_, where full matrices are used: rows that share a body
  std::vector<int> place_;                // by row of space_: among those kept, −1 where it is not
  std::vector<int> kept_, left_out_;      // of space_
  Eigen::MatrixXd gram_, C_;              // the lower triangle's Cholesky factor; coefficients, kept × left out
  std::vector<Parts> parts_;              // by row of space_
  double worst_ = 0, good_for_ = 0;       // the largest coefficient where last looked at
};

}  // namespace poinsot
