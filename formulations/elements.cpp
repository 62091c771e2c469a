#include "formulations/elements.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "core/index.h"
#include "core/index_table.h"

namespace poinsot {
namespace {

// Of a spring or torsion spring of the model, which stays.
template <class Spring>
ElementLaw law_of(const Spring& s) {
  if (s.law) return {0, 0, s.law->depends_on_rate(), &*s.law};
  return {s.stiffness, s.damping, s.damping != 0, nullptr};
}

}  // namespace

struct Elements::Builder {
  Elements& e;
  IndexTable known_markers, known_pairs, known_nodes;
  std::vector<std::pair<int, int>> nodes;  // the two bodies of each

  // Body and exact components: equal vectors are one attached vector.
  int marker(int body, const Vector3& s) {
    const auto word = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // of −0, too, that of 0
    const auto same = [&](int k) { return e.markers[index(k)].body == body && e.markers[index(k)].s_bar == s; };
    const std::uint64_t hash = IndexTable::hash({index(body), word(s[0]), word(s[1]), word(s[2])});
    const int k = known_markers.find_or_add(hash, static_cast<int>(e.markers.size()), same);
    if (index(k) == e.markers.size()) e.markers.push_back({body, s});
    return k;
  }
  int right_side(const Expression& f, bool squared) {
    if (f.is_constant() && f.at(0.0).f == 0) return 0;
    e.right_sides.push_back({f, squared});
    return static_cast<int>(e.right_sides.size()) - 1;
  }
  int pair(int i, int j) {
    if (i == kGround || j == kGround) return -1;
    const auto same = [&](int k) { return e.pairs[index(k)].i == i && e.pairs[index(k)].j == j; };
    const int next = static_cast<int>(e.pairs.size());
    const int k = known_pairs.find_or_add(IndexTable::hash({index(i), index(j)}), next, same);
    if (k == next) e.pairs.push_back({.i = i, .j = j});
    return k;
  }
  int node(int i, int j) {
    const std::pair<int, int> bodies = std::minmax(i, j);
    const auto same = [&](int k) { return nodes[index(k)] == bodies; };
    const int k =
        known_nodes.find_or_add(IndexTable::hash({index(bodies.first), index(bodies.second)}), e.row_nodes, same);
    if (k == e.row_nodes) nodes.push_back(bodies), ++e.row_nodes;
    return k;
  }
  void couple(int pair_index, bool rr, bool rx, bool xr) {
    if (pair_index < 0) return;
    Pair& p = e.pairs[index(pair_index)];
    p.rr |= rr, p.rx |= rx, p.xr |= xr;
  }
  void touch(int body, bool rr, bool rx) {
    if (body == kGround) return;
    e.body_rr[index(body)] |= static_cast<char>(rr);
    e.body_rx[index(body)] |= static_cast<char>(rx);
  }

  void add(const Row& r) {
    const int row = e.rows++;
    e.row_node.push_back(node(r.i, r.j));

    // A constant direction on the coordinate of a row: CD couples no two bodies in the second variation.
    const RowBase base{row, r.i, r.j, right_side(r.f, r.squared), r.type == RowType::CD ? -1 : pair(r.i, r.j)};
    switch (r.type) {
      case RowType::DP1: {
        const DP1Row normal{base, marker(r.i, r.a_i), marker(r.j, r.a_j)};
        couple(base.pair, false, false, false);
        if (r.alternate) {
          DP1Row other = normal;
          other.u = marker(r.i, r.alternate->a_i);
          other.v = marker(r.j, r.alternate->a_j);
          other.f = right_side(r.alternate->f, false);
          e.alternates.push_back({static_cast<int>(e.dp1.size()), normal, other});
        }
        e.dp1.push_back(normal);
        break;
      }
      case RowType::DP2:
        e.dp2.push_back({base, marker(r.i, r.a_i), marker(r.i, r.s_i), marker(r.j, r.s_j)});
        couple(base.pair, false, false, true);
        touch(r.i, false, true);
        break;
      case RowType::D:
        e.d.push_back({base, marker(r.i, r.s_i), marker(r.j, r.s_j)});
        couple(base.pair, true, true, true);
        touch(r.i, true, true);
        touch(r.j, true, true);
        break;
      case RowType::CD:
        e.cd.push_back({base, r.c, marker(r.i, r.s_i), marker(r.j, r.s_j)});
        break;
      case RowType::angle:
        e.angle.push_back({base, marker(r.i, r.a_i), marker(r.i, r.b_i), marker(r.j, r.a_j)});
        couple(base.pair, false, false, false);
        break;
      case RowType::pfaffian:
        e.pfaffian.push_back({base, marker(r.j, r.a_j), marker(r.i, r.s_i), marker(r.j, r.s_j)});
        couple(base.pair, false, true, false);
        touch(r.i, false, true);
        touch(r.j, false, true);
        break;
    }
  }

