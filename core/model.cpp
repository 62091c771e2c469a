#include "core/model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "core/check.h"
#include "core/joint_frames.h"
#include "core/nearest_rotation.h"
#include "core/places.h"
#include "core/scene_names.h"
#include "core/scene_types.h"
#include "core/scene_validation.h"

namespace poinsot {
namespace {

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
    constexpr std::size_t kMostRows = 6;  // of a joint
    const std::size_t joints = scene_.joints.size(), others = scene_.constraints.size() + scene_.drivers.size();
    model_.rows.reserve(kMostRows * joints + others);
    model_.groups.reserve(joints + others);
    model_.joints.reserve(joints);
    for (const Constraint& c : scene_.constraints) constraint(c);
    for (const Joint& j : scene_.joints) joint(j);
    for (const Driver& d : scene_.drivers) driver(d);
    for (const Force& f : scene_.forces) {
      std::visit([&](auto force) { force.name = force_names_.next(f), add(force); }, f);
    }
    return std::move(model_);
  }

 private:
  template <class Item>
  void begin(GroupKind kind, const Item& item, const Vector3& point_j) {
    model_.groups.push_back(
        {kind, row_names_.next(item), type_of(item), item.i, item.j, static_cast<int>(model_.rows.size()), 0, point_j});
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

  // The paper's Table 1.
  void joint(const Joint& j) {
    const JointFrames& f = model_.joints.emplace_back(complete_frames(j, model_.bodies));
    begin(GroupKind::joint, j, f.s_j);
    model_.groups.back().body_fixed = j.frames.has_value();
    switch (j.type) {
      case JointType::revolute:
        coincident(f);
        parallel(f);
        hold_axis(f);
        break;
      case JointType::spherical:
        coincident(f);
        break;
      case JointType::universal:
        coincident(f);
        perpendicular(f.axis_i, f.axis_j);
        hold(f.axis_i, f.axis_j);
        break;
      case JointType::cylindrical:
        parallel(f);
        on_axis(f);
        hold_axis(f);
        break;
      case JointType::translational:
        parallel(f);
        on_axis(f);
        perpendicular(f.a_i, f.axis_j.cross(f.a_j));
        hold_axis(f);
        break;
      case JointType::fixed:
        coincident(f);
        parallel(f);
        perpendicular(f.a_i, f.axis_j.cross(f.a_j));
        break;
    }
  }

  // 3 CD: the joint's point is the same on both bodies.
  void coincident(const JointFrames& f) {
    for (int k = 0; k < 3; ++k) {
      Row& r = row(RowType::CD);
      r.c = Vector3::Unit(k);
      r.s_i = f.s_i;
      r.s_j = f.s_j;
    }
  }

  // DP1 between a direction of body i and one of body j.
  void perpendicular(const Vector3& on_i, const Vector3& on_j) {
    Row& r = row(RowType::DP1);
    r.a_i = on_i;
    r.a_j = on_j;
  }

  // 2 DP1, the paper's perpendicular 1: the axis on body j stays normal to a plane of body i.
  void parallel(const JointFrames& f) {
    perpendicular(f.a_i, f.axis_j);
    perpendicular(f.axis_i.cross(f.a_i), f.axis_j);
  }

  // 2 DP2, the paper's perpendicular 2: the point of body j stays on the axis through that of body i.
  void on_axis(const JointFrames& f) {
    for (const Vector3& normal : {f.a_i, Vector3(f.axis_i.cross(f.a_i))}) {
      Row& r = row(RowType::DP2);
      r.a_i = normal;
      r.s_i = f.s_i;
      r.s_j = f.s_j;
    }
  }

  // Of the joint begun last: what an angle between its bodies may be that of.
  void hold(const Vector3& axis_i, const Vector3& axis_j) {
    const Group& joint = model_.groups.back();
    held_.emplace(std::pair(joint.i, joint.j), Held{axis_i, axis_j});
    held_.emplace(std::pair(joint.j, joint.i), Held{axis_j, axis_i});
  }
  void hold_axis(const JointFrames& f) {
    const Group& joint = model_.groups.back();
    held_.emplace(std::pair(joint.i, joint.j), Held{f.axis_i, Vector3::Zero()});
    held_.emplace(std::pair(joint.j, joint.i), Held{f.axis_j, Vector3::Zero()});
  }

  // The directions of an angle. About one axis of a universal joint it is that of the other one, which stays across; on
  // a hinge any serves.
  template <class Item>
  AngleFrame directions(const Item& item, std::string_view kind, const std::string& name) {
    constexpr double kSame = 1e-6;
    const Vector3 axis = item.axis.stableNormalized();
    Vector3 across = Vector3::Zero();
    bool open = item.a_i.isZero(0);
    const auto [first, last] = held_.equal_range({item.i, item.j});
    for (auto at = first; at != last; ++at) {
      if (at->second.axis.cross(axis).norm() > kSame) continue;
      open = false;
      if (!at->second.across.isZero(0)) across = at->second.across;
    }
    if (open) model_.open_angles.push_back({fmt::format("{} '{}'", kind, name), item.i, item.j, axis});
    return angle_frame(item, model_.bodies, across);
  }

  void driver(const Driver& d) {
    if (d.type == DriverType::angle) {
      begin(GroupKind::driver, d, Vector3::Zero());
      model_.groups.back().body_fixed = !d.a_i.isZero(0);
      const AngleFrame frame = directions(d, "driver", model_.groups.back().name);
      Row& r = row(RowType::angle);
      r.a_i = frame.a_i, r.b_i = frame.b_i, r.a_j = frame.a_j;
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
  void add(const CallbackForce& force) { model_.callbacks.push_back(force); }
  void add(const TorsionSpring& spring) {
    TorsionElement element;
    element.spring = spring;
    element.spring.axis.stableNormalize();
    const AngleFrame frame = directions(spring, "torsion spring", spring.name);
    element.a_i = frame.a_i, element.b_i = frame.b_i, element.c_j = frame.a_j;
    model_.torsions.push_back(std::move(element));
  }

  const Scene& scene_;
  Model model_;
  ItemNames row_names_, force_names_;
  // Of joints by their bodies, from either: an axis of the first that is one of the second, or stays across one.
  struct Held {
    Vector3 axis, across;  // in their frames; zero: the same axis
  };
  std::multimap<std::pair<int, int>, Held> held_;
};

}  // namespace

Vector3 initial_point(const Model& model, int body, const Vector3& s) {
  if (body == kGround) return s;
  const Body& of = model.bodies[static_cast<std::size_t>(body)];
  return of.position + of.orientation * s;
}

bool has_alternates(const Model& model) {
  return std::ranges::any_of(model.rows, [](const Row& row) { return row.alternate != nullptr; });
}

double longest_arm(const Model& model) {
  double of_bodies = 0, of_ground = 0;
  for (const Row& row : model.rows) {
    for (const auto& [body, arm] : {std::pair{row.i, row.s_i.norm()}, std::pair{row.j, row.s_j.norm()}}) {
      double& longest = body == kGround ? of_ground : of_bodies;
      longest = std::max(longest, arm);
    }
  }
  if (of_bodies > 0) return of_bodies;
  return of_ground > 0 ? of_ground : 1;
}

Model compile(const Scene& scene) {
  with_names_of_errors(scene, [&] { validate(scene); });
  return Compiler(scene).run();
}

std::string describe_group(const Model& model, int group) {
  static constexpr const char* kKinds[] = {"constraint", "joint", "driver"};
  const Group& of = model.groups[static_cast<std::size_t>(group)];
  return fmt::format("{} '{}'", kKinds[static_cast<int>(of.kind)], of.name);
}

std::string describe_row(const Model& model, int row) {
  check(row >= 0 && row < static_cast<int>(model.rows.size()), "the row is one of the model's");
  const int of = model.rows[static_cast<std::size_t>(row)].group;
  const Group& group = model.groups[static_cast<std::size_t>(of)];
  std::string text = describe_group(model, of);
  if (group.rows > 1) text += fmt::format(" (its row {} of {})", row - group.first_row + 1, group.rows);
  return text;
}

}  // namespace poinsot
