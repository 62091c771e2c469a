#include "linsolve/block_graph.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace poinsot {
namespace {

std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

// Calls visit(i, j) for every entry of the pattern.
template <class Visit>
void entries(const CscLayout& layout, Visit&& visit) {
  for (int j = 0; j < layout.n; ++j)
    for (int k = layout.start[at(j)]; k < layout.start[at(j) + 1]; ++k) visit(layout.row[at(k)], j);
}

void sort_unique(std::vector<int>& v) {
  std::ranges::sort(v);
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

class UnionFind {
 public:
  explicit UnionFind(int n) : parent_(at(n)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int k) {
    while (parent_[at(k)] != k) k = parent_[at(k)] = parent_[at(parent_[at(k)])];
    return k;
  }
  void join(int a, int b) { parent_[at(find(a))] = find(b); }

 private:
  std::vector<int> parent_;
};

}  // namespace

void BlockGraph::build(const CscLayout& layout, std::span<const int> node, std::span<const int> fused) {
  const int n = layout.n;
  const int nodes = 1 + *std::ranges::max_element(node);
  const auto home = [&](int k) {
    const int g = node[at(k)];
    return fused.empty() || fused[at(g)] < 0 ? g : fused[at(g)];
  };

  // Parts of a node that are connected within it. A part with an entry on the diagonal belongs to a body.
  UnionFind part(n);
  std::vector<char> diagonal(at(n), 0);
  entries(layout, [&](int i, int j) {
    if (home(i) == home(j)) part.join(i, j);
    if (i == j) diagonal[at(i)] = 1;
  });
  std::vector<char> on_body(at(n), 0);  // by root of part
  for (int k = 0; k < n; ++k)
    if (diagonal[at(k)]) on_body[at(part.find(k))] = 1;

  // What a part sees outside itself decides which parts of a node are one atom.
  std::vector<std::vector<int>> outside(at(n));  // by root, roots of other parts
  entries(layout, [&](int i, int j) {
    const int a = part.find(i), b = part.find(j);
    if (a == b) return;
    outside[at(a)].push_back(b);
    outside[at(b)].push_back(a);
  });
  for (auto& list : outside) sort_unique(list);
  // Seen by the nodes they belong to and what they are there: rows r_x, r_y, r_z see the same rows one by one.
  std::vector<int> part_home(at(n));
  for (int k = 0; k < n; ++k) part_home[at(k)] = home(k);

  // Parts of equal sight, node by node.
  std::vector<int> roots;
  for (int k = 0; k < n; ++k)
    if (part.find(k) == k) roots.push_back(k);
  std::vector<int> atom_of_root(at(n), -1);
  std::map<std::pair<std::pair<int, bool>, std::vector<int>>, int> known;
  int last_node = -1;
  std::ranges::stable_sort(roots, {}, [&](int k) { return part_home[at(k)]; });
  // Constraint rows first see bodies' parts; bodies' parts that see the same rows are merged first, then rows are
  // compared by the merged atoms they see.
  std::vector<int> merged(at(n));
  std::iota(merged.begin(), merged.end(), 0);
  for (const bool body : {true, false}) {
    known.clear();
    last_node = -1;
    for (const int k : roots) {
      if ((on_body[at(k)] != 0) != body) continue;
      if (part_home[at(k)] != last_node) known.clear(), last_node = part_home[at(k)];
      std::vector<int> sight = outside[at(k)];
      for (int& s : sight) s = merged[at(s)];
      sort_unique(sight);
      const auto [it, fresh] = known.try_emplace({{part_home[at(k)], body}, std::move(sight)}, k);
      merged[at(k)] = it->second;
    }
  }

  atoms.clear();
  atom_of.assign(at(n), -1);
  for (int k = 0; k < n; ++k) {
    const int root = merged[at(part.find(k))];
    if (atom_of_root[at(root)] < 0) {
      atom_of_root[at(root)] = static_cast<int>(atoms.size());
      atoms.push_back({{}, {}, on_body[at(root)] == 0, home(k)});
    }
    atom_of[at(k)] = atom_of_root[at(root)];
    atoms[at(atom_of[at(k)])].unknowns.push_back(k);
  }
  entries(layout, [&](int i, int j) {
    const int a = atom_of[at(i)], b = atom_of[at(j)];
    if (a == b) return;
    atoms[at(a)].neighbours.push_back(b);
    atoms[at(b)].neighbours.push_back(a);
  });
  for (Atom& atom : atoms) sort_unique(atom.neighbours);

  body_atoms.assign(at(nodes), 0);
  for (const Atom& atom : atoms)
    if (!atom.constraint) ++body_atoms[at(atom.node)];
  // Which groups act on which bodies, by the nodes of the pattern: fused groups included.
  fused_with.assign(at(nodes), -1);
  if (!fused.empty()) std::ranges::copy(fused, fused_with.begin());
  const auto is_group = [&](int g) { return fused_with[at(g)] >= 0 || body_atoms[at(g)] == 0; };
  bodies.assign(at(nodes), {});
  groups.assign(at(nodes), {});
  entries(layout, [&](int i, int j) {
    const int a = node[at(i)], b = node[at(j)];
    if (a == b || is_group(a) == is_group(b)) return;
    const int group = is_group(a) ? a : b, body = is_group(a) ? b : a;
    bodies[at(group)].push_back(body);
    groups[at(body)].push_back(group);
  });
  for (auto& list : bodies) sort_unique(list);
  for (auto& list : groups) sort_unique(list);
}

double symmetry(const CscLayout& layout) {
  if (layout.nonzeros() == 0) return 1;
  int mirrored = 0;
  entries(layout, [&](int i, int j) {
    const auto first = layout.row.begin() + layout.start[at(i)], last = layout.row.begin() + layout.start[at(i) + 1];
    mirrored += std::binary_search(first, last, j);
  });
  return static_cast<double>(mirrored) / layout.nonzeros();
}

}  // namespace poinsot
