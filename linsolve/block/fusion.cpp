#include "linsolve/block/fusion.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/index.h"
#include "linsolve/block/graph.h"

namespace poinsot::block {
namespace {

constexpr std::size_t kMostTakenIn = 128;  // groups by one body: a front of some hundred unknowns

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
      const std::span<const int> bodies = incidence.bodies[of];
      if (bodies.empty()) continue;
      with[index(of)] = *std::ranges::max_element(bodies, {}, [&](int b) { return place[index(b)]; });
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
