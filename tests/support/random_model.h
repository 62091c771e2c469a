// Seeded random models: bodies with full inertia tensors, constraint rows of every kind, forces of every type.
//
// Nothing has to be assembled or even solvable: derivatives exist at every state.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "core/so3.h"

namespace poinsot::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  double normal() { return std::normal_distribution<double>()(engine_); }
  int integer(int a, int b) { return std::uniform_int_distribution<int>(a, b)(engine_); }
  Vector3 vector() { return {normal(), normal(), normal()}; }
  Vector3 unit() { return vector().normalized(); }
  Eigen::VectorXd vector(int n) {
    return Eigen::VectorXd::NullaryExpr(n, [this] { return normal(); });
  }

  // A rotation vector: any, next to zero, or next to a half turn.
  Vector3 rotation_vector() {
    switch (integer(0, 3)) {
      case 0:
        return unit() * uniform(0, 1e-7);
      case 1:
        return unit() * (std::numbers::pi - uniform(0, 1e-7));
      default:
        return unit() * uniform(0, std::numbers::pi);
    }
  }
  Matrix3 rotation() { return exp_so3<double>(rotation_vector()); }

  // Positive definite, no axis principal.
  Matrix3 inertia() {
    Matrix3 half;
    for (int k = 0; k < 3; ++k) half.col(k) = vector();
    return half * half.transpose() + 0.1 * Matrix3::Identity();
  }

  // a + b sin(c t + d) + e t², in the grammar of scenes.
  Expression function(double offset = 0) {
    const auto number = [&] { return "(" + std::to_string(normal()) + ")"; };
    return Expression::parse(std::to_string(offset) + "+" + number() + "*sin(" + number() + "*t+" + number() + ")+" +
                             number() + "*t^2");
  }

  BodyState state() {
    BodyState s;
    s.r = vector(), s.rd = vector();
    s.A = rotation(), s.w = 2 * vector();
    return s;
  }

 private:
  std::mt19937_64 engine_;
};

inline Model random_bodies(Random& random, int count) {
  Model model;
  model.name = "random";
  model.gravity = random.vector();
  for (int b = 0; b < count; ++b) {
    Body body;
    body.name = "body" + std::to_string(b);
    body.mass = random.uniform(0.5, 2);
    body.inertia = random.inertia();
    model.bodies.push_back(body);
  }
  return model;
}

inline constexpr RowType kRowTypes[] = {RowType::DP1, RowType::DP2,   RowType::D,
                                        RowType::CD,  RowType::angle, RowType::pfaffian};
inline constexpr const char* kRowNames[] = {"DP1", "DP2", "D", "CD", "angle", "pfaffian"};

// A row with everything random, in a group of its own.
inline void add_row(Model& model, RowType type, int i, int j, Random& random) {
  Row row;
  row.type = type;
  row.i = i, row.j = j;
  row.a_i = random.unit();
  row.b_i = type == RowType::angle ? Vector3(row.a_i.unitOrthogonal()) : random.unit();
  row.a_j = random.unit();
  row.s_i = random.vector(), row.s_j = random.vector();
  row.c = random.unit();
  row.f = random.function();
  row.squared = type == RowType::D && random.integer(0, 1) == 1;
  if (row.squared) row.f = Expression::parse("exp(0.3*(" + row.f.text() + "))");  // a length
  row.group = static_cast<int>(model.groups.size());
  Group group;
  const std::string type_name = kRowNames[static_cast<int>(type)];
  group.name = type_name + std::to_string(model.rows.size());
  group.type = type_name;
  group.i = i, group.j = j;
  group.first_row = static_cast<int>(model.rows.size());
  group.rows = 1;
  group.point_j = row.s_j;
  model.rows.push_back(row);
  model.groups.push_back(group);
}

// Three rows in a group: a point of i and one of j coincide, as in most joints.
inline void add_coincidence(Model& model, int i, int j, Random& random) {
  const Vector3 s_i = random.vector(), s_j = random.vector();
  for (int axis = 0; axis < 3; ++axis) {
    add_row(model, RowType::CD, i, j, random);
    Row& row = model.rows.back();
    row.s_i = s_i, row.s_j = s_j;
    row.c = Vector3::Unit(axis);
    row.f = Expression(0.0);
  }
}