  void join_coincidences() {
    const auto along_axes = [&](std::size_t k) {
      for (std::size_t l = 0; l < 3; ++l) {
        const CDRow &first = e.cd[k], &r = e.cd[k + l];
        const bool same = r.i == first.i && r.j == first.j && r.p == first.p && r.q == first.q;
        if (!same || r.row != first.row + static_cast<int>(l) || r.f != 0 || r.c != Vector3::Unit(static_cast<int>(l)))
          return false;
      }
      return true;
    };
    std::vector<CDRow> others;
    for (std::size_t k = 0; k < e.cd.size();) {
      if (k + 2 < e.cd.size() && along_axes(k)) {
        e.coincidences.push_back({e.cd[k], e.cd[k].p, e.cd[k].q});
        k += 3;
      } else {
        others.push_back(e.cd[k++]);
      }
    }
    e.cd = std::move(others);
  }

  void number_blocks() {
    for (Pair& p : e.pairs) {
      if (p.rr || p.rx || p.xr) p.with_r = e.pairs_with_r++;
    }
    e.body_own.assign(index(e.nb), -1);
    for (std::size_t b = 0; b < e.body_own.size(); ++b) {
      if (e.body_rx[b]) e.body_own[b] = e.bodies_own++;
    }
  }

  // Ground vectors do not move: they go to the end and are evaluated once.
  void sort_markers() {
    std::vector<int> order(e.markers.size()), place(e.markers.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
    const auto body_of = [&](int k) { return static_cast<unsigned>(e.markers[index(k)].body); };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return body_of(a) < body_of(b); });
    std::vector<Marker> sorted;
    sorted.reserve(order.size());
    for (int k : order) {
      place[index(k)] = static_cast<int>(sorted.size());
      sorted.push_back(e.markers[index(k)]);
    }
    e.markers = std::move(sorted);
    e.ground_markers = static_cast<int>(
        std::count_if(e.markers.begin(), e.markers.end(), [](const Marker& m) { return m.body != kGround; }));
    const auto move = [&](auto&... marker) { ((marker = place[index(marker)]), ...); };
    for (auto& r : e.dp1) move(r.u, r.v);
    for (auto& r : e.alternates) move(r.normal.u, r.normal.v, r.alternate.u, r.alternate.v);
    for (auto& r : e.dp2) move(r.a, r.p, r.q);
    for (auto& r : e.d) move(r.p, r.q);
    for (auto& r : e.cd) move(r.p, r.q);
    for (auto& r : e.coincidences) move(r.p, r.q);
    for (auto& r : e.angle) move(r.a, r.b, r.v);
    for (auto& r : e.pfaffian) move(r.a, r.p, r.q);
    for (auto& s : e.springs) move(s.p, s.q);
    for (auto& s : e.torsions) move(s.a, s.b, s.c);
    for (auto& s : e.point_forces) move(s.p);
    for (auto& s : e.followed) move(s.a, s.b, s.c);
  }
};

Elements::Elements(std::shared_ptr<const Model> of, std::span<const int> dropped) : model(std::move(of)) {
  nb = static_cast<int>(model->bodies.size());
  body_rr.assign(model->bodies.size(), 0);
  body_rx.assign(model->bodies.size(), 0);
  right_sides.push_back({Expression(0.0), false});
  row_of.assign(model->rows.size(), -1);

  const std::size_t joints = model->groups.size();
  Builder build{*this, IndexTable(model->rows.size()), IndexTable(joints), IndexTable(joints), {}};
  for (std::size_t k = 0; k < model->rows.size(); ++k) {
    const int row = static_cast<int>(k);
    if (std::binary_search(dropped.begin(), dropped.end(), row)) continue;
    row_of[k] = rows;
    model_row.push_back(row);
    build.add(model->rows[k]);
  }
  build.join_coincidences();
  build.number_blocks();
  for (const Body& b : model->bodies) inertia.push_back({b.mass, b.inertia});
  for (const Spring& s : model->springs) {
    springs.push_back({law_of(s), s.i, s.j, build.marker(s.i, s.s_i), build.marker(s.j, s.s_j), s.length});
  }
  for (const TorsionElement& t : model->torsions) {
    const TorsionSpring& s = t.spring;
    torsions.push_back(
        {law_of(s), s.i, s.j, build.marker(s.i, t.a_i), build.marker(s.i, t.b_i), build.marker(s.j, t.c_j), s.angle});
  }
  for (const PointForce& f : model->point_forces) {
    point_forces.push_back({f.body, build.marker(f.body, f.point), {f.force[0], f.force[1], f.force[2]}, f.frame});
  }
  for (const Torque& f : model->torques) {
    torques.push_back({f.body, {f.torque[0], f.torque[1], f.torque[2]}, f.frame});
  }
  drags = model->drags;
  for (const FollowedAngle& f : model->followed)
    followed.push_back({build.marker(f.i, f.a_i), build.marker(f.i, f.b_i), build.marker(f.j, f.c_j)});
  build.sort_markers();
}

}  // namespace poinsot
