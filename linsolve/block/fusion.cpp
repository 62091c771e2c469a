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

}  // namespace

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
