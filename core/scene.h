// A mechanism as its scene file says it: bodies, constraints, joints, drivers, forces, in SI units; nothing about how
// to solve it. Plain data: read by core/scene_reader.h, turned into rows and force elements by core/model.h.
//
// Conventions: bodies are numbered from 0 in scene order, the ground is `kGround`. Vectors ending in _i (_j) are given
// in the frame of body i (j); "global" is said where it is not. Orientation A takes body to global components.
//
// A scene needs no file: fill in a Scene and give it to simulate() (integrators/simulate.h) or compile().
//
//   Scene scene;
//   scene.gravity = {0, 0, -9.81};
//   Body rod;
//   rod.name = "rod", rod.mass = 1, rod.inertia = Vector3(0.001, 0.083, 0.083).asDiagonal();
//   rod.position = {0, 0.5, 0};
//   scene.bodies.push_back(rod);
//   Joint hinge;  // at the origin, about x, from the ground to body 0
//   hinge.i = kGround, hinge.j = 0, hinge.axis = {1, 0, 0};
//   scene.joints.push_back(hinge);
//   Torque motor;
//   motor.body = 0, motor.torque[0] = Expression::parse("2*sin(t)");
//   scene.forces.push_back(motor);
//
// What a program computes itself needs no expression: a CallbackForce is a function of time and of how bodies stand and
// move, a driver's value can be Expression::function() of time. No scene file holds these.
//
// Whatever takes a scene first holds it to the rules of core/scene_validation.h, those of scene files; what is broken
// is an InputError that names the place as a file would: "/joints/0/axis: found the zero vector, expected a direction".
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/body_state.h"
#include "core/expression.h"

