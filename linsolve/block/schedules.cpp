#include "linsolve/block/schedules.h"

#include <algorithm>
#include <deque>
#include <numeric>
#include <vector>

#include "linsolve/block/order.h"

namespace poinsot::block {
namespace {

// Three formulations of a scene have three patterns each.
constexpr std::size_t kKept = 9;
// Unknowns of those kept in all: some 2000 bodies, and a few megabytes.
constexpr int kMostUnknowns = 20'000;

struct Known {
  std::vector<int> start, row, node, fused;
  Fronts kind;
  std::shared_ptr<const Schedule> schedule;

  bool is_of(const CscLayout& layout, std::span<const int> of_node, std::span<const int> of_fused,
             Fronts of_kind) const {
    return kind == of_kind && start == layout.start && row == layout.row && std::ranges::equal(node, of_node) &&
           std::ranges::equal(fused, of_fused);
  }
};

std::shared_ptr<const Schedule> make(const CscLayout& layout, std::span<const int> node, std::span<const int> fused,
                                     Fronts kind) {
  Graph graph;
  graph.build(layout, node, fused);
  auto schedule = std::make_shared<Schedule>();
  return schedule->build(layout, graph, elimination_order(graph), kind) ? schedule : nullptr;
}

}  // namespace

std::shared_ptr<const Schedule> schedule_of(const CscLayout& layout, std::span<const int> node,
                                            std::span<const int> fused, Fronts kind) {
  if (layout.n > kMostUnknowns) return make(layout, node, fused, kind);
  thread_local std::deque<Known> known;  // the newest last
  for (const Known& one : known)
    if (one.is_of(layout, node, fused, kind)) return one.schedule;
  std::shared_ptr<const Schedule> schedule = make(layout, node, fused, kind);
  if (!schedule) return schedule;
  known.push_back({layout.start, layout.row, {node.begin(), node.end()}, {fused.begin(), fused.end()}, kind, schedule});
  const auto unknowns = [](std::size_t sum, const Known& one) { return sum + one.node.size(); };
  while (known.size() > kKept || std::accumulate(known.begin(), known.end(), std::size_t{0}, unknowns) > kMostUnknowns)
    known.pop_front();
  return schedule;
}

}  // namespace poinsot::block
