// Puts a mechanism onto those of its constraint rows that are kept, by the shortest ways: of bodies of unit mass that
// turn as hard as they move, for which a turn counts as what it moves at the body's size.
//
//   position: δq = −G⁺Φ repeated;   velocity: δv = G⁺(ν − G v);   a move along the constraints: δq − G⁺G δq
//
// Coordinates are those of intrinsic_formulation(): moves and velocities have six numbers for each body.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/model.h"
#include "integrators/start/row_space.h"
#include "linsolve/front_qr.h"

namespace poinsot {

class OntoRows {
 public:
  // `without`: rows of the model. `sizes`: of bodies, m.
  OntoRows(RowSpace& space, std::vector<int> without, std::span<const double> sizes);
  virtual ~OntoRows() = default;

  // False where it cannot. After the first time what served before leads on.
  virtual bool position(double t, std::span<double> q) = 0;
  // q: where the mechanism was put last.
  virtual bool velocity(double t, std::span<const double> q, std::span<double> v) = 0;
  // Each row of moves, six numbers for each body, ← what the constraints leave free of it where the mechanism was put
  // last and the space stands.
  virtual bool leave_free(double t, Eigen::MatrixXd& moves) = 0;

  const std::vector<int>& without() const { return without_; }
  // Whether the rows left out are combinations of those kept there. No decomposition is needed for that.
  bool all_follow(double t);

 protected:
  double scaled(Eigen::Index j) const { return j % 6 < 3 ? 1 : sizes_[index(j / 6)]; }

  RowSpace& space_;
  std::vector<int> without_;
  std::span<const double> sizes_;

 private:
  // leave_free() as exactly as it can be had; false where it was.
  virtual bool be_exact(double) { return false; }
  bool sums_follow(double t);
};

// By the equations of motion of `unit` without these rows.
std::unique_ptr<OntoRows> onto_rows_by_motion(const std::shared_ptr<const Model>& unit, RowSpace& space,
                                              std::vector<int> without, std::span<const double> sizes);

// By a decomposition of the space's columns where it stands, without those that are dependent: onto the rows of the
// space alone, no farther than that leads, and with far less memory and time.
std::unique_ptr<OntoRows> onto_rows_by_decomposition(std::shared_ptr<FrontQr> decomposition, RowSpace& space,
                                                     std::span<const double> sizes);

}  // namespace poinsot
