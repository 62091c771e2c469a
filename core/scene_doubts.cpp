#include "core/scene_doubts.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace poinsot {
namespace {

constexpr double kApart = 1e6;

Vector3 principal_moments(const Body& body) {
  if (!body.inertia.isDiagonal(0))
    return Eigen::SelfAdjointEigenSolver<Matrix3>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  Vector3 moments = body.inertia.diagonal();
  std::ranges::sort(moments);
  return moments;
}

// ∫ y² + z², ∫ x² + z², ∫ x² + y²: none exceeds the sum of the others. To the digits that moments are given with.
void tell_moments(const Model& model, std::vector<std::string>& sentences) {
  constexpr double kDigits = 1e-3;
  std::size_t bodies = 0;
  std::string first;
  for (const Body& body : model.bodies) {
    const Vector3 moments = principal_moments(body);
    if (moments[2] <= (1 + kDigits) * (moments[0] + moments[1])) continue;
    if (bodies++ == 0)
      first = fmt::format(
          "body '{}' has the principal moments {:.6g}, {:.6g} and {:.6g}, and no body has one that "
          "exceeds the sum of the others",
          body.name, moments[0], moments[1], moments[2]);
  }
  if (bodies > 1) first += fmt::format("; {} more like it", bodies - 1);
  if (bodies > 0) sentences.push_back(first);
}

// The smallest and the largest of positive sizes, and whose they are.
struct Extremes {
  std::pair<double, std::size_t> least{HUGE_VAL, 0}, most{0, 0};

  void add(double size, std::size_t body) {
    least = std::min(least, std::pair(size, body));
    most = std::max(most, std::pair(size, body));
  }
  bool apart() const { return most.first >= kApart * least.first; }
};

void tell_masses(const Model& model, std::vector<std::string>& sentences) {
  Extremes masses;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) masses.add(model.bodies[b].mass, b);
  if (masses.apart())
    sentences.push_back(fmt::format("masses are six orders of magnitude apart: {:g} kg of '{}', {:g} kg of '{}'",
                                    masses.least.first, model.bodies[masses.least.second].name, masses.most.first,
                                    model.bodies[masses.most.second].name));
}

// How far constraints and springs take hold of a body from its centre of mass.
void tell_lengths(const Model& model, std::vector<std::string>& sentences) {
  std::vector<double> reach(model.bodies.size(), 0.0);
  double size = 0;  // of the whole; what is rounding of it is no length
  for (const Body& body : model.bodies) size = std::max(size, body.position.norm());
  const auto hold = [&](int body, const Vector3& s) {
    if (body == kGround) return;
    double& r = reach[static_cast<std::size_t>(body)];
    r = std::max(r, s.norm());
    size = std::max(size, r);
  };
  for (const Row& row : model.rows) hold(row.i, row.s_i), hold(row.j, row.s_j);
  for (const Spring& spring : model.springs) hold(spring.i, spring.s_i), hold(spring.j, spring.s_j);
  constexpr double kRounding = 1e-12;
  Extremes lengths;
  for (std::size_t b = 0; b < reach.size(); ++b)
    if (reach[b] > kRounding * size) lengths.add(reach[b], b);
  if (lengths.apart())
    sentences.push_back(
        fmt::format("lengths are six orders of magnitude apart: '{}' is held {:.3g} m from its centre of mass, "
                    "'{}' {:.3g} m",
                    model.bodies[lengths.least.second].name, lengths.least.first,
                    model.bodies[lengths.most.second].name, lengths.most.first));
}

// Angle drivers and torsion springs on a hinge that turn about another line than the hinge: a direction in body i's
// frame was given as a global one. To the digits that axes are given with.
void tell_axes(const Model& model, std::vector<std::string>& sentences) {
  constexpr double kDigits = 1e-3;
  struct Hinge {
    std::pair<int, int> bodies;
    Vector3 axis;  // in the frame of the first
    const Group* joint;
  };
  std::vector<Hinge> hinges;  // from either body
  std::size_t doubts = 0;
  std::string first;
  const auto look = [&](std::string_view kind, const std::string& name, int i, int j, const Vector3& axis) {
    const std::pair bodies(i, j);
    const Hinge* nearest = nullptr;
    double least = HUGE_VAL;  // rad
    for (auto at = std::ranges::lower_bound(hinges, bodies, {}, &Hinge::bodies);
         at != hinges.end() && at->bodies == bodies; ++at)
      if (const double apart = std::atan2(at->axis.cross(axis).norm(), std::abs(at->axis.dot(axis))); apart < least)
        nearest = &*at, least = apart;
    if (!nearest || least <= kDigits) return;
    if (doubts++ > 0) return;
    const std::string frame_of =
        i == kGround ? "the ground" : fmt::format("'{}'", model.bodies[static_cast<std::size_t>(i)].name);
    first = fmt::format(
        "{} '{}' turns about an axis {:.3g} rad from that of joint '{}' on the same bodies: it is taken in the frame "
        "of {}, where a joint's \"axis\" is global",
        kind, name, least, nearest->joint->name, frame_of);
  };
  for_each_joint(model, [&](const Group& joint, const JointFrames& frames) {
    if (joint.type != "revolute" && joint.type != "cylindrical") return;
    hinges.push_back({{joint.i, joint.j}, frames.axis_i, &joint});
    hinges.push_back({{joint.j, joint.i}, frames.axis_j, &joint});
  });
  std::ranges::stable_sort(hinges, {}, &Hinge::bodies);
  for (const Group& group : model.groups) {
    const Row& row = model.rows[static_cast<std::size_t>(group.first_row)];
    if (group.kind == GroupKind::driver && row.type == RowType::angle)
      look("driver", group.name, row.i, row.j, row.a_i.cross(row.b_i));
  }
  for (const TorsionElement& torsion : model.torsions)
    look("force", torsion.spring.name, torsion.spring.i, torsion.spring.j, torsion.spring.axis);
  if (doubts > 1) first += fmt::format("; {} more like it", doubts - 1);
  if (doubts > 0) sentences.push_back(first);
}

