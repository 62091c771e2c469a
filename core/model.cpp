#include "core/model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <tuple>
#include <utility>

#include "core/check.h"
#include "core/nearest_rotation.h"
#include "core/scene_names.h"
#include "core/scene_types.h"
#include "core/scene_validation.h"

namespace poinsot {
namespace {

// Two directions that make a right-handed orthonormal frame (a, b, axis).
std::pair<Vector3, Vector3> perpendiculars(const Vector3& axis) {
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Vector3 a = axis.cross(Vector3::Unit(smallest)).normalized();
  return {a, axis.cross(a)};
}

class Compiler {
 public:
  explicit Compiler(const Scene& scene) : scene_(scene) {}

  Model run() {
    model_.name = scene_.name;
    model_.gravity = scene_.gravity;
    model_.bodies = scene_.bodies;
    for (Body& body : model_.bodies) {  // what was given to a few digits
      body.inertia = (0.5 * body.inertia + 0.5 * body.inertia.transpose()).eval();
      body.orientation = nearest_rotation(body.orientation);
    }
    for (const Constraint& c : scene_.constraints) constraint(c);
    for (const Joint& j : scene_.joints) joint(j);
    for (const Driver& d : scene_.drivers) driver(d);
    for (const Force& f : scene_.forces) {
      std::visit([&](auto force) { force.name = force_names_.next(force.name, type_name(f)), add(force); }, f);
    }
    return std::move(model_);
  }

 private:
  // The ground's frame is the global one.
  Vector3 direction_in(int body, const Vector3& global) const {
    if (body == kGround) return global;
    return model_.bodies[static_cast<std::size_t>(body)].orientation.transpose() * global;
  }
  Vector3 direction_from(int body, const Vector3& local) const {
    if (body == kGround) return local;
    return model_.bodies[static_cast<std::size_t>(body)].orientation * local;
  }
  Vector3 point_in(int body, const Vector3& global) const {
    if (body == kGround) return global;
    return direction_in(body, global - model_.bodies[static_cast<std::size_t>(body)].position);
  }

  template <class Item>
  void begin(GroupKind kind, const Item& item, const Vector3& point_j) {
    const char* type = type_name(item.type);
    model_.groups.push_back({kind, row_names_.next(item.name, type), type, item.i, item.j,
                             static_cast<int>(model_.rows.size()), 0, point_j});
  }

  // A row of the group begun last.
  Row& row(RowType type) {
    Group& group = model_.groups.back();
    ++group.rows;
    Row& row = model_.rows.emplace_back();
    row.type = type;
    row.i = group.i;
    row.j = group.j;
    row.group = static_cast<int>(model_.groups.size()) - 1;
    return row;
  }

  void constraint(const Constraint& c) {
    static constexpr RowType kRows[] = {RowType::DP1, RowType::DP2, RowType::D, RowType::CD, RowType::pfaffian};
    begin(GroupKind::constraint, c, c.s_j);
    Row& r = row(kRows[static_cast<std::size_t>(c.type)]);
    r.a_i = c.a_i, r.a_j = c.a_j;
    r.s_i = c.s_i, r.s_j = c.s_j;
    r.c = c.c;
    r.f = c.f;
    if (c.alternate) r.alternate = std::make_shared<const Constraint::Alternate>(*c.alternate);
  }

  // The paper's Table 1. `axis` is global, at the initial pose, like everything a joint says.
  void joint(const Joint& j) {
    begin(GroupKind::joint, j, point_in(j.j, j.point));
    switch (j.type) {
      case JointType::revolute:
        coincident(j);
        parallel(j, j.axis.stableNormalized());
        break;
      case JointType::spherical:
        coincident(j);
        break;
      case JointType::universal:
        coincident(j);
        perpendicular(j, j.axis_i.stableNormalized(), j.axis_j.stableNormalized());
        break;
      case JointType::cylindrical: {
        const Vector3 axis = j.axis.stableNormalized();
        parallel(j, axis);
        on_axis(j, axis);
        break;
      }
      case JointType::translational: {
        const Vector3 axis = j.axis.stableNormalized();
        parallel(j, axis);
        on_axis(j, axis);
        const auto [a, b] = perpendiculars(axis);
        perpendicular(j, a, b);
        break;
      }
      case JointType::fixed:
        coincident(j);
        parallel(j, Vector3::UnitZ());
        perpendicular(j, Vector3::UnitX(), Vector3::UnitY());
        break;
    }
  }

