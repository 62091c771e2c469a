// Whether a mechanism has come from one branch of its positions to another between two of them, from the constraints'
// gradients alone.
//
// Along a branch the rows of G, with a frame of the directions they leave free that is carried along, keep their
// orientation. A step that goes straight on, where two branches come close to one another, from one to the other
// reverses it: free directions have hardly turned, and one combination of the rows points the other way. Of two
// positions whose free directions are less than a right angle apart it is kept where, for any weights W,
//   det(G₁ W G₀ᵀ) > 0.
// It is reversed as well where branches meet and the motion goes straight on, as it should; and where rows turn by more
// than a right angle it says nothing, nor of rows for which others stand in.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "formulations/problem.h"

namespace poinsot {

class BranchSide {
 public:
  explicit BranchSide(const Problem& problem);  // with the rows and coordinates of that; allocates

  // Rows or coordinates become others: the next position is compared with none.
  void forget() { known_ = false; }
  // Where the problem stands, after the last position: whether the orientation is reversed. Not looked at unless
  // `near`: G may be singular somewhere between.
  bool reversed(Problem& problem, bool near);

 private:
  std::vector<int> slots_;
  Eigen::MatrixXd G_, before_;  // before_: G₀ W
  Eigen::VectorXd weights_;
  Eigen::MatrixXd square_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  bool known_ = false;
};

}  // namespace poinsot
