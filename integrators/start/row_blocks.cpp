#include "integrators/start/row_blocks.h"

#include <algorithm>
#include <vector>

#include "core/index.h"
#include "integrators/start/grounded_rows.h"

namespace poinsot {
namespace {

class Biconnected {
 public:
  Biconnected(const Model& model, std::span<const int> rows)
      : vertices_(static_cast<int>(model.bodies.size()) + 1), rows_(rows.size()), state_(index(vertices_)) {
    const int ground = vertices_ - 1;
    for (const int k : rows) {
      const Row& row = model.rows[index(k)];
      ends_.push_back({row.i == kGround ? ground : row.i, row.j == kGround ? ground : row.j});
    }
    // Such a row's two more edges close a triangle with its own, and what is on a triangle is of one part.
    for (const int k : grounded_rows(model, rows)) {
      const Ends ends = ends_[index(k)];
      ends_.push_back({ends.i, ground});
      ends_.push_back({ends.j, ground});
    }
    part_.assign(ends_.size(), -1);
    edges_ = Lists::collect(vertices_, [&](auto&& emit) {
      for (int k = 0; k < static_cast<int>(ends_.size()); ++k)
        for (const int v : {ends_[index(k)].i, ends_[index(k)].j}) emit(v, k);
    });
  }

  Lists parts() {
    for (int v = 0; v < vertices_; ++v)
      if (state_[index(v)].number < 0) search(v);
    return Lists::collect(count_, [&](auto&& emit) {
      for (std::size_t k = 0; k < rows_; ++k) emit(part_[k], static_cast<int>(k));
    });
  }

 private:
  struct Ends {
    int i, j;
  };
  struct State {
    int number = -1, low = 0;  // when it was reached; the first that is reached from behind it
    std::size_t next = 0;      // of its edges
    std::size_t begin = 0;     // of the edges found since it was entered
    int from = -1;
  };

  void enter(int v, int from) {
    State& state = state_[index(v)];
    state.number = state.low = reached_++;
    state.begin = open_.size();
    state.from = from;
    path_.push_back(v);
  }

  // Depth first; an edge is open from when it is first met until its part is complete. Edges between the same two
  // vertices belong to one part: they are open together.
  void search(int root) {
    enter(root, -1);
    while (!path_.empty()) {
      const int v = path_.back();
      State& state = state_[index(v)];
      if (state.next < edges_[v].size()) {
        const int edge = edges_[v][state.next++];
        if (part_[index(edge)] != -1) continue;
        const Ends& ends = ends_[index(edge)];
        const int w = ends.i == v ? ends.j : ends.i;
        part_[index(edge)] = kOpen;
        if (state_[index(w)].number < 0) {
          enter(w, v);
          open_.push_back(edge);
        } else {
          open_.push_back(edge);
          if (w != state.from) state.low = std::min(state.low, state_[index(w)].number);
        }
        continue;
      }
      path_.pop_back();
      if (state.from < 0) continue;
      State& above = state_[index(state.from)];
      above.low = std::min(above.low, state.low);
      if (state.low < above.number) continue;
      for (; open_.size() > state.begin; open_.pop_back()) part_[index(open_.back())] = count_;
      ++count_;
    }
  }

  static constexpr int kOpen = -2;
  int vertices_;
  std::size_t rows_;
  std::vector<Ends> ends_;  // by edge, those of rows first
  Lists edges_;             // by vertex
  std::vector<State> state_;
  std::vector<int> part_;  // by edge
  std::vector<int> path_, open_;
  int reached_ = 0, count_ = 0;
};

}  // namespace

Lists row_blocks(const Model& model, std::span<const int> rows) {
  return Biconnected(model, rows).parts();
}

}  // namespace poinsot
