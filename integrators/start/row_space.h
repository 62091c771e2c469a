// The gradients of constraint rows as vectors of unit length, whatever the units of the rows: what decides about rank.
//
// A body turns by an angle and moves by a length; its turn counts as what it moves at the body's size, the longest arm
// at which a row acts on it. In these coordinates a row of G has a length ‖g‖, and Φ/‖g‖ is the distance in metres that
// the bodies are off the constraint. A row is dependent where so little of its unit vector is left beside the others'
// as kDependent; it is as good as independent from kIndependent on. What lies between is said.
//
// A velocity row (pfaffian) that follows from positions is the one to be set aside, since it does not keep them: its
// vector is a kVelocityRow-th of the unit, so that its coefficients are larger than those of the others.
//
// Far from the origin points are known to the rounding of their coordinates only, and rows that follow from others do
// so up to kRoundings of that. Where it is more than kDependent of a body's size, vectors are as much shorter, down to
// a kFarthest-th of the unit; of farther bodies the user is told (far_bodies.h).
//
// In rA, whose variations are regular everywhere: rank does not depend on the formulation.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <span>
#include <vector>

#include "core/all_but.h"
#include "core/body_state.h"
#include "core/index.h"
#include "core/model.h"
#include "formulations/problem.h"
#include "linsolve/csc_layout.h"

namespace poinsot {

inline constexpr double kDependent = 1e-9, kIndependent = 1e-5;
inline constexpr double kVelocityRow = 32;
inline constexpr double kRoundings = 4, kFarthest = 10;

class RowSpace {
 public:
  // `rows` of the model, ascending. For a choice vectors of rows whose gradients are about to vanish are as much
  // shorter, down to a kVelocityRow-th, so that others are kept that say the same.
  enum class Use { rank, choice };
  RowSpace(std::shared_ptr<const Model> model, std::vector<int> rows, Use use = Use::rank);

  // At rest. The other two keep to the rounding of the coordinates here.
  void stand(double t, std::span<const BodyState> states);
  void stand_at(double t, std::span<const double> q);
  // distances() and rates() are then those there, by gradients of where it stands.
  void move(double t, std::span<const double> q);
  // Leaves these of its rows, ascending, as they stand: making another space of a large model takes as long as all that
  // it costs to carry the others along.
  void keep(std::vector<int> rows);

  const std::vector<int>& rows() const { return rows_; }
  const Problem& problem() const { return *problem_; }  // for its coordinates: those of intrinsic_formulation()
  // Gᵀ, a column of unit length for each row; 0 where the gradient is nothing but rounding.
  const Eigen::SparseMatrix<double>& columns() const { return Gt_; }
  // ‖g‖ by row, times kVelocityRow, and as far away as above; of a row that vanishes, that of its terms.
  std::span<const double> lengths() const { return lengths_; }
  // What is left of the gradient of a row that can vanish, where it stands: 1 is as much as ever.
  double left_of(std::size_t k) const;
  bool is_velocity_row(std::size_t k) const { return model_->rows[index(rows_[k])].type == RowType::pfaffian; }
  // ‖g‖ of a row that can vanish, where it does not, about; else 0.
  double full_norm(std::size_t k) const;
  // Φ/‖g‖, m.
  void distances(std::span<double> out) const;
  // G v − ν and ν in the rows' own units, where it stands, with velocities v of intrinsic_formulation().
  void rates(std::span<const double> v, std::span<double> residual, std::span<double> nu);
  double norm_of_row(std::size_t k) const { return lengths_[k] / (weights_[k] * vanishing_[k]); }
  double size_of_body(int body) const { return sizes_[index(body)]; }  // m
  // m: of the larger of its bodies; and what a gap is small beside.
  double size_of_row(std::size_t k) const { return largest_of_row(k, sizes_); }
  double own_size_of_row(std::size_t k) const { return largest_of_row(k, own_sizes_); }

 private:
  double direction_terms(const Row& row) const;
  double largest_of_row(std::size_t k, const std::vector<double>& sizes) const;
  void take_places(std::span<double> out) const;
  double rounding_of(std::size_t k) const;
  double weight_of(std::size_t k, std::span<const BodyState> states) const;

  std::shared_ptr<const Model> model_;
  std::vector<int> rows_;
  Use use_;
  std::unique_ptr<Problem> problem_;
  std::vector<int> place_;  // by row: among those of the problem
  std::vector<double> sizes_, own_sizes_;
  std::vector<double> q_, v_, values_, lengths_, weights_;
  std::vector<double> vanishing_;  // by row: more than 1 where its gradient is about to vanish
  mutable std::vector<double> of_problem_;
  CscLayout layout_;
  // By entry of Gt_: its place in the layout, and one over the body's size where it is about a turn, else 1.
  std::vector<int> source_;
  std::vector<double> measure_;
  std::vector<double> rounding_;  // of rows of directions
  std::vector<BodyState> at_;     // where there are distances
  Eigen::SparseMatrix<double> Gt_;
};

}  // namespace poinsot
