#include "linsolve/block/fusion.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/index.h"
#include "linsolve/block/graph.h"

namespace poinsot::block {
namespace {

constexpr std::size_t kMostReached = 64;   // groups, in the search for a hub
constexpr std::size_t kMostTakenIn = 128;  // groups by one body: a front of some hundred unknowns
constexpr int kFreedoms = 6;               // of a hub

// A group whose bodies were all eliminated before it waits for one that is not, a hub: the nearest group that has one,
// −1 where there is none.
int nearest_with_later(const Incidence& incidence, const std::vector<int>& place, int group, int at) {
  const auto is_later = [&](int body) { return place[index(body)] > at; };
  std::vector<int> reached = {group};
  for (std::size_t k = 0; k < reached.size() && reached.size() < kMostReached; ++k) {
    const std::span<const int> bodies = incidence.bodies[reached[k]];
    if (std::ranges::any_of(bodies, is_later)) return reached[k];
    for (const int body : bodies)
      for (const int next : incidence.groups[body])
        if (std::ranges::find(reached, next) == reached.end()) reached.push_back(next);
  }
  return -1;
}

// By node: unknowns with an entry on the diagonal less those without, which are rows.
std::vector<int> freedoms(const CscLayout& layout, std::span<const int> node, std::size_t nodes) {
  std::vector<int> of(nodes, 0);
  for (int k = 0; k < layout.n; ++k) {
    const auto begin = layout.row.begin() + layout.start[index(k)],
               end = layout.row.begin() + layout.start[index(k) + 1];
    of[index(node[index(k)])] += std::binary_search(begin, end, k) ? 1 : -1;
  }
  return of;
}

}  // namespace

void fuse_with_hubs(const CscLayout& layout, std::span<const int> node, std::vector<int>& fused) {
  const auto is_long = [&](int k) {
    return index(layout.start[index(k) + 1] - layout.start[index(k)]) > Incidence::kHub;
  };
  int column = 0;
  while (column < layout.n && !is_long(column)) ++column;
  if (column == layout.n) return;  // no hubs
  Incidence incidence;
  incidence.find(layout, node, fused);
  const int nodes = static_cast<int>(fused.size());
  const std::vector<int> free = freedoms(layout, node, fused.size());
  struct Held {
    int group, hub;
  };
  std::vector<Held> held;
  std::vector<int> with = fused, part;
  std::vector<char> reached(fused.size(), 0);
  int hubs = 0, surplus = 0;
  for (int first = 0; first < nodes; ++first) {
    if (incidence.is_hub(first)) ++hubs;
    if (reached[index(first)] || incidence.is_group[index(first)] || incidence.is_hub(first)) continue;
    part.assign(1, first);
    reached[index(first)] = 1;
    held.clear();
    int left = 0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      const int at = part[k];
      left += free[index(at)];
      for (const int next : incidence.is_group[index(at)] ? incidence.bodies[at] : incidence.groups[at])
        if (incidence.is_hub(next))
          held.push_back({at, next});
        else if (!std::exchange(reached[index(next)], 1))
          part.push_back(next);
    }
    surplus -= std::min(left, 0);
    for (std::size_t k = 0; k < held.size() && left < 0; ++k)
      if (std::exchange(with[index(held[k].group)], held[k].hub) < 0) left -= free[index(held[k].group)];
  }
  if (surplus <= kFreedoms * hubs) fused = std::move(with);
}

bool fuse(const CscLayout& layout, std::span<const int> node, const Schedule& schedule, std::span<const int> bad,
          std::vector<int>& fused) {
  Incidence incidence;
  incidence.find(layout, node, fused);
  const auto node_at = [&](int k) { return node[index(schedule.unknown[index(k)])]; };
  std::vector<int> place(fused.size(), 0);  // in the order of elimination, by node
  for (int k = 0; k < schedule.n; ++k) place[index(node_at(k))] = k;
  std::vector<int> with = fused;
  bool any = false;
  for (const int k : bad) {
    const int of = node_at(k);
    if (with[index(of)] >= 0) continue;
    if (incidence.is_group[index(of)]) {
      int group = nearest_with_later(incidence, place, of, k);
      if (group < 0 || with[index(group)] >= 0) group = of;
      const std::span<const int> bodies = incidence.bodies[group];
      if (bodies.empty()) continue;
      with[index(group)] = *std::ranges::max_element(bodies, {}, [&](int b) { return place[index(b)]; });
      any = true;
      continue;
    }
    for (const int g : incidence.groups[of])
      if (with[index(g)] < 0) {
        with[index(g)] = of;
        any = true;
        break;
      }
  }
  std::vector<std::size_t> taken_in(with.size(), 0);  // groups, by node of a body
  for (const int body : with)
    if (body >= 0 && ++taken_in[index(body)] > kMostTakenIn) return false;
  fused = std::move(with);
  return any;
}

}  // namespace poinsot::block
