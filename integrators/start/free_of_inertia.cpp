#include "integrators/start/free_of_inertia.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/open_spins.h"
#include "integrators/start/row_space.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// A turn of one body without inertia.
struct Turn {
  int body;
  Vector3 axis;     // of its frame
  double held = 1;  // what the constraints make of it; 1 where that is nothing
};

std::vector<Turn> turns_without_inertia(const Model& model) {
  std::vector<Turn> turns;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Matrix3 axes = axes_without_moment(model.bodies[b]);
    for (int k = 0; k < 3; ++k)
      if (!axes.col(k).isZero(0)) turns.push_back({static_cast<int>(b), axes.col(k)});
  }
  return turns;
}

// G x of each turn, of unit length, or zero where constraints do not hold it.
Sparse held_by(const Sparse& G_transposed, std::vector<Turn>& turns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < turns.size(); ++k)
    for (int axis = 0; axis < 3; ++axis)
      entries.emplace_back(6 * turns[k].body + 3 + axis, static_cast<int>(k), turns[k].axis[axis]);
  Sparse W(G_transposed.rows(), static_cast<Eigen::Index>(turns.size()));
  W.setFromTriplets(entries.begin(), entries.end());
  Sparse held = G_transposed.transpose() * W;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    auto column = held.col(static_cast<Eigen::Index>(k));
    const double norm = column.norm();
    if (norm > kDependent) turns[k].held = norm;
    column *= norm > kDependent ? 1 / norm : 0;
  }
  return held;
}

Status refusal(std::string motion, std::string_view of_one) {
  return with_remedy(Failure::singular_matrix, 0, "at t = 0 s the linear system is singular: " + std::move(motion),
                     fmt::format("give {} there, or start from another pose", of_one));
}

}  // namespace

Status refuse_motion_free_of_inertia(const std::shared_ptr<const Model>& model, std::span<const BodyState> states) {
  std::vector<Turn> turns = turns_without_inertia(*model);
  if (turns.empty()) return {};
  std::vector<int> rows(model->rows.size());
  std::iota(rows.begin(), rows.end(), 0);
  RowSpace space(model, std::move(rows));
  space.stand(0, states);
  const NullSpace free = null_space(held_by(space.columns(), turns), kDependent, turns.size());
  if (free.columns.empty()) return {};
  std::vector<int> bodies;
  Vector3 axis = Vector3::Zero();
  const SparseEntries motion =
      free.vectors.empty() ? SparseEntries{{free.columns[0], 1.0}} : free.vectors[0];  // past all measure one of many
  for (const auto& [k, share] : motion) {
    const Turn& turn = turns[index(k)];
    if (!(std::abs(share) > kDependent)) continue;
    bodies.push_back(turn.body);
    axis += share / turn.held * turn.axis;
  }
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  const auto body = [&](std::size_t k) -> const Body& { return model->bodies[index(bodies[k])]; };
  if (bodies.size() == 1) {
    return refusal(
        describe_no_moment(body(0), axis.normalized()) + ", and no constraint holds it about that in the initial pose",
        "it a small moment");
  }
  return refusal(
      fmt::format("body '{}' and body '{}'{} have no moment of inertia along a turn of theirs that the "
                  "constraints leave free in the initial pose",
                  body(0).name, body(1).name, bodies.size() > 2 ? fmt::format(" and {} more", bodies.size() - 2) : ""),
      "one of them a small moment");
}

}  // namespace poinsot
