#include "integrators/start/grouped_rows.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/index.h"
#include "linsolve/lists.h"

namespace poinsot {
namespace {

// By body.
std::vector<int> joint_counts(const Model& model) {
  std::vector<int> count(model.bodies.size(), 0);
  for (const Group& group : model.groups)
    for (const int body : {group.i, group.j})
      if (body != kGround) ++count[index(body)];
  return count;
}

// By body: joints on the way to the ground, 0 where there is none.
std::vector<int> distances_from_ground(const Model& model) {
  const Lists beside = Lists::collect(static_cast<int>(model.bodies.size()), [&](auto&& emit) {
    for (const Group& group : model.groups)
      if (group.i != kGround && group.j != kGround) emit(group.i, group.j), emit(group.j, group.i);
  });
  std::vector<int> distance(model.bodies.size(), 0), reached;
  const auto reach = [&](int body, int at) {
    if (body == kGround || distance[index(body)] > 0) return;
    distance[index(body)] = at;
    reached.push_back(body);
  };
  for (const Group& group : model.groups)
    if (group.i == kGround || group.j == kGround) reach(group.i == kGround ? group.j : group.i, 1);
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const int body : beside[reached[k]]) reach(body, distance[index(reached[k])] + 1);
  return distance;
}

}  // namespace

std::vector<int> opening_turns(const Model& model) {
  constexpr int kInAChain = 4;  // two at either body of a joint, itself counted twice
  const std::vector<int> joints = joint_counts(model), distance = distances_from_ground(model);
  std::vector<std::array<int, 3>> key;
  for (const Group& group : model.groups) {
    const auto both = [&](const std::vector<int>& of) {
      int sum = 0;
      for (const int body : {group.i, group.j})
        if (body != kGround) sum += of[index(body)];
      return sum;
    };
    if (group.i == kGround || group.j == kGround)
      key.push_back({0, 0, 0});
    else if (both(joints) > kInAChain)
      key.push_back({-both(joints), -both(distance), 0});
    else
      key.push_back({-both(joints), both(distance), -static_cast<int>(key.size())});
  }
  std::vector<int> order(key.size()), turn(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int group) { return key[index(group)]; });
  for (std::size_t k = 0; k < order.size(); ++k) turn[index(order[k])] = static_cast<int>(k);
  return turn;
}

Grouped grouped_rows(const Model& model, std::span<const int> turns, std::span<const int> rows) {
  Grouped columns;
  for (const int k : rows) {
    const int group = model.rows[index(k)].group;
    columns.group.push_back(group);
    columns.turn.push_back(turns[index(group)]);
  }
  return columns;
}

}  // namespace poinsot
