#include "core/scene_generator.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace poinsot {
namespace {

Scene empty(std::string_view kind, int bodies) {
  Scene scene;
  scene.name = fmt::format("{} of {} bodies", kind, bodies);
  scene.gravity = {0, 0, -9.81};
  return scene;
}

// A rod from `start` along the unit vector `along`, with local z as near to global x as may be: hinges turn about x.
int add_rod(Scene& scene, std::string name, const Vector3& start, const Vector3& along) {
  Body body;
  body.name = std::move(name);
  body.mass = 1;
  body.inertia = Vector3(1e-3, 1.0 / 12, 1.0 / 12).asDiagonal();
  body.position = start + 0.5 * along;
  body.orientation.col(0) = along;
  body.orientation.col(2) = (Vector3::UnitX() - along.x() * along).normalized();
  body.orientation.col(1) = body.orientation.col(2).cross(along);
  scene.bodies.push_back(body);
  return static_cast<int>(scene.bodies.size()) - 1;
}

void add_joint(Scene& scene, JointType type, int i, int j, const Vector3& point) {
  Joint joint;
  joint.type = type;
  joint.i = i, joint.j = j;
  joint.point = point;
  joint.name = fmt::format("J{}", scene.joints.size() + 1);
  if (type == JointType::revolute) joint.axis = Vector3::UnitX();
  if (type == JointType::universal) {  // one axis along the hinges, the other across the second rod
    joint.axis_i = Vector3::UnitX();
    joint.axis_j = scene.bodies[static_cast<std::size_t>(j)].orientation.col(1);
  }
  scene.joints.push_back(joint);
}

Scene chain(int bodies) {
  Scene scene = empty("chain", bodies);
  scene.about = "equal rods hinged one to the next, the first to the ground, horizontal at rest";
  for (int k = 0; k < bodies; ++k) {
    const Vector3 start(0, k, 0);
    const int rod = add_rod(scene, fmt::format("rod{}", k + 1), start, Vector3::UnitY());
    add_joint(scene, JointType::revolute, rod - 1, rod, start);
  }
  return scene;
}

Scene tree(int bodies) {
  Scene scene = empty("tree", bodies);
  scene.about = "a binary tree of equal rods: each carries two on hinges at its end";
  std::vector<Vector3> end;
  for (int k = 0; k < bodies; ++k) {
    const int parent = k == 0 ? kGround : (k - 1) / 2;
    const Vector3 start = parent == kGround ? Vector3::Zero() : end[static_cast<std::size_t>(parent)];
    const double angle = k == 0 ? 0 : (k % 2 ? 0.4 : -0.4);
    const Vector3 along(0, std::cos(angle), std::sin(angle));
    const int rod = add_rod(scene, fmt::format("rod{}", k + 1), start, along);
    add_joint(scene, JointType::revolute, parent, rod, start);
    end.push_back(start + along);
  }
  return scene;
}

Scene ladder(int bodies) {
  const int cells = std::max(1, (bodies + 2) / 3);
  Scene scene = empty("ladder", 3 * cells);
  scene.about = "two chains of equal rods side by side with rungs between them: a closed loop in every cell";
  int left = kGround, right = kGround;
  for (int k = 0; k < cells; ++k) {
    const Vector3 a(0, k, 0), b(0, k, 1), next_a(0, k + 1, 0), next_b(0, k + 1, 1);
    const int rail_a = add_rod(scene, fmt::format("left{}", k + 1), a, Vector3::UnitY());
    const int rail_b = add_rod(scene, fmt::format("right{}", k + 1), b, Vector3::UnitY());
    const int rung = add_rod(scene, fmt::format("rung{}", k + 1), next_a, Vector3::UnitZ());
    add_joint(scene, JointType::revolute, left, rail_a, a);
    add_joint(scene, JointType::revolute, right, rail_b, b);
    add_joint(scene, JointType::universal, rail_a, rung, next_a);
    add_joint(scene, JointType::spherical, rung, rail_b, next_b);
    left = rail_a, right = rail_b;
  }
  return scene;
}

Scene four_bars(int bodies) {
  const int loops = std::max(1, bodies / 2);
  Scene scene = empty("N-four-bar", 2 * loops + 1);
  scene.about = "N + 1 upright rods on ground hinges, joined at the top by N level ones; one degree of freedom";
  int before = kGround;
  for (int k = 0; k <= loops; ++k) {
    const Vector3 foot(0, k, 0), top(0, k, 1);
    const int upright = add_rod(scene, fmt::format("upright{}", k), foot, Vector3::UnitZ());
    add_joint(scene, JointType::revolute, kGround, upright, foot);
    // tops move with 1 m/s along +y: rotation about −x; body frame, so along −(local z)
    scene.bodies.back().angular_velocity = {0, 0, -1};
    scene.bodies.back().velocity = {0, 0.5, 0};
    if (k > 0) {
      const int level = add_rod(scene, fmt::format("level{}", k), top - Vector3::UnitY(), Vector3::UnitY());
      scene.bodies.back().velocity = {0, 1, 0};
      add_joint(scene, JointType::universal, before, level, top - Vector3::UnitY());
      add_joint(scene, JointType::spherical, level, upright, top);
    }
    before = upright;
  }
  return scene;
}

constexpr SceneGenerator kGenerators[] = {
    {"chain", "rods hinged one to the next, the first to the ground", chain},
    {"tree", "a binary tree of rods on hinges", tree},
    {"ladder", "two chains side by side with rungs: a closed loop in every cell of three bodies", ladder},
    {"four_bars", "the N-four-bar: N loops in a row, one degree of freedom", four_bars},
};

}  // namespace

std::span<const SceneGenerator> scene_generators() {
  return kGenerators;
}

const SceneGenerator* find_scene_generator(std::string_view name) {
  const auto* at = std::ranges::find(kGenerators, name, &SceneGenerator::name);
  return at == std::end(kGenerators) ? nullptr : at;
}

}  // namespace poinsot
