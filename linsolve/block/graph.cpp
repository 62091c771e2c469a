#include "linsolve/block/graph.h"

#include <algorithm>
#include <numeric>

#include "core/index.h"

namespace poinsot::block {
namespace {

// Calls visit(i, j) for every entry of the pattern.
template <class Visit>
void entries(const CscLayout& layout, Visit&& visit) {
  for (int j = 0; j < layout.n; ++j)
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k) visit(layout.row[index(k)], j);
}

class UnionFind {
 public:
  explicit UnionFind(int n) : parent_(index(n)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int k) {
    while (parent_[index(k)] != k) k = parent_[index(k)] = parent_[index(parent_[index(k)])];
    return k;
  }
  void join(int a, int b) { parent_[index(find(a))] = find(b); }

 private:
  std::vector<int> parent_;
};

// By set(k) of unknown k: the other sets it shares entries with.
template <class SetOf>
Lists seen(const CscLayout& layout, int sets, SetOf&& set) {
  const auto rows = [&](int j) {
    return std::span(layout.row)
        .subspan(index(layout.start[index(j)]), index(layout.start[index(j) + 1] - layout.start[index(j)]));
  };
  std::vector<int> columns;  // but for those that say the same as the one before
  for (int j = 0; j < layout.n; ++j)
    if (j == 0 || set(j) != set(j - 1) || !std::ranges::equal(rows(j), rows(j - 1))) columns.push_back(j);
  return Lists::collect(sets, [&](auto&& emit) {
    int last_i = -1, last_j = -1;  // a block's entries say the same again and again
    for (const int j : columns) {
      const int b = set(j);
      for (const int i : rows(j)) {
        const int a = set(i);
        if (a == b || (a == last_i && b == last_j)) continue;
        last_i = a, last_j = b;
        emit(a, b);
        emit(b, a);
      }
    }
  });
}

// Parts of a node that see the same are one atom: r_x, r_y, r_z see the same rows one by one. By root of part: the root
// of the first part of its atom. Bodies' parts that see the same rows are merged first, then rows are compared by the
// merged parts they see.
template <class Home>
std::vector<int> merge(const CscLayout& layout, const std::vector<int>& part, const std::vector<char>& on_body,
                       Home&& home) {
  const Lists outside = seen(layout, layout.n, [&](int k) { return part[index(k)]; });
  std::vector<int> roots, merged(index(layout.n));
  std::iota(merged.begin(), merged.end(), 0);
  for (int k = 0; k < layout.n; ++k)
    if (part[index(k)] == k) roots.push_back(k);
  std::ranges::stable_sort(roots, {}, home);

  struct Known {
    int root;
    std::size_t begin, end;  // of what it sees
  };
  std::vector<Known> known;  // of the node at hand
  std::vector<int> sights, sight;
  for (const bool body : {true, false}) {
    int node = -1;
    for (const int k : roots) {
      if ((on_body[index(k)] != 0) != body) continue;
      if (home(k) != node) known.clear(), sights.clear(), node = home(k);
      sight.assign(outside[k].begin(), outside[k].end());
      for (int& s : sight) s = merged[index(s)];
      std::ranges::sort(sight);
      sight.erase(std::unique(sight.begin(), sight.end()), sight.end());
      const auto same = std::ranges::find_if(known, [&](const Known& other) {
        return std::equal(sight.begin(), sight.end(), sights.begin() + static_cast<std::ptrdiff_t>(other.begin),
                          sights.begin() + static_cast<std::ptrdiff_t>(other.end));
      });
      if (same != known.end()) {
        merged[index(k)] = same->root;
      } else {
        known.push_back({k, sights.size(), sights.size() + sight.size()});
        sights.insert(sights.end(), sight.begin(), sight.end());
      }
    }
  }
  return merged;
}

}  // namespace

void Incidence::find(const CscLayout& layout, std::span<const int> node_of, std::span<const int> fused) {
  const int nodes = 1 + *std::ranges::max_element(node_of);
  fused_with.assign(index(nodes), -1);
  if (!fused.empty()) std::ranges::copy(fused, fused_with.begin());
  is_group.assign(index(nodes), 1);  // but for nodes with an entry on the diagonal that are not fused with another
  entries(layout, [&](int i, int j) {
    if (i == j && fused_with[index(node_of[index(i)])] < 0) is_group[index(node_of[index(i)])] = 0;
  });
  const Lists other = seen(layout, nodes, [&](int k) { return node_of[index(k)]; });
  const auto between = [&](bool group) {
    return Lists::collect(nodes, [&](auto&& emit) {
      for (int a = 0; a < nodes; ++a)
        if ((is_group[index(a)] != 0) == group)
          for (const int b : other[a])
            if ((is_group[index(b)] != 0) != group) emit(a, b);
    });
  };
  bodies = between(true);
  groups = between(false);
}

void Graph::build(const CscLayout& layout, std::span<const int> node_of, std::span<const int> fused) {
  const int n = layout.n;
  const int nodes = 1 + *std::ranges::max_element(node_of);
  const auto home = [&](int k) {
    const int g = node_of[index(k)];
    return fused.empty() || fused[index(g)] < 0 ? g : fused[index(g)];
  };

  // Parts of a node that are connected within it. A part with an entry on the diagonal belongs to a body.
  UnionFind connected(n);
  std::vector<char> diagonal(index(n), 0), on_body(index(n), 0);  // the latter by root of part
  entries(layout, [&](int i, int j) {
    if (home(i) == home(j)) connected.join(i, j);
    if (i == j) diagonal[index(i)] = 1;
  });
  std::vector<int> part(index(n));  // by unknown: its root
  for (int k = 0; k < n; ++k) {
    part[index(k)] = connected.find(k);
    if (diagonal[index(k)]) on_body[index(part[index(k)])] = 1;
  }

  const std::vector<int> merged = merge(layout, part, on_body, home);
  node.clear(), constraint.clear();
  std::vector<int> atom_at(index(n), -1), atom_of(index(n));  // by root; by unknown
  for (int k = 0; k < n; ++k) {
    const int root = merged[index(part[index(k)])];
    if (atom_at[index(root)] < 0) {
      atom_at[index(root)] = static_cast<int>(node.size());
      constraint.push_back(on_body[index(root)] == 0);
      node.push_back(home(k));
    }
    atom_of[index(k)] = atom_at[index(root)];
  }
  const int count = static_cast<int>(node.size());
  unknowns = Lists::collect(count, [&](auto&& emit) {
    for (int k = 0; k < n; ++k) emit(atom_of[index(k)], k);
  });
  neighbours = seen(layout, count, [&](int k) { return atom_of[index(k)]; });

  body_atoms.assign(index(nodes), 0);
  for (int a = 0; a < count; ++a)
    if (!constraint[index(a)]) ++body_atoms[index(node[index(a)])];
  find(layout, node_of, fused);
}

double symmetry(const CscLayout& layout) {
  if (layout.nonzeros() == 0) return 1;
  // Columns are taken ascending, and in each row so are the entries whose mirrors are looked for in a column.
  std::vector<int> next(layout.start.begin(), layout.start.end() - 1);
  int mirrored = 0;
  entries(layout, [&](int i, int j) {
    int& k = next[index(i)];
    const int end = layout.start[index(i) + 1];
    while (k < end && layout.row[index(k)] < j) ++k;
    mirrored += k < end && layout.row[index(k)] == j;
  });
  return static_cast<double>(mirrored) / layout.nonzeros();
}

}  // namespace poinsot::block
