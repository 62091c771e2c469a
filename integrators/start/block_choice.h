// Of the redundant rows of one loop, or of loops that hang together (row_blocks.h): which to set aside now, and what
// the others' multipliers leave open.
//
// With the rows G_K kept, a row set aside is g_d = Σ c_k g_k, on unit vectors. No |c_k| much above 1 means that the
// kept rows are nearly as independent as any choice could be; as the mechanism turns the coefficients grow, and a kept
// row whose coefficient has become large takes the place of the one set aside. Rows set aside are those of few joints
// where that keeps the coefficients small (linsolve/separation.h): a loop that is held by few rows at one of its joints
// is eliminated by small fronts, and such a choice wears out late.
//
// A step may turn bodies by as much as wears a choice out. Its stages on rows that are hardly independent any more have
// larger errors, and may be rejected for them: such a choice is worn out before that step.
//
//   c = argmin ‖G_Kᵀ c − g_d‖,   (G_K G_Kᵀ) c = G_K g_d, refined once
//
// e_d − Σ c_k e_k is a null vector of Gᵀ: reactions that balance one another.
//
// Time grows with the number of rows for each row set aside. Of many rows the coefficients are found one by one only
// where the sums Σ_d ± c_kd, for some vectors of random signs, say that there are large ones; where too many are set
// aside, never: then rows are chosen anew as a whole, those that are clearest (linsolve/front_qr.h), and their
// null vectors are not known.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "integrators/start/block_rows.h"
#include "integrators/start/row_space.h"
#include "integrators/start/small_coefficients.h"
#include "integrators/start/sparse_coefficients.h"
#include "linsolve/separation.h"

namespace poinsot {

// Who goes along the motion: error control sees more of a worn choice, and kinematics leaves rows off by a tolerance.
enum class Steps { fixed, error_controlled, of_kinematics };

class BlockChoice {
 public:
  static constexpr std::size_t kMost = 1000;     // rows set aside that have coefficients
  static constexpr std::size_t kMostNull = 200;  // and whose null vectors are found, at every output time

  // `rows`: places in `space`; `aside`: rows of the model among them without which they are independent;
  // `turns`: of the groups (grouped_rows.h).
  BlockChoice(const Model& model, const RowSpace& space, std::vector<int> rows, const std::vector<int>& aside,
              std::span<const int> turns, Steps steps);

  // Each where `space` stands. look() judges the choice.
  void look(const RowSpace& space);
  bool worn() const { return worst_ > worn_; }
  // Chooses anew where the present choice has worn out, or will within the next step: true where other rows are set
  // aside now. Bodies have turned by `turned` since it was looked at, and will by `ahead` in that step.
  // `asked`: as rows kept have turned out to depend on one another here; the best choice is wanted.
  bool renew(const RowSpace& space, double turned, double ahead, bool asked);
  // Where it was last looked at, rad: what bodies may turn by until it is to be looked at again.
  double good_for() const { return good_for_; }
  void add_aside(const RowSpace& space, std::vector<int>& rows) const;
  // Calls function(row) for each of the block's rows, the model's numbers.
  template <typename Function>
  void for_each_row(const RowSpace& space, Function&& function) const {
    for (int k = 0; k < static_cast<int>(rows_.size()); ++k) function(row_of(space, k));
  }
  // After renew() has chosen others. λ, by row of the model: of rows kept before ← that of those kept now, which are
  // the same forces.
  void carry_over(const RowSpace& space, std::span<double> lambda);
  // Whether there are few enough rows for null vectors.
  bool has_null_vectors() const;
  // Null vectors of Gᵀ by row of the model are added: one for each row set aside, or none; none, too, where one of them
  // leaves a body out of balance.
  void add_null_vectors(const RowSpace& space, std::vector<SparseEntries>& vectors);

 private:
  int row_of(const RowSpace& space, int k) const;  // of the model
  bool small() const;
  bool has_coefficients() const;
  double least_pivot() const;
  bool clear();
  double worst();
  double turn_until_worst(double rate) const;
  double turn_until_worn() const;
  bool find_small(int refinements);
  Eigen::VectorXd small_shares(const Eigen::VectorXd& f, const Eigen::VectorXd& forces);
  void keep_others(const std::vector<int>& left_out);
  bool trusted(const std::vector<SparseEntries>& vectors) const;
  bool exchange(const RowSpace& space, double most, double limit, bool asked);
  bool choose_clearest(const RowSpace& space);
  bool take(const std::vector<int>& chosen, double limit);
  std::vector<SparseEntries> unit_null_vectors(int refinements) const;
  bool balances(const SparseEntries& z) const;
  double left_by(const SparseEntries& z) const;

  BlockRows rows_;  // all that follow by their places here
  bool watched_;
  Steps steps_;
  Grouped grouped_;
  std::vector<int> kept_, left_out_;
  SmallCoefficients small_;
  std::unique_ptr<SparseCoefficients> sparse_;  // of blocks that are not small
  Eigen::MatrixXd C_;                           // of blocks that are, kept × left out
  std::optional<bool> judged_;  // kept rows were clear where first looked at, and are asked whether they are
  double worst_ = 0;            // the largest coefficient where last looked at, or what stands for it
  double worn_;                 // from here on a choice is worn out
  double given_ = 0;            // what it is allowed to be, where others were no better
  double good_for_ = 0;
  double change_ = 1;     // of the angle of the largest coefficient, by a turn, at the last look
  double fastest_ = 0.3;  // that the angle of the largest coefficient has changed by a turn; to begin with a guess
};

}  // namespace poinsot
