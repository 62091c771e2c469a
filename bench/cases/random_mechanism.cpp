#include "bench/cases/random_mechanism.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "bench/cases/random.h"
#include "core/check.h"

namespace poinsot::cases {
namespace {

class Maker {
 public:
  Maker(Scene& scene, std::uint64_t seed) : scene_(scene), random_{seed, 0} {}

  // One that a loop will hold keeps a degree of freedom.
  void hang_bar(bool in_loop) {
    const int parent = any_body();
    const Vector3 start = parent == kGround ? place(kGroundSize) : end_[static_cast<std::size_t>(parent)];
    const int bar = add_bar(start, start + between(0.5, 1.5) * direction());
    constexpr JointType kTypes[] = {JointType::revolute, JointType::universal, JointType::spherical};
    add_joint(kTypes[in_loop ? 1 + whole(2) : whole(3)], parent, bar, start);
  }

  void close_loop() {
    const int from = static_cast<int>(end_.size()) - 1;
    const Vector3 start = end_.back();
    const Vector3 end = start + between(0.5, 1.5) * direction();
    const int bar = add_bar(start, end);
    add_joint(JointType::universal, from, bar, start);
    add_joint(JointType::spherical, kGround, bar, end);
  }

 private:
  static constexpr double kGroundSize = 1;  // m

  double between(double a, double b) { return a + (b - a) * random_.uniform(drawn_++); }
  int whole(int n) { return static_cast<int>(between(0, n)); }  // 0 .. n − 1
  int any_body() { return whole(static_cast<int>(end_.size()) + 1) - 1; }
  Vector3 place(double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }
  // Equally likely everywhere on the sphere: of a point in the ball.
  Vector3 direction() {
    constexpr double kLeast = 0.1;
    Vector3 x = place(1);
    while (x.norm() > 1 || x.norm() < kLeast) x = place(1);
    return x.normalized();
  }

  int add_bar(const Vector3& start, const Vector3& end) {
    constexpr double kThin = 1e-3;  // moment about the bar's own axis, of that across
    const double length = (end - start).norm(), mass = between(0.5, 2) * length;
    const double across = mass * length * length / 12;
    Body body;
    body.name = fmt::format("bar{}", scene_.bodies.size() + 1);
    body.mass = mass;
    body.inertia = Vector3(kThin * across, across, across).asDiagonal();
    body.position = (start + end) / 2;
    body.orientation.col(0) = (end - start) / length;
    body.orientation.col(1) = body.orientation.col(0).unitOrthogonal();
    body.orientation.col(2) = body.orientation.col(0).cross(body.orientation.col(1));
    scene_.bodies.push_back(body);
    end_.push_back(end);
    return static_cast<int>(scene_.bodies.size()) - 1;
  }

  void add_joint(JointType type, int i, int j, const Vector3& point) {
    Joint joint;
    joint.name = fmt::format("J{}", scene_.joints.size() + 1);
    joint.type = type;
    joint.i = i, joint.j = j;
    joint.point = point;
    if (type == JointType::revolute) joint.axis = direction();
    if (type == JointType::universal) {  // the second axis across the bar, so that the bar turns about both
      joint.axis_j = scene_.bodies[static_cast<std::size_t>(j)].orientation.col(1);
      joint.axis_i = joint.axis_j.cross(direction()).normalized();
    }
    scene_.joints.push_back(joint);
  }

  Scene& scene_;
  RandomStream random_;
  std::uint64_t drawn_ = 0;
  std::vector<Vector3> end_;  // of each bar
};

}  // namespace

Scene random_mechanism(int bodies, bool closed, std::uint64_t seed) {
  check(bodies >= (closed ? 2 : 1), "a random mechanism has bodies");
  Scene scene;
  scene.name = fmt::format("{} mechanism of {} bodies", closed ? "closed" : "open", bodies);
  scene.about = fmt::format("random, seed {}", seed);
  scene.gravity = {0, 0, -9.81};
  Maker maker(scene, seed);
  for (int k = 0; k < bodies; ++k) {
    if (closed && k % 3 == 1)
      maker.close_loop();
    else
      maker.hang_bar(closed && k % 3 == 0 && k + 1 < bodies);
  }
  return scene;
}

}  // namespace poinsot::cases
