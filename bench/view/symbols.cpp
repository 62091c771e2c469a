#include "bench/view/symbols.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <utility>

#include "core/index.h"
#include "core/scene_types.h"

namespace poinsot::view {
namespace {

constexpr double kSame = 1e-6;  // relative: files give a few digits

bool same_point(const Vector3& a, const Vector3& b) {
  return (a - b).norm() <= kSame * std::max(1e-3, std::max(a.norm(), b.norm()));
}
bool parallel(const Vector3& a, const Vector3& b) {
  return a.cross(b).norm() <= kSame * a.norm() * b.norm();
}
bool stands_still(const Row& row) {
  return row.f.is_constant() && row.f.at(0.0).f == 0;
}

// A row as seen from the body `first`: what is on it comes first.
struct Seen {
  RowType type;
  Vector3 a, s, other_a, other_s;
};

// A joint between two bodies from rows; no type where they make none.
JointSymbol joint_of(std::span<const Seen> rows, int first, int second) {
  JointSymbol joint{"", "", first, second};  // with axes of zeros where it has none
  std::vector<const Seen*> directions;
  int coincident = 0, on_axis = 0;
  for (const Seen& row : rows) {
    if (row.type == RowType::DP1) {
      directions.push_back(&row);
      continue;
    }
    joint.s_i = row.s, joint.s_j = row.other_s;
    ++(row.type == RowType::CD ? coincident : on_axis);
  }
  // The axis is what two direction rows share on one body; on the other they span the plane normal to it.
  bool axis = false;
  for (const Seen* x : directions) {
    for (const Seen* y : directions) {
      if (x >= y || axis) continue;
      if (parallel(x->other_a, y->other_a) && !parallel(x->a, y->a)) {
        joint.axis_j = x->other_a.normalized();
        joint.axis_i = x->a.cross(y->a).normalized();
        axis = true;
      } else if (parallel(x->a, y->a) && !parallel(x->other_a, y->other_a)) {
        joint.axis_i = x->a.normalized();
        joint.axis_j = x->other_a.cross(y->other_a).normalized();
        axis = true;
      }
    }
  }
  const std::size_t turns = directions.size();
  const auto type = [](JointType t) { return std::string(type_name(t)); };
  if (coincident == 3) {
    if (turns == 0) joint.type = type(JointType::spherical);
    if (turns == 1) {
      joint.type = type(JointType::universal);
      joint.axis_i = directions[0]->a.normalized(), joint.axis_j = directions[0]->other_a.normalized();
    }
    if (turns == 2 && axis) joint.type = type(JointType::revolute);
    if (turns == 3 && axis) joint.type = type(JointType::fixed);
  } else if (coincident == 0 && on_axis == 2 && axis) {
    if (turns == 2) joint.type = type(JointType::cylindrical);
    if (turns == 3) joint.type = type(JointType::translational);
  }
  return joint;
}

Seen seen_from_i(const Row& row) {
  return {row.type, row.a_i, row.s_i, row.a_j, row.s_j};
}
Seen seen_from_j(const Row& row) {
  return {row.type, row.a_j, row.s_j, row.a_i, row.s_i};
}

// Joints that the bare constraints make, in the order in which their points come in the scene.
void joints_of_constraints(const Model& model, std::vector<JointSymbol>& joints) {
  const auto bare = [&](const Row& row) {
    return model.groups[index(row.group)].kind == GroupKind::constraint && stands_still(row);
  };
  std::vector<const Row*> points, directions;
  for (const Row& row : model.rows) {
    if (!bare(row)) continue;
    if (row.type == RowType::CD || row.type == RowType::DP2) points.push_back(&row);
    if (row.type == RowType::DP1 && !row.alternate) directions.push_back(&row);
  }
  std::vector<bool> taken(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (taken[k]) continue;
    const Row& at = *points[k];
    std::vector<Seen> rows;
    for (std::size_t other = k; other < points.size(); ++other) {
      const Row& row = *points[other];
      if (row.type != at.type || row.i != at.i || row.j != at.j || !same_point(row.s_i, at.s_i) ||
          !same_point(row.s_j, at.s_j))
        continue;
      taken[other] = true;
      rows.push_back(seen_from_i(row));
    }
    for (const Row* row : directions) {
      if (row->i == at.i && row->j == at.j) rows.push_back(seen_from_i(*row));
      if (row->i == at.j && row->j == at.i) rows.push_back(seen_from_j(*row));
    }
    if (JointSymbol joint = joint_of(rows, at.i, at.j); !joint.type.empty()) {
      joint.name = model.groups[index(at.group)].name;
      joints.push_back(std::move(joint));
    }
  }
}

}  // namespace

Symbols symbols(const Model& model) {
  Symbols all;
  for (const Group& group : model.groups) {
    const std::span<const Row> rows(&model.rows[index(group.first_row)], index(group.rows));
    const Row& row = rows.front();
    if (group.kind == GroupKind::joint) {
      std::vector<Seen> of_joint;
      for (const Row& each : rows) of_joint.push_back(seen_from_i(each));
      JointSymbol joint = joint_of(of_joint, group.i, group.j);
      joint.type = group.type;
      joint.name = group.name;
      all.joints.push_back(std::move(joint));
    } else if (row.type == RowType::D) {
      all.lines.push_back({group.type, group.name, row.i, row.j, row.s_i, row.s_j});
    } else if (row.type == RowType::angle) {
      all.turns.push_back({group.type, group.name, row.i, row.j, row.a_i.cross(row.b_i)});
    }
  }
  joints_of_constraints(model, all.joints);
  for (const Spring& spring : model.springs)
    all.lines.push_back({type_name(Force(spring)), spring.name, spring.i, spring.j, spring.s_i, spring.s_j});
  for (const TorsionElement& torsion : model.torsions) {
    const TorsionSpring& spring = torsion.spring;
    all.turns.push_back({type_name(Force(spring)), spring.name, spring.i, spring.j, spring.axis});
  }
  return all;
}

std::vector<std::vector<Vector3>> attachment_points(const Model& model) {
  std::vector<std::vector<Vector3>> points(model.bodies.size());
  Eigen::AlignedBox3d whole;  // at the initial pose
  const auto global = [&](int body, const Vector3& s) { return initial_point(model, body, s); };
  const auto add = [&](int body, const Vector3& s) {
    whole.extend(global(body, s));
    if (body == kGround) return;
    std::vector<Vector3>& of = points[index(body)];
    if (std::none_of(of.begin(), of.end(), [&](const Vector3& p) { return same_point(p, s); })) of.push_back(s);
  };
  const auto add_ends = [&](const auto& line) {
    add(line.i, line.s_i);
    add(line.j, line.s_j);
  };
  for (const Body& body : model.bodies) whole.extend(body.position);
  for (const Row& row : model.rows) {
    if (row.type == RowType::D && row.i == kGround) whole.extend(row.s_i);
    if (row.type == RowType::D && row.j == kGround) whole.extend(row.s_j);
    if (row.type == RowType::DP2 || row.type == RowType::CD || row.type == RowType::pfaffian) add_ends(row);
  }
  for (const Spring& spring : model.springs) add_ends(spring);
  for (const PointForce& force : model.point_forces) add(force.body, force.point);
  const double size = whole.diagonal().norm();
  for (const Row& row : model.rows) {
    if (row.type != RowType::D) continue;
    if (row.s_i.norm() <= size || size == 0) add(row.i, row.s_i);
    if (row.s_j.norm() <= size || size == 0) add(row.j, row.s_j);
  }
  return points;
}

}  // namespace poinsot::view