  // 3 CD: the joint's point is the same on both bodies.
  void coincident(const Joint& j) {
    for (int k = 0; k < 3; ++k) {
      Row& r = row(RowType::CD);
      r.c = Vector3::Unit(k);
      r.s_i = point_in(j.i, j.point);
      r.s_j = point_in(j.j, j.point);
    }
  }

  // DP1 between a global direction taken along by body i and one taken along by body j.
  void perpendicular(const Joint& j, const Vector3& on_i, const Vector3& on_j) {
    Row& r = row(RowType::DP1);
    r.a_i = direction_in(j.i, on_i);
    r.a_j = direction_in(j.j, on_j);
  }

  // 2 DP1, the paper's perpendicular 1: the axis on body j stays normal to a plane of body i.
  void parallel(const Joint& j, const Vector3& axis) {
    const auto [a, b] = perpendiculars(axis);
    perpendicular(j, a, axis);
    perpendicular(j, b, axis);
  }

  // 2 DP2, the paper's perpendicular 2: the point of body j stays on the axis through that of body i.
  void on_axis(const Joint& j, const Vector3& axis) {
    const auto [a, b] = perpendiculars(axis);
    for (const Vector3& normal : {a, b}) {
      Row& r = row(RowType::DP2);
      r.a_i = direction_in(j.i, normal);
      r.s_i = point_in(j.i, j.point);
      r.s_j = point_in(j.j, j.point);
    }
  }

  void driver(const Driver& d) {
    if (d.type == DriverType::angle) {
      begin(GroupKind::driver, d, Vector3::Zero());
      Row& r = row(RowType::angle);
      std::tie(r.a_i, r.b_i) = perpendiculars(d.axis.stableNormalized());
      r.a_j = direction_in(d.j, direction_from(d.i, r.a_i));
      r.f = d.value;
    } else {
      begin(GroupKind::driver, d, d.s_j);
      Row& r = row(RowType::D);
      r.s_i = d.s_i, r.s_j = d.s_j;
      r.f = d.value;
      r.squared = true;
    }
  }

  void add(const PointForce& force) { model_.point_forces.push_back(force); }
  void add(const Torque& torque) { model_.torques.push_back(torque); }
  void add(const Spring& spring) { model_.springs.push_back(spring); }
  void add(const LinearDrag& drag) { model_.drags.push_back(drag); }
  void add(const TorsionSpring& spring) {
    TorsionElement element;
    element.spring = spring;
    element.spring.axis.stableNormalize();
    std::tie(element.a_i, element.b_i) = perpendiculars(element.spring.axis);
    element.c_j = direction_in(spring.j, direction_from(spring.i, element.a_i));
    model_.torsions.push_back(std::move(element));
  }

  const Scene& scene_;
  Model model_;
  ItemNames row_names_, force_names_;
};

}  // namespace

Model compile(const Scene& scene) {
  validate(scene);
  return Compiler(scene).run();
}

std::string describe_row(const Model& model, int row) {
  check(row >= 0 && row < static_cast<int>(model.rows.size()), "the row is one of the model's");
  const Group& group = model.groups[static_cast<std::size_t>(model.rows[static_cast<std::size_t>(row)].group)];
  static constexpr const char* kKinds[] = {"constraint", "joint", "driver"};
  std::string text = fmt::format("{} '{}'", kKinds[static_cast<int>(group.kind)], group.name);
  if (group.rows > 1) text += fmt::format(" (its row {} of {})", row - group.first_row + 1, group.rows);
  return text;
}

}  // namespace poinsot