void tell_springs(const Model& model, std::vector<std::string>& sentences) {
  for (const Spring& spring : model.springs)
    if (const double F = force_without_direction(model, spring); F != 0)
      sentences.push_back(fmt::format(
          "force '{}' is {:.3g} N between ends that are at one point, where it has no direction: it acts in "
          "none there; start with its ends apart",
          spring.name, std::abs(F)));
}

constexpr double kLongest = 1e75;  // a direction: the square of the product of two is finite, and so is 1 over it
const double kSquareOverflows = std::sqrt(std::numeric_limits<double>::max());

std::string too_large(const std::string& whose, std::string_view what, double size) {
  return fmt::format("{} has a {} of {:.3g}, whose square is beyond the numbers of a computer", whose, what, size);
}

}  // namespace

double force_without_direction(const Model& model, const Spring& spring) {
  constexpr double kAtOne = 1e-12;  // of the places of its ends
  const Vector3 from = initial_point(model, spring.i, spring.s_i), to = initial_point(model, spring.j, spring.s_j);
  if ((to - from).norm() > kAtOne * std::max(from.norm(), to.norm())) return 0;
  const double x = -spring.length,
               F = spring.law ? spring.law->law(Arguments<double>{0, x, 0}).F : spring.stiffness * x;
  return std::isfinite(F) ? F : 0;
}

std::string overflowing_length(const Model& model) {
  static constexpr const char* kOtherUnits = "; give it in units in which it is smaller";
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    const double size = std::max(row.s_i.cwiseAbs().maxCoeff(), row.s_j.cwiseAbs().maxCoeff());
    if (size > kSquareOverflows)
      return too_large(describe_row(model, static_cast<int>(k)), "length", size) + kOtherUnits;
    for (const Vector3* direction : {&row.a_i, &row.b_i, &row.a_j, &row.c}) {
      const double length = direction->cwiseAbs().maxCoeff();
      if (length > kLongest || (length > 0 && length < 1 / kLongest))
        return fmt::format(
            "{} has a direction of length {:.3g}, and products of such are no numbers of a computer; give it one near "
            "to 1",
            describe_row(model, static_cast<int>(k)), length);
    }
    for (const int b : {row.i, row.j}) {
      if (b == kGround) continue;
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      const double far = body.position.cwiseAbs().maxCoeff();
      if (far > kSquareOverflows)
        return too_large(fmt::format("body '{}'", body.name), "coordinate", far) + kOtherUnits;
    }
  }
  return {};
}

std::string overflowing(const Model& model, double t) {
  std::string found;
  const auto look = [&](const std::string& whose, std::string_view what, double size) {
    if (found.empty() && size > kSquareOverflows && std::isfinite(size)) found = too_large(whose, what, size);
  };
  for (const Body& body : model.bodies) {
    const std::string name = fmt::format("body '{}'", body.name);
    look(name, "mass", body.mass);
    look(name, "moment of inertia", body.inertia.cwiseAbs().maxCoeff());
    look(name, "coordinate", body.position.cwiseAbs().maxCoeff());
    look(name, "velocity", body.velocity.cwiseAbs().maxCoeff());
    look(name, "angular velocity", body.angular_velocity.cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    const double size =
        std::max({row.s_i.cwiseAbs().maxCoeff(), row.s_j.cwiseAbs().maxCoeff(), std::abs(row.f.at(t).f)});
    if (size > kSquareOverflows) look(describe_row(model, static_cast<int>(k)), "length", size);
  }
  for (const Spring& spring : model.springs) {
    look(fmt::format("force '{}'", spring.name), "stiffness", std::abs(spring.stiffness));
    look(fmt::format("force '{}'", spring.name), "length", spring.length);
  }
  for (const PointForce& force : model.point_forces)
    for (const Expression& component : force.force)
      look(fmt::format("force '{}'", force.name), "component", std::abs(component.at(t).f));
  for (const Torque& torque : model.torques)
    for (const Expression& component : torque.torque)
      look(fmt::format("force '{}'", torque.name), "component", std::abs(component.at(t).f));
  look("the scene", "gravity", model.gravity.cwiseAbs().maxCoeff());
  return found;
}

std::vector<std::string> scene_doubts(const Model& model) {
  std::vector<std::string> sentences;
  tell_moments(model, sentences);
  tell_masses(model, sentences);
  tell_lengths(model, sentences);
  tell_axes(model, sentences);
  tell_springs(model, sentences);
  if (const std::string overflow = overflowing(model); !overflow.empty()) sentences.push_back(overflow);
  return sentences;
}

}  // namespace poinsot