enum class ForceType {
  // clang-format off
  spring, damped_spring, spring_law, torsion, damped_torsion, torsion_law,
  force, body_force, torque, body_torque, drag
  // clang-format on
};
inline constexpr const char* kForceNames[] = {"spring",         "damped_spring", "spring_law", "torsion",
                                              "damped_torsion", "torsion_law",   "force",      "body_force",
                                              "torque",         "body_torque",   "drag"};
inline constexpr int kForceTypes = 11;

inline bool acts_between_two(ForceType type) {
  return type <= ForceType::torsion_law;
}

// Smooth, not linear in anything, with x and v together.
inline Expression random_law(Random& random) {
  return Expression::parse_law("3*sin(x) + 0.5*x^3 + 2*tanh(v)*(1 + x^2) + " + std::to_string(random.uniform(0.1, 1)) +
                               "*v*cos(x)");
}

// Types that act on one body act on j.
inline void add_force(Model& model, ForceType type, int i, int j, Random& random) {
  switch (type) {
    case ForceType::spring:
    case ForceType::damped_spring:
    case ForceType::spring_law: {
      Spring spring;
      spring.i = i, spring.j = j;
      spring.s_i = random.vector(), spring.s_j = random.vector();
      spring.stiffness = random.uniform(1, 5);
      spring.length = random.uniform(0.5, 2);
      if (type == ForceType::damped_spring) spring.damping = random.uniform(1, 5);
      if (type == ForceType::spring_law) spring.law = random_law(random), spring.stiffness = 0;
      model.springs.push_back(spring);
      break;
    }
    case ForceType::torsion:
    case ForceType::damped_torsion:
    case ForceType::torsion_law: {
      TorsionElement torsion;
      torsion.spring.i = i, torsion.spring.j = j;
      torsion.spring.stiffness = random.uniform(1, 5);
      torsion.spring.angle = random.normal();
      if (type == ForceType::damped_torsion) torsion.spring.damping = random.uniform(1, 5);
      if (type == ForceType::torsion_law) torsion.spring.law = random_law(random), torsion.spring.stiffness = 0;
      const Vector3 axis = random.unit();
      torsion.spring.axis = axis;
      torsion.a_i = axis.unitOrthogonal();
      torsion.b_i = axis.cross(torsion.a_i);
      torsion.c_j = random.unit();
      model.torsions.push_back(torsion);
      break;
    }
    case ForceType::force:
    case ForceType::body_force: {
      PointForce force;
      force.body = j;
      force.point = random.vector();
      for (Expression& component : force.force) component = random.function();
      force.frame = type == ForceType::body_force ? Frame::body : Frame::global;
      model.point_forces.push_back(force);
      break;
    }
    case ForceType::torque:
    case ForceType::body_torque: {
      Torque torque;
      torque.body = j;
      for (Expression& component : torque.torque) component = random.function();
      torque.frame = type == ForceType::body_torque ? Frame::body : Frame::global;
      model.torques.push_back(torque);
      break;
    }
    case ForceType::drag: {
      LinearDrag drag;
      drag.body = j;
      drag.translational = random.uniform(1, 5);
      drag.rotational = random.uniform(1, 5);
      model.drags.push_back(drag);
      break;
    }
  }
}

// The pairs of bodies a row or a force is tried on, in a model of two bodies.
inline constexpr std::pair<int, int> kPairs[] = {{kGround, 0}, {0, kGround}, {0, 1}, {1, 0}};
inline std::string pair_name(int i, int j) {
  const auto name = [](int body) { return body == kGround ? std::string("ground") : std::to_string(body); };
  return "(" + name(i) + "," + name(j) + ")";
}

// Every kind of row and every type of force between random bodies, some pairs several times.
inline Model random_model(Random& random, int bodies) {
  Model model = random_bodies(random, bodies);
  const auto pair = [&] {
    const int i = random.integer(-1, bodies - 1);
    int j = i;
    while (j == i) j = random.integer(-1, bodies - 1);
    return std::pair(i, j);
  };
  for (int repeat = 0; repeat < 2; ++repeat) {
    for (RowType type : kRowTypes) {
      const auto [i, j] = pair();
      add_row(model, type, i, j, random);
    }
    const auto [first, second] = pair();
    add_coincidence(model, first, second, random);
    for (int type = 0; type < kForceTypes; ++type) {
      const auto [i, j] = pair();
      add_force(model, static_cast<ForceType>(type), i,
                acts_between_two(static_cast<ForceType>(type)) || j != kGround ? j : 0, random);
    }
  }
  return model;
}

}  // namespace poinsot::test
