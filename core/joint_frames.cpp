#include "core/joint_frames.h"

#include <Eigen/Geometry>

namespace poinsot {
namespace {

// Between the global frame and those of bodies at the initial pose; the ground's frame is the global one.
class InitialPose {
 public:
  explicit InitialPose(const std::vector<Body>& bodies) : bodies_(bodies) {}

  Vector3 direction_in(int body, const Vector3& global) const {
    if (body == kGround) return global;
    return at(body).orientation.transpose() * global;
  }
  Vector3 direction_from(int body, const Vector3& local) const {
    if (body == kGround) return local;
    return at(body).orientation * local;
  }
  Vector3 point_in(int body, const Vector3& global) const {
    if (body == kGround) return global;
    return direction_in(body, global - at(body).position);
  }

 private:
  const Body& at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

  const std::vector<Body>& bodies_;
};

bool given(const Vector3& direction) {
  return !direction.isZero(0);
}

JointFrames from_global(const Joint& j, const InitialPose& pose) {
  JointFrames f;
  f.s_i = pose.point_in(j.i, j.point);
  f.s_j = pose.point_in(j.j, j.point);
  if (j.type == JointType::spherical) return f;
  if (j.type == JointType::universal) {
    const Vector3 i = j.axis_i.stableNormalized(), k = j.axis_j.stableNormalized();
    f.axis_i = pose.direction_in(j.i, i);
    f.axis_j = pose.direction_in(j.j, k);
    f.a_i = pose.direction_in(j.i, across(i, k));
    f.a_j = pose.direction_in(j.j, across(k, i));
    return f;
  }
  const bool fixed = j.type == JointType::fixed;
  const Vector3 axis = fixed ? Vector3(Vector3::UnitZ()) : j.axis.stableNormalized();
  const Vector3 a = fixed ? Vector3(Vector3::UnitX()) : perpendiculars(axis).first;
  f.axis_i = pose.direction_in(j.i, axis);
  f.axis_j = pose.direction_in(j.j, axis);
  f.a_i = pose.direction_in(j.i, a);
  f.a_j = pose.direction_in(j.j, a);
  return f;
}

JointFrames from_bodies(const Joint& j, const InitialPose& pose) {
  JointFrames f = *j.frames;
  if (j.type == JointType::spherical) return f;
  f.axis_i.stableNormalize();
  f.axis_j.stableNormalize();
  if (given(f.a_i)) {
    f.a_i = across(f.axis_i, f.a_i);
    f.a_j = across(f.axis_j, f.a_j);
  } else if (j.type == JointType::universal) {
    f.a_i = across(f.axis_i, pose.direction_in(j.i, pose.direction_from(j.j, f.axis_j)));
    f.a_j = across(f.axis_j, pose.direction_in(j.j, pose.direction_from(j.i, f.axis_i)));
  } else {
    f.a_i = perpendiculars(f.axis_i).first;
    f.a_j = across(f.axis_j, pose.direction_in(j.j, pose.direction_from(j.i, f.a_i)));
  }
  return f;
}

}  // namespace

std::pair<Vector3, Vector3> perpendiculars(const Vector3& axis) {
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Vector3 a = axis.cross(Vector3::Unit(smallest)).normalized();
  return {a, axis.cross(a)};
}

Vector3 across(const Vector3& axis, const Vector3& a) {
  const Vector3 direction = a.stableNormalized(), part = direction - axis.dot(direction) * axis;
  constexpr double kAlong = 1e-8;  // a rough pose may have the direction along the axis: then any is as good
  return part.norm() > kAlong ? part.normalized() : perpendiculars(axis).first;
}

JointFrames complete_frames(const Joint& joint, const std::vector<Body>& bodies) {
  const InitialPose pose(bodies);
  return joint.frames ? from_bodies(joint, pose) : from_global(joint, pose);
}

template <class Item>
AngleFrame angle_frame(const Item& item, const std::vector<Body>& bodies, const Vector3& across_j) {
  const Vector3 axis = item.axis.stableNormalized();
  if (given(item.a_i)) {
    const Vector3 a = across(axis, item.a_i);
    return {a, axis.cross(a), item.a_j.stableNormalized()};
  }
  const InitialPose pose(bodies);
  if (given(across_j)) {
    const Vector3 a = across(axis, pose.direction_in(item.i, pose.direction_from(item.j, across_j)));
    return {a, axis.cross(a), across_j};
  }
  const auto [a, b] = perpendiculars(axis);
  return {a, b, pose.direction_in(item.j, pose.direction_from(item.i, a))};
}
template AngleFrame angle_frame(const Driver& item, const std::vector<Body>& bodies, const Vector3& across_j);
template AngleFrame angle_frame(const TorsionSpring& item, const std::vector<Body>& bodies, const Vector3& across_j);

}  // namespace poinsot
