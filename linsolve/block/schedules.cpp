#include "linsolve/block/schedules.h"

#include <algorithm>
#include <array>
#include <vector>

#include "linsolve/block/order.h"

namespace poinsot::block {
namespace {

// Unknowns of a matrix that is kept: some forty bodies. Three formulations of a scene have three patterns each.
constexpr int kSmall = 500;
constexpr std::size_t kKept = 9;

struct Known {
  std::vector<int> start, row, node, fused;
  std::shared_ptr<const Schedule> schedule;

  bool is_of(const CscLayout& layout, std::span<const int> of_node, std::span<const int> of_fused) const {
    return start == layout.start && row == layout.row && std::ranges::equal(node, of_node) &&
           std::ranges::equal(fused, of_fused);
  }
};

std::shared_ptr<const Schedule> make(const CscLayout& layout, std::span<const int> node, std::span<const int> fused) {
  Graph graph;
  graph.build(layout, node, fused);
  auto schedule = std::make_shared<Schedule>();
  return schedule->build(layout, graph, elimination_order(graph)) ? schedule : nullptr;
}

}  // namespace

std::shared_ptr<const Schedule> schedule_of(const CscLayout& layout, std::span<const int> node,
                                            std::span<const int> fused) {
  if (layout.n > kSmall) return make(layout, node, fused);
  thread_local std::array<Known, kKept> known;
  thread_local std::size_t next = 0;  // to be replaced
  for (const Known& one : known)
    if (one.schedule && one.is_of(layout, node, fused)) return one.schedule;
  std::shared_ptr<const Schedule> schedule = make(layout, node, fused);
  if (schedule) {
    known[next] = {layout.start, layout.row, {node.begin(), node.end()}, {fused.begin(), fused.end()}, schedule};
    next = (next + 1) % kKept;
  }
  return schedule;
}

}  // namespace poinsot::block
