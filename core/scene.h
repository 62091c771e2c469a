// A mechanism as its scene file says it: bodies, constraints, joints, drivers, forces, in SI units; nothing about how
// to solve it. Plain data: read by core/scene_reader.h, turned into rows and force elements by core/model.h.
//
// Conventions: bodies are numbered from 0 in scene order, the ground is `kGround`. Vectors ending in _i (_j) are given
// in the frame of body i (j); "global" is said where it is not. Orientation A takes body to global components.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/expression.h"

namespace poinsot {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

inline constexpr int kGround = -1;

struct Body {
  std::string name;
  double mass = 0;                             // kg
  Matrix3 inertia = Matrix3::Zero();           // kg m², about the centre of mass, body frame, positive semidefinite
  Vector3 position = Vector3::Zero();          // m, of the centre of mass, global
  Matrix3 orientation = Matrix3::Identity();   // A, on SO(3) to rounding (projected on loading)
  Vector3 velocity = Vector3::Zero();          // m/s, global
  Vector3 angular_velocity = Vector3::Zero();  // rad/s, body frame
};

// DP1: a_i·a_j = f   DP2: a_i·d = f   D: d·d = f   CD: c·d = f, with d = r_j + A_j s_j − r_i − A_i s_i
// pfaffian: a_j·ḋ = f, linear in the velocities and in general not integrable (a blade, a rolling edge)
enum class ConstraintType { DP1, DP2, D, CD, pfaffian };

struct Constraint {
  std::string name;
  ConstraintType type = ConstraintType::DP1;
  int i = kGround, j = kGround;
  Vector3 a_i = Vector3::Zero(), a_j = Vector3::Zero();  // directions: DP1 both, DP2 a_i, pfaffian a_j
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();  // m, points: DP2, D, CD, pfaffian
  Vector3 c = Vector3::Zero();                           // global direction: CD
  Expression f;

  // Stands in for (a_i, a_j, f) of a DP1 while |f| > 0.9, where the row of the constraint itself all but vanishes.
  struct Alternate {
    Vector3 a_i, a_j;
    Expression f;
  };
  std::optional<Alternate> alternate;
};

enum class JointType { revolute, spherical, universal, cylindrical, translational, fixed };

struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  int i = kGround, j = kGround;
  Vector3 point = Vector3::Zero();   // m, global, at the initial pose
  Vector3 axis = Vector3::Zero();    // unit, global, at the initial pose: revolute, cylindrical, translational
  Vector3 axis_i = Vector3::Zero();  // unit, global, at the initial pose: universal, fixed in body i
  Vector3 axis_j = Vector3::Zero();  // unit, global, at the initial pose: universal, fixed in body j
};

enum class DriverType { angle, distance };

struct Driver {
  std::string name;
  DriverType type = DriverType::angle;
  int i = kGround, j = kGround;
  Vector3 axis = Vector3::Zero();                        // unit, in body i's frame: angle
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();  // m: distance
  Expression value;                                      // angle in rad from the initial pose, or length in m
};

enum class Frame { global, body };

struct PointForce {
  std::string name;
  int body = kGround;
  Vector3 point = Vector3::Zero();  // m, body frame
  Expression force[3];              // N
  Frame frame = Frame::global;
};

struct Torque {
  std::string name;
  int body = kGround;
  Expression torque[3];  // N m
  Frame frame = Frame::body;
};

// Pulls the points together with stiffness (|d| − length) + damping d|d|/dt.
struct Spring {
  std::string name;
  int i = kGround, j = kGround;
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();
  double stiffness = 0;  // N/m
  double damping = 0;    // N s/m
  double length = 0;     // m, unloaded
};

// Turns body j back with stiffness (angle − rest angle) + damping · rate; the angle of j relative to i about an axis
// fixed in i, from the initial pose, counted on over full turns.
struct TorsionSpring {
  std::string name;
  int i = kGround, j = kGround;
  Vector3 axis = Vector3::Zero();  // unit, in body i's frame
  double stiffness = 0;            // N m/rad
  double damping = 0;              // N m s/rad
  double angle = 0;                // rad, unloaded
};

// Force −translational · ṙ at the centre of mass and torque −rotational · ω.
struct LinearDrag {
  std::string name;
  int body = kGround;
  double translational = 0;  // N s/m
  double rotational = 0;     // N m s/rad
};

using Force = std::variant<PointForce, Torque, Spring, TorsionSpring, LinearDrag>;

struct Scene {
  std::string name, about;
  Vector3 gravity = Vector3::Zero();  // m/s², global
  std::vector<Body> bodies;
  std::vector<Constraint> constraints;
  std::vector<Joint> joints;
  std::vector<Driver> drivers;
  std::vector<Force> forces;

  std::string source;  // the text it was read from, for the run record
};

}  // namespace poinsot
