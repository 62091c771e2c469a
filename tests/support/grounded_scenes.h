// Scenes with rows whose two forces have a moment together, CD and pfaffian between moving bodies, and what a dense
// decomposition of all of G makes of them.
#pragma once

#include <Eigen/SVD>
#include <functional>
#include <memory>
#include <vector>

#include "integrators/start/loop_rows.h"
#include "integrators/start/rank.h"
#include "integrators/start/violation.h"
#include "tests/scale.h"
#include "tests/support/random_model.h"
#include "tests/support/simulation.h"

namespace poinsot::test::grounded {

inline const Vector3 kAcross = Vector3::UnitX();  // to the plane of planar scenes

inline Body& add_body(Scene& scene, double mass, const Vector3& position) {
  Body& body = scene.bodies.emplace_back();
  body.name = fmt::format("body{}", scene.bodies.size());
  body.mass = mass;
  body.inertia = Matrix3::Identity();
  body.position = position;
  return body;
}

inline void add_joint(Scene& scene, JointType type, int i, int j, const Vector3& point) {
  Joint& joint = scene.joints.emplace_back();
  joint.name = fmt::format("joint{}", scene.joints.size());
  joint.type = type;
  joint.i = i, joint.j = j;
  joint.point = point;
  joint.axis = kAcross;
}

// Holds where the bodies stand.
inline Constraint& add_row(Scene& scene, ConstraintType type, int i, int j, const Vector3& s_i, const Vector3& s_j,
                           const Vector3& direction) {
  const auto point = [&](int b, const Vector3& s) -> Vector3 {
    const Body& body = scene.bodies[static_cast<std::size_t>(b)];
    return body.position + body.orientation * s;
  };
  Constraint& row = scene.constraints.emplace_back();
  row.name = fmt::format("row{}", scene.constraints.size());
  row.type = type;
  row.i = i, row.j = j;
  row.s_i = s_i, row.s_j = s_j;
  if (type == ConstraintType::CD) {
    row.c = direction;
    const double f = direction.dot(point(j, s_j) - point(i, s_i));
    row.f = Expression(std::abs(f) < 1e-14 ? 0.0 : f);
  } else {
    row.a_j = scene.bodies[static_cast<std::size_t>(j)].orientation.transpose() * direction;
  }
  return row;
}

// On the ground body a, on it body b; the second carries 20 N.
inline Scene welded(ConstraintType type) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  add_body(scene, 1, {0, 0, 0});
  add_body(scene, 2, {1, 0, 0});
  add_joint(scene, JointType::fixed, kGround, 0, {0, 0, 0});
  add_joint(scene, JointType::fixed, 0, 1, {0, 0, 0});
  add_row(scene, type, 0, 1, Vector3::Zero(), Vector3::Zero(), Vector3::UnitZ());
  return scene;
}

// Two links on parallel hinges, whose plane is kept once more.
inline Scene double_pendulum(ConstraintType type) {
  Scene scene;
  scene.gravity = {-1, 0, -10};
  add_body(scene, 1, {0, 1, 0}).angular_velocity = {0.5, 0, 0};
  add_body(scene, 2, {0, 3, 0}).velocity = {0, 0, 1};
  scene.bodies[0].velocity = {0, 0, 0.5};
  add_joint(scene, JointType::revolute, kGround, 0, {0, 0, 0});
  add_joint(scene, JointType::revolute, 0, 1, {0, 2, 0});
  add_row(scene, type, 0, 1, Vector3::Zero(), Vector3::Zero(), kAcross);
  return scene;
}

// Bodies welded and hinged to one another as trees, with loops, planar; rows across the plane, within welds, and some
// that are redundant nowhere.
inline Scene random_scene(unsigned seed) {
  Random random(seed);
  Scene scene;
  scene.gravity = 10 * random.unit();
  const int bodies = random.integer(2, 6);
  std::vector<int> rigid;  // by body: the first of those welded to it
  for (int b = 0; b < bodies; ++b) {
    Body& body = add_body(scene, random.uniform(0.5, 2), random.vector());
    body.orientation = random.rotation();
    const int on = b == 0 ? kGround : random.integer(0, 3) == 0 ? kGround : random.integer(0, b - 1);
    const bool weld = random.integer(0, 1) == 0;
    add_joint(scene, weld ? JointType::fixed : JointType::revolute, on, b, random.vector());
    rigid.push_back(weld && on != kGround ? rigid[static_cast<std::size_t>(on)] : b);
  }
  const auto two = [&](int& i, int& j) {
    j = random.integer(1, bodies - 1);
    i = random.integer(0, j - 1);
  };
  int i = 0, j = 0;
  for (int loops = random.integer(0, 1); loops > 0; --loops) {
    two(i, j);
    add_joint(scene, JointType::revolute, i, j, random.vector());
  }
  for (int rows = random.integer(1, 4); rows > 0; --rows) {
    two(i, j);
    const bool together = rigid[static_cast<std::size_t>(i)] == rigid[static_cast<std::size_t>(j)];
    const bool anyhow = random.integer(0, 5) == 0;  // independent, as a rule
    const Vector3 direction = together || anyhow ? random.unit() : kAcross;
    const ConstraintType type = random.integer(0, 1) == 0 ? ConstraintType::CD : ConstraintType::pfaffian;
    if (random.integer(0, 1) == 0) std::swap(i, j);
    add_row(scene, type, i, j, random.vector(), random.vector(), direction);
  }
  return scene;
}

inline constexpr int kScenes = 300;

// All of G by a dense decomposition.
struct Dense {
  Eigen::MatrixXd G_t, null;  // of all rows, unit columns; an orthonormal basis
  Eigen::Index rank = 0;
  bool clear = false;  // nothing is barely independent

  static Dense of(Eigen::MatrixXd columns) {
    Dense d;
    d.G_t = std::move(columns);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(d.G_t, Eigen::ComputeFullV);
    const Eigen::VectorXd& sizes = svd.singularValues();
    d.rank = (sizes.array() > 1e-8).count();
    d.clear = ((sizes.array() > 1e-11) && (sizes.array() < 1e-3)).count() == 0;
    d.null = svd.matrixV().rightCols(d.G_t.cols() - d.rank);
    return d;
  }
};

struct Analyzed {
  std::shared_ptr<const Model> model;
  std::vector<BodyState> states;
  RankAnalysis rank;
  RowSpace all;
  Dense dense;

  explicit Analyzed(const Scene& scene)
      : model(std::make_shared<const Model>(compile(scene))),
        states(given_state(*model)),
        rank(analyze_rank(model, states, RankNames::none)),
        all(all_rows(model, 0, states)),
        dense(Dense::of(all.columns())) {}
};

inline void for_random_scenes(const std::function<void(const Scene&, const Analyzed&)>& look) {
  const int scenes = scaled(kScenes);
  int looked_at = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const Scene scene = random_scene(static_cast<unsigned>(seed));
    const Analyzed a(scene);
    if (!a.dense.clear || a.rank.singular_position()) continue;
    ++looked_at;
    look(scene, a);
  }
  EXPECT_GT(looked_at, scenes / 2);
}

}  // namespace poinsot::test::grounded
