#include "integrators/start/grouped_rows.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/index.h"
#include "linsolve/lists.h"

namespace poinsot {
namespace {

// Links of a loop beside the body that carries it, from which on the last of the two joints there is opened: in shorter
// loops the first serves as well.
constexpr int kLongChain = 4;

// By body.
std::vector<int> joint_counts(const Model& model) {
  std::vector<int> count(model.bodies.size(), 0);
  for (const Group& group : model.groups)
    for (const int body : {group.i, group.j})
      if (body != kGround) ++count[index(body)];
  return count;
}

// By body: those it has joints with, but for the ground.
Lists bodies_beside(const Model& model) {
  return Lists::collect(static_cast<int>(model.bodies.size()), [&](auto&& emit) {
    for (const Group& group : model.groups)
      if (group.i != kGround && group.j != kGround) emit(group.i, group.j), emit(group.j, group.i);
  });
}

// By body: joints on the way to the ground, 0 where there is none.
std::vector<int> distances_from_ground(const Model& model, const Lists& beside) {
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

// Bodies with two joints in a row, from one on and away from another: the links of a loop, up to the body that carries
// it, as far as it matters.
int links_from(const Lists& beside, const std::vector<int>& joints, int body, int before) {
  int links = 0;
  while (body != kGround && joints[index(body)] == 2 && links < kLongChain) {
    ++links;
    int next = kGround;
    for (const int other : beside[body])
      if (other != before) next = other;
    before = std::exchange(body, next);
  }
  return links;
}

}  // namespace

std::vector<int> opening_turns(const Model& model) {
  constexpr int kInAChain = 4;  // two at either body of a joint, itself counted twice
  const Lists beside = bodies_beside(model);
  const std::vector<int> joints = joint_counts(model), distance = distances_from_ground(model, beside);
  const auto ends_a_chain = [&](const Group& group) {
    return links_from(beside, joints, group.i, group.j) == kLongChain ||
           links_from(beside, joints, group.j, group.i) == kLongChain;
  };
  std::vector<std::array<int, 3>> key;
  for (const Group& group : model.groups) {
    const auto both = [&](const std::vector<int>& of) {
      int sum = 0;
      for (const int body : {group.i, group.j})
        if (body != kGround) sum += of[index(body)];
      return sum;
    };
    const int last_first = -static_cast<int>(key.size());
    if (group.i == kGround || group.j == kGround)
      key.push_back({0, 0, 0});
    else if (both(joints) > kInAChain)
      key.push_back({-both(joints), -both(distance), ends_a_chain(group) ? last_first : 0});
    else
      key.push_back({-both(joints), both(distance), last_first});
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