namespace poinsot {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

inline constexpr int kGround = -1;

enum class ShapeType { box, cylinder, capsule, sphere, polyline };

// What a picture of the body shows, in its frame; no mass follows from it, and no motion.
struct Shape {
  ShapeType type = ShapeType::box;
  Vector3 at = Vector3::Zero();     // m, the centre
  Vector3 size = Vector3::Zero();   // m, edges along the body's axes: box
  double radius = 0;                // m: cylinder, capsule, sphere
  double length = 0;                // m: cylinder; capsule, without its caps
  Vector3 axis = Vector3::UnitZ();  // of any length: cylinder, capsule
  std::vector<Vector3> points;      // m: polyline
};

struct Body {
  std::string name;
  double mass = 0;                             // kg
  Matrix3 inertia = Matrix3::Zero();           // kg m², about the centre of mass, body frame, positive semidefinite
  Vector3 position = Vector3::Zero();          // m, of the centre of mass, global
  Matrix3 orientation = Matrix3::Identity();   // A; compile() takes the rotation nearest to what is given
  Vector3 velocity = Vector3::Zero();          // m/s, global
  Vector3 angular_velocity = Vector3::Zero();  // rad/s, body frame
  std::optional<Shape> shape;
};

// DP1: a_i·a_j = f   DP2: a_i·d = f   D: d·d = f   CD: c·d = f, with d = r_j + A_j s_j − r_i − A_i s_i
// pfaffian: a_j·ḋ = f, linear in the velocities and in general not integrable (a blade, a rolling edge)
enum class ConstraintType { DP1, DP2, D, CD, pfaffian };

struct Constraint {
  std::string name;  // empty, here and below: called by type and number, "DP11", "revolute2"
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

// A joint in the frames of its bodies: the same mechanism from whatever pose the file starts. Directions of any length.
struct JointFrames {
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();        // m, the joint's point on either body
  Vector3 axis_i = Vector3::Zero(), axis_j = Vector3::Zero();  // one axis, but for universal; not for spherical
  // Perpendicular to the axes: directions that coincide at angle 0. Of universal: a_i coincides with axis_j at angle 0
  // about axis_i, a_j with axis_i at angle 0 about axis_j. Translational and fixed need them; left out elsewhere, the
  // pose that the scene gives is that of angle 0.
  Vector3 a_i = Vector3::Zero(), a_j = Vector3::Zero();
};

struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  int i = kGround, j = kGround;
  std::optional<JointFrames> frames;  // in the place of what follows
  Vector3 point = Vector3::Zero();    // m, global, at the initial pose
  Vector3 axis = Vector3::Zero();    // global, at the initial pose, of any length: revolute, cylindrical, translational
  Vector3 axis_i = Vector3::Zero();  // as axis: universal, fixed in body i
  Vector3 axis_j = Vector3::Zero();  // as axis: universal, fixed in body j, perpendicular to axis_i
};

enum class DriverType { angle, distance };

struct Driver {
  std::string name;
  DriverType type = DriverType::angle;
  int i = kGround, j = kGround;
  Vector3 axis = Vector3::Zero();                        // of any length, in body i's frame: angle
  Vector3 a_i = Vector3::Zero(), a_j = Vector3::Zero();  // directions that coincide at angle 0; zero: the initial pose
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();  // m: distance
  Expression value;                                      // angle in rad, or length in m
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

// Whether one of the three components is a function of time, no constant.
inline bool any_moves(const Expression (&components)[3]) {
  return !components[0].is_constant() || !components[1].is_constant() || !components[2].is_constant();
}

// Pulls the points together with stiffness x + damping v, or law(x, v, t), where x = |d| − length and v = d|d|/dt.
struct Spring {
  std::string name;
  int i = kGround, j = kGround;
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();
  double stiffness = 0;           // N/m
  double damping = 0;             // N s/m
  double length = 0;              // m, unloaded
  std::optional<Expression> law;  // N; stands in the place of stiffness and damping, which are then 0
};

// Turns body j back with stiffness x + damping v, or law(x, v, t), where x = θ − angle, v = θ̇ and θ is the angle of j
// relative to i about an axis fixed in i, counted on over full turns.
struct TorsionSpring {
  std::string name;
  int i = kGround, j = kGround;
  Vector3 axis = Vector3::Zero();                        // of any length, in body i's frame
  Vector3 a_i = Vector3::Zero(), a_j = Vector3::Zero();  // directions that coincide at angle 0; zero: the initial pose
  double stiffness = 0;                                  // N m/rad
  double damping = 0;                                    // N m s/rad
  double angle = 0;                                      // rad, unloaded
  std::optional<Expression> law;                         // N m; as a spring's
};

// Force −translational · ṙ at the centre of mass and torque −rotational · ω.
struct LinearDrag {
  std::string name;
  int body = kGround;
  double translational = 0;  // N s/m
  double rotational = 0;     // N m s/rad
};

// What acts on one body.
struct Load {
  Vector3 force = Vector3::Zero();   // N, global, at the centre of mass
  Vector3 torque = Vector3::Zero();  // N m, body frame
};

// How loads vary, 6 rows for each body (force, torque) and 6 columns for each: with its position (δr, global, and the
// rotation θ in the body's frame, A becoming A exp(θ̃)), and with its velocity (δṙ, global, and δω, body frame).
struct LoadSensitivity {
  Eigen::MatrixXd position, velocity;
};

// Loads that a function of the program computes from time and from how the bodies listed stand and move (accelerations
// are not among what it is given); both spans are in the order of `bodies`, and loads come as zeros. It has to be
// smooth where error control is to keep its order; what it throws ends the run and comes out of simulate(). Several
// threads may call it at once where several runs share the scene.
//
// The matrices of Newton's method hold the sensitivity: `sensitivity` fills in what is not zero, and without it the
// loads are differenced, at 12 more calls a body and matrix: rounding leaves some eight digits of the derivatives,
// which costs Newton's method a fraction of an iteration and no accuracy. Energies do not count what a callback stores.
struct CallbackForce {
  std::string name;
  std::vector<int> bodies;  // different ones, none of them the ground
  std::function<void(double t, std::span<const BodyState> states, std::span<Load> loads)> loads;
  std::function<void(double t, std::span<const BodyState> states, LoadSensitivity& by)> sensitivity;  // may be empty
};

using Force = std::variant<PointForce, Torque, Spring, TorsionSpring, LinearDrag, CallbackForce>;

// A number that the expressions of a scene file call by name.
struct Parameter {
  std::string name;
  double value = 0;
  bool set = false;  // from outside, in the place of the file's (core/scene_reader.h)
};

struct Scene {
  std::string name, about;            // read from a file that says no name: that of the file
  Vector3 gravity = Vector3::Zero();  // m/s², global
  std::vector<Body> bodies;
  std::vector<Constraint> constraints;
  std::vector<Joint> joints;
  std::vector<Driver> drivers;
  std::vector<Force> forces;

  // Of a scene that was read: what its expressions were read with, and the text that is this scene. Parameters that
  // were set stand in that text with what they were set to, tables with their points: it needs no other file.
  std::vector<Parameter> parameters;  // by name
  std::string source;                 // empty where it was not read
  std::vector<std::string> notices;   // what reading it came upon: names that nothing uses
};

}  // namespace poinsot
