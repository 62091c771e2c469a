// Mechanisms whose joints constrain too often and that move all the same, by their proportions or because joints stand
// twice, and the same mechanisms written without redundancy.
#pragma once

#include <numbers>

#include "tests/support/paradoxic.h"

namespace poinsot::test {

// Bennett's loop: opposite links alike, sin β / b = sin α / a with a = 1.
inline std::vector<Axis> bennett_axes(double alpha, double beta, double angle) {
  const double b = std::sin(beta) / std::sin(alpha),
               other = 2 * std::atan(std::sin((beta + alpha) / 2) / std::sin((beta - alpha) / 2) / std::tan(angle / 2));
  return closed_loop({1, b, 1, b}, {alpha, beta, alpha, beta}, {angle, other, -angle, -other});
}

inline Scene bennett(const Told& told) {
  Paradoxic made("Bennett", told);
  made.loop(bennett_axes(0.7, 1.2, 1), {{1, JointType::spherical}, {2, JointType::cylindrical}});
  return made.scene();
}

// Two of Bennett's loops that share a link, which is left out; at one end of it their next links are made one.
inline Scene goldberg(const Told& told) {
  Paradoxic made("Goldberg", told);
  const std::vector<Axis> one = bennett_axes(0.7, 1.2, 1), two = bennett_axes(0.7, 1.9, 1.6);
  check((one[1].at - two[1].at).norm() < 1e-12 && (one[1].along - two[1].along).norm() < 1e-12, "one link is shared");
  made.loop({one[1], one[2], one[3], two[3], two[2]}, {{2, JointType::spherical}});
  return made.scene();
}

inline Scene orthogonal_bricard(const Told& told) {
  Paradoxic made("orthogonal Bricard", told);
  const double q = std::numbers::pi / 2, u = 1.2, w = std::acos(-std::cos(u) / (1 + std::cos(u)));
  made.loop(closed_loop(std::vector<double>(6, 1), {q, -q, q, -q, q, -q}, {u, w, u, w, u, w}),
            {{3, JointType::universal}});
  return made.scene();
}

// Three hinges as they come and the three that half a turn about the z axis makes of them.
inline Scene line_symmetric_bricard(const Told& told) {
  Paradoxic made("line-symmetric Bricard", told);
  std::vector<Axis> axes{
      {{1, 0, 0}, {0.2, 0.3, 1}}, {{0.8, 0.9, 0.4}, {1, -0.4, 0.3}}, {{0, 1.2, -0.3}, {0.3, 1, 0.6}}};
  const Matrix3 turn = Vector3(-1, -1, 1).asDiagonal();
  for (std::size_t k = 0; k < 3; ++k) axes.push_back({turn * axes[k].at, turn * axes[k].along});
  made.loop(axes, {{4, JointType::universal}});
  return made.scene();
}

// Two hinges in the plane x = 0, two beside it and their mirror images.
inline Scene plane_symmetric_bricard(const Told& told) {
  Paradoxic made("plane-symmetric Bricard", told);
  const Axis first{{0, 0, 0}, {0, 1, 0.3}}, second{{1, 0.2, 0.1}, {0.5, 1, -0.4}}, third{{0.9, 0.3, 1}, {1, 0.2, 0.5}},
      fourth{{0, 0.1, 1.3}, {0, -0.5, 1}};
  const Matrix3 mirror = Vector3(-1, 1, 1).asDiagonal();
  const auto image = [&](const Axis& of) { return Axis{mirror * of.at, mirror * of.along}; };
  made.loop({first, second, third, fourth, image(third), image(second)}, {{2, JointType::universal}});
  return made.scene();
}

// Two legs of three parallel hinges each, at a right angle, that let the plate go straight up and down.
inline Scene sarrus(const Told& told) {
  Paradoxic made("Sarrus", told);
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  const int plate = made.link("plate", {0.3, -0.2, 1}, {-0.3, 0.2, 1}, 2);
  const auto leg = [&](const char* name, const Vector3& out, const Vector3& along, JointType middle) {
    const Vector3 low = 0.5 * out, knee = 1.2 * out + Vector3(0, 0, 0.45), high = 0.4 * out + Vector3(0, 0, 1);
    const int lower = made.link(fmt::format("lower {}", name), low, knee),
              upper = made.link(fmt::format("upper {}", name), knee, high);
    made.hinge(made.base(), lower, {low, along});
    made.hinge_or(middle, lower, upper, {knee, along});
    made.hinge(upper, plate, {high, along});
  };
  leg("first", x, y, JointType::revolute);
  leg("second", y, x, JointType::universal);
  return made.scene();
}

// Four hinges whose axes meet in a point.
inline Scene spherical_four_bar(const Told& told) {
  Paradoxic made("spherical four-bar", told);
  std::vector<Axis> axes;
  for (const Vector3& out : {Vector3(1, 0, 0), {0.8, 0.6, 0.5}, {0, 0.9, 0.8}, {-0.2, 0.9, -0.3}})
    axes.push_back({out, out});
  made.loop(axes, {{1, JointType::spherical}, {2, JointType::cylindrical}});
  return made.scene();
}

// Two of Hooke's joints in a row, each a cross on two hinges, the shafts ahead and behind in bearings, the last in two.
inline Scene double_hooke(const Told& told) {
  Paradoxic made("double Hooke", told);
  const Vector3 one(0, 0, 0), two(1, 0, 0), in(-1, 0.4, 0), out(2, 0.5, 0.3), z = Vector3::UnitZ();
  const Vector3 way = (out - two).normalized(), across = way.cross(z).normalized();
  const int first = made.link("first shaft", in, one), cross = made.link("first cross", -0.2 * z, 0.2 * z, 0.5),
            middle = made.link("middle", one, two),
            other = made.link("second cross", two - 0.2 * across, two + 0.2 * across, 0.5),
            last = made.link("last shaft", two, out);
  Body& crank = made.scene().bodies[static_cast<std::size_t>(first)];
  crank.angular_velocity += crank.orientation.transpose() * (told.carried ? 6.0 : 5.0) * in.normalized();
  made.hinge_or(JointType::cylindrical, made.base(), first, {0.5 * in, in});
  made.hinge(first, cross, {one, z});
  made.hinge(cross, middle, {one, Vector3(0, 1, 0)});
  made.hinge(middle, other, {two, across.cross(Vector3::UnitX())});
  made.hinge(other, last, {two, across});
  made.hinge(made.base(), last, {two + 0.3 * way, way});
  if (told.redundant) made.hinge(made.base(), last, {two + 0.8 * way, way});
  return made.scene();
}

// A carriage on two parallel guides, from which a rod hangs.
inline Scene parallel_guides(const Told& told) {
  Paradoxic made("parallel guides", told);
  const Vector3 along(1, -0.6, 0.2);
  const int carriage = made.link("carriage", {0, -0.3, 0}, {0, 0.3, 0.1}, 2),
            rod = made.link("rod", {0.1, 0, 0}, {0.9, 0.2, 0});
  made.join(JointType::translational, made.base(), carriage, {{0, 0.3, 0}, along});
  if (told.redundant) made.join(JointType::translational, made.base(), carriage, {{0, -0.3, 0.1}, along});
  made.hinge(carriage, rod, {{0.1, 0, 0}, {0, 0.3, 1}});
  return made.scene();
}

// Three cranks of the same length and direction on one coupler. Their feet are not in line: where two of them come to
// lie along theirs, and by themselves could go on as an antiparallelogram, the third one leads. Without redundancy the
// coupler keeps its orientation by rows of its own, and the other cranks that of the first.
inline Scene parallel_cranks(const Told& told) {
  Paradoxic made("parallel cranks", told);
  const Vector3 crank(0.8 * std::cos(-0.5), 0.8 * std::sin(-0.5), 0), x = Vector3::UnitX(), y = Vector3::UnitY(),
                                                                      z = Vector3::UnitZ();
  const auto foot = [](int k) { return Vector3(0.7 * k, 0.1 * (k % 2), 0); };
  const int coupler = made.link("coupler", foot(0) + crank, foot(2) + crank, 2);
  int first = coupler;
  for (int k = 0; k < 3; ++k) {
    const int link = made.link(fmt::format("crank{}", k + 1), foot(k), foot(k) + crank);
    made.hinge(made.base(), link, {foot(k), z});
    if (k == 0) {
      first = link;
      made.hinge_or(JointType::spherical, link, coupler, {foot(k) + crank, z});
    } else if (made.redundant()) {
      made.hinge(link, coupler, {foot(k) + crank, z});
    } else {
      made.perpendicular(first, crank, link, z.cross(crank));
    }
  }
  if (!made.redundant()) {
    made.perpendicular(made.base(), z, coupler, x);
    made.perpendicular(made.base(), z, coupler, y);
    made.perpendicular(made.base(), x, coupler, y);
  }
  return made.scene();
}

// Three pairs of crossing bars, each hinged to the next at both ends; the first bar on the base.
inline Scene lazy_tongs(const Told& told) {
  Paradoxic made("lazy tongs", told);
  const Vector3 z = Vector3::UnitZ();
  const auto end = [](int k, bool up) { return Vector3(0.25 * k, up ? 0.5 : -0.5, 0); };
  int low = -1, high = -1;
  for (int k = 0; k < 3; ++k) {
    const int rising = made.link(fmt::format("rising{}", k + 1), end(k, false), end(k + 1, true)),
              falling = made.link(fmt::format("falling{}", k + 1), end(k, true), end(k + 1, false));
    if (k == 0) made.hinge(made.base(), rising, {end(0, false), z});
    made.hinge(rising, falling, {0.5 * (end(k, false) + end(k + 1, true)), z});
    if (k > 0) {
      made.hinge_or(JointType::spherical, high, falling, {end(k, true), z});
      made.hinge_or(JointType::cylindrical, low, rising, {end(k, false), z});
    }
    high = rising, low = falling;
  }
  return made.scene();
}

struct ParadoxicMachine {
  const char* name;
  Scene (*make)(const Told&);
  int freedoms, redundant;  // on the ground; six freedoms more where they are carried
};

inline constexpr ParadoxicMachine kParadoxicMachines[] = {
    {"Bennett", bennett, 1, 3},
    {"Goldberg", goldberg, 1, 2},
    {"OrthogonalBricard", orthogonal_bricard, 1, 1},
    {"LineSymmetricBricard", line_symmetric_bricard, 1, 1},
    {"PlaneSymmetricBricard", plane_symmetric_bricard, 1, 1},
    {"Sarrus", sarrus, 1, 1},
    {"SphericalFourBar", spherical_four_bar, 1, 3},
    {"DoubleHooke", double_hooke, 1, 6},
    {"ParallelGuides", parallel_guides, 2, 5},
    {"ParallelCranks", parallel_cranks, 1, 7},
    {"LazyTongs", lazy_tongs, 2, 6},
};

}  // namespace poinsot::test
