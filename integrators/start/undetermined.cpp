#include "integrators/start/undetermined.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/reaction_components.h"

namespace poinsot {
namespace {

constexpr double kNoLoad = 1e-7;  // of a null vector on unit rows

using UnitLoad = Eigen::Matrix<double, 6, 1>;  // on a body at its centre, its moment in the body's frame and size

// The same at the point of the group, global; its moment still in the body's size.
UnitLoad at_point(const Group& group, int body, double size, std::span<const BodyState> states, const UnitLoad& load) {
  const BodyState& of = states[index(body)];
  Vector3 point = group.point_j;
  if (group.j != kGround) point = states[index(group.j)].r + states[index(group.j)].A * group.point_j;
  UnitLoad there = load;
  there.tail<3>() = of.A * load.tail<3>() - (point - of.r).cross(Vector3(load.head<3>())) / size;
  return there;
}

}  // namespace

std::vector<std::string> Undetermined::components(const Model& model) const {
  std::vector<std::string> names;
  if (model.groups[index(group)].kind == GroupKind::constraint) return names;
  for (std::size_t c = 0; c < loaded.size(); ++c)
    if (loaded[c]) names.emplace_back(kReactionComponents[c]);
  return names;
}

LoadedGroups::LoadedGroups(const Model& model, const RowSpace& space, std::span<const BodyState> states)
    : model_(model), space_(space), states_(states), of_groups_(model.groups.size()), any_(model.groups.size(), 0) {
  for (std::size_t g = 0; g < of_groups_.size(); ++g) of_groups_[g].group = static_cast<int>(g);
}

void LoadedGroups::add(const Eigen::SparseMatrix<double>& columns, const SparseEntries& z) {
  const double size = largest(z);
  for (auto first = z.begin(); first != z.end();) {
    const Row& of = row(first->first);
    const int body = of.j != kGround ? of.j : of.i;
    UnitLoad load = UnitLoad::Zero();
    for (; first != z.end() && row(first->first).group == of.group; ++first)
      for (Eigen::SparseMatrix<double>::InnerIterator it(columns, first->first); it; ++it)
        if (it.row() / 6 == body) load[it.row() % 6] += first->second * it.value();
    if (!(load.norm() > kNoLoad * size)) continue;
    any_[index(of.group)] = 1;
    load = at_point(model_.groups[index(of.group)], body, space_.size_of_body(body), states_, load);
    for (std::size_t c = 0; c < 6; ++c)
      if (std::abs(load[static_cast<Eigen::Index>(c)]) > kNoLoad * size) of_groups_[index(of.group)].loaded[c] = true;
  }
}

void LoadedGroups::add_all() {
  for (std::size_t k = 0; k < space_.rows().size(); ++k) {
    const std::size_t group = index(row(static_cast<int>(k)).group);
    any_[group] = 1;
    of_groups_[group].loaded.fill(true);
  }
}

std::vector<Undetermined> LoadedGroups::found() const {
  std::vector<Undetermined> some;
  for (const Undetermined& group : of_groups_)
    if (any_[index(group.group)]) some.push_back(group);
  return some;
}

std::vector<Undetermined> undetermined_by(const std::vector<SparseEntries>& null_vectors, bool all, const Model& model,
                                          const RowSpace& space, std::span<const BodyState> states) {
  LoadedGroups groups(model, space, states);
  if (all) groups.add_all();
  SparseEntries unit;
  for (const SparseEntries& z : null_vectors) {
    unit.clear();
    for (const auto& [row, value] : z) {
      const auto k = std::ranges::lower_bound(space.rows(), row) - space.rows().begin();
      unit.emplace_back(static_cast<int>(k), value * space.lengths()[index(k)]);
    }
    std::ranges::sort(unit);
    groups.add(space.columns(), unit);
  }
  return groups.found();
}

std::vector<Undetermined> together(const std::vector<Undetermined>& some, const std::vector<Undetermined>& others) {
  std::vector<Undetermined> all = some;
  for (const Undetermined& other : others) {
    const auto place = std::ranges::lower_bound(all, other.group, {}, &Undetermined::group);
    if (place == all.end() || place->group != other.group)
      all.insert(place, other);
    else
      for (std::size_t c = 0; c < other.loaded.size(); ++c) place->loaded[c] = place->loaded[c] || other.loaded[c];
  }
  return all;
}

}  // namespace poinsot
