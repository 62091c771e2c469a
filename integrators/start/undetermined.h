// Which reactions redundant rows leave undetermined.
//
// A null vector z of Gᵀ is a combination of multipliers that moves nothing: any multiple of it can be added to λ. Where
// it loads a joint, that is where what its rows of the joint do to a body does not add up to nothing, the joint's
// reaction is one of many; of its components (kReactionComponents) those that the load has. The others are unique.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/start/row_space.h"
#include "linsolve/separation.h"

namespace poinsot {

// A group of the model whose reaction is undetermined.
struct Undetermined {
  int group;
  std::array<bool, 6> loaded{};  // by kReactionComponents, where the mechanism stands

  // Those loaded; of a constraint, which has a multiplier alone, none.
  std::vector<std::string> components(const Model& model) const;
};

class LoadedGroups {
 public:
  // `space`: of rows of the model; the states are those of its bodies.
  LoadedGroups(const Model& model, const RowSpace& space, std::span<const BodyState> states);

  // `columns`: unit rows in the order of those of the space; z: on these, ascending.
  void add(const Eigen::SparseMatrix<double>& columns, const SparseEntries& z);
  void add_all();                           // whatever may load which
  std::vector<Undetermined> found() const;  // by group

 private:
  const Row& row(int column) const { return model_.rows[index(space_.rows()[index(column)])]; }

  const Model& model_;
  const RowSpace& space_;
  std::span<const BodyState> states_;
  std::vector<Undetermined> of_groups_;
  std::vector<char> any_;  // by group
};

// Of null vectors of Gᵀ by row of the model (RowChoice), where the space and the bodies stand; `all`: there are others
// that are not known.
std::vector<Undetermined> undetermined_by(const std::vector<SparseEntries>& null_vectors, bool all, const Model& model,
                                          const RowSpace& space, std::span<const BodyState> states);
// Of some where the mechanism stands and some elsewhere, both by group: all, each with the components of both.
std::vector<Undetermined> together(const std::vector<Undetermined>& some, const std::vector<Undetermined>& others);

}  // namespace poinsot
