// A scene taken apart into what is computed: scalar constraint rows and force elements between bodies.
//
// Joints and drivers become rows of a few types (the paper's Table 1); points and axes that a scene gives globally are
// expressed in the body frames once, at the initial pose (core/joint_frames.h). Everything here is constant; a Model is
// shared between threads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene.h"

namespace poinsot {

// The paper's four, and two more of the same make: `angle` is the dot product u·v of the direction
// u = A_i (−sin f a_i + cos f b_i), turning with the prescribed angle f(t), and v = A_j a_j (no row is singular);
// `pfaffian` is a_j·ḋ = f.
enum class RowType { DP1, DP2, D, CD, angle, pfaffian };

struct Row {
  RowType type = RowType::DP1;
  int i = kGround, j = kGround;
  Vector3 a_i = Vector3::Zero(), b_i = Vector3::Zero(), a_j = Vector3::Zero();
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();
  Vector3 c = Vector3::Zero();
  Expression f;
  bool squared = false;                                    // the right-hand side is f(t)², as for a driven distance
  std::shared_ptr<const Constraint::Alternate> alternate;  // few rows have one
  int group = 0;                                           // the constraint, joint or driver it belongs to
};

enum class GroupKind { constraint, joint, driver };

// What the scene calls one thing: a constraint, a joint, a driver. Its rows are consecutive.
struct Group {
  GroupKind kind = GroupKind::constraint;
  std::string name;
  std::string type;  // as the scene writes it: "DP1", "revolute", "angle"
  int i = kGround, j = kGround;
  int first_row = 0, rows = 0;
  Vector3 point_j = Vector3::Zero();  // m, where its reaction is given, in body j's frame
  bool body_fixed = false;            // a joint or an angle driver that says where it is apart from the initial pose
};

// A torsion spring with its reference directions: the angle of A_j c_j about `axis` from A_i a_i towards A_i b_i.
struct TorsionElement {
  TorsionSpring spring;
  Vector3 a_i = Vector3::Zero(), b_i = Vector3::Zero(), c_j = Vector3::Zero();
};

// The angle of A_j c_j about a_i × b_i from A_i a_i towards A_i b_i, of a joint. Its turns are counted; it applies no
// force.
struct FollowedAngle {
  int group = 0;
  int i = kGround, j = kGround;
  Vector3 a_i = Vector3::Zero(), b_i = Vector3::Zero(), c_j = Vector3::Zero();
};

// The angle of a driver or torsion spring for which the scene names no directions, on bodies that no joint keeps on an
// axis: it is that of a direction across the axis which had to be chosen, and others give other angles once it tilts.
struct OpenAngle {
  std::string of;  // "driver 'motor'"
  int i = kGround, j = kGround;
  Vector3 axis = Vector3::Zero();  // in body i's frame
};

struct Model {
  std::string name;
  Vector3 gravity = Vector3::Zero();
  std::vector<Body> bodies;  // with the initial state
  std::vector<Row> rows;     // grouped, groups in the order constraints, joints, drivers of the scene
  std::vector<Group> groups;
  std::vector<JointFrames> joints;  // complete, of unit length, in the order of the groups that are joints

  std::vector<PointForce> point_forces;
  std::vector<Torque> torques;
  std::vector<Spring> springs;
  std::vector<TorsionElement> torsions;
  std::vector<LinearDrag> drags;
  std::vector<CallbackForce> callbacks;

  std::vector<OpenAngle> open_angles;
  std::vector<FollowedAngle> followed;  // none, unless signals are asked for (integrators/signals.h)
};

// visit(group, frames) for every joint.
template <class Visit>
void for_each_joint(const Model& model, Visit&& visit) {
  auto frames = model.joints.begin();
  for (const Group& group : model.groups)
    if (group.kind == GroupKind::joint) visit(group, *frames++);
}

// Of a point s of a body's frame, or of the ground's, at the pose that the scene gives.
Vector3 initial_point(const Model& model, int body, const Vector3& s);

// Whether rows stand in for others where those are singular.
bool has_alternates(const Model& model);

// Of the rows' points from the frames of their bodies, m; of those on the ground where bodies have none, 1 if neither.
double longest_arm(const Model& model);

// Throws InputError where the scene breaks a rule of core/scene_validation.h. Names are given to what has none,
// axes are normalized, inertias and orientations given to a few digits made symmetric and orthogonal.
Model compile(const Scene& scene);

// "constraint 'driver'", "joint 'revolute1' (its row 4 of 5)": how messages speak of a group and of a row.
std::string describe_group(const Model& model, int group);
std::string describe_row(const Model& model, int row);

}  // namespace poinsot
