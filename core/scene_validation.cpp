#include "core/scene_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/scene_names.h"
#include "core/scene_types.h"
#include "core/validation_rules.h"

namespace poinsot {
namespace {

using namespace rules;

struct Names {
  ItemNames by_type;
  std::unordered_map<std::string, Place> taken;
};

class Validation {
 public:
  explicit Validation(const Scene& scene) : scene_(scene) {}

  void run() const {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (const double g = scene_.gravity[k]; !std::isfinite(g)) {
        const std::string path = fmt::format("/gravity/{}", k);
        throw ElementError(fmt::format("{}: found {}, expected a finite number", path, g), path);
      }
    }
    validate_bodies(scene_.bodies);
    Names rows, forces;  // reactions are told apart by the names of constraints, joints and drivers
    every("constraints", scene_.constraints, rows, [this](const Place& at, const Constraint& c) { constraint(at, c); });
    every("joints", scene_.joints, rows, [this](const Place& at, const Joint& j) { joint(at, j); });
    every("drivers", scene_.drivers, rows, [this](const Place& at, const Driver& d) { driver(at, d); });
    every("forces", scene_.forces, forces, [this](const Place& at, const Force& f) {
      std::visit([&](const auto& concrete) { force(at, concrete); }, f);
    });
  }

 private:
  // Checks every item of a section, then its name among those of its kind.
  template <class Item, class Check>
  static void every(const char* section, const std::vector<Item>& items, Names& names, Check check) {
    for (std::size_t k = 0; k < items.size(); ++k) {
      const Place at{section, k};
      check(at, items[k]);
      const std::string& given = given_name(items[k]);
      name(at, given);
      const std::string called = names.by_type.next(items[k]);
      if (const auto [entry, is_new] = names.taken.emplace(called, at); !is_new) {
        const bool is_given = !given.empty();
        already(at, is_given ? "name" : "", called, is_given ? "" : " (its name by type and number)", entry->second);
      }
    }
  }

  void constraint(const Place& at, const Constraint& c) const {
    known(at, "type", c.type);
    pair(at, c);
    finite(at, "a_i", c.a_i);
    finite(at, "a_j", c.a_j);
    finite(at, "s_i", c.s_i);
    finite(at, "s_j", c.s_j);
    finite(at, "c", c.c);
    finite(at, "f", c.f);
    switch (c.type) {
      case ConstraintType::DP1:
        direction(at, "a_i", c.a_i);
        direction(at, "a_j", c.a_j);
        break;
      case ConstraintType::DP2:
        direction(at, "a_i", c.a_i);
        break;
      case ConstraintType::D:
        break;
      case ConstraintType::CD:
        direction(at, "c", c.c);
        break;
      case ConstraintType::pfaffian:
        direction(at, "a_j", c.a_j);
        break;
    }
    if (!c.alternate) return;
    if (c.type != ConstraintType::DP1) {
      at.fail("alternate", fmt::format("found one of a {}, expected it of a DP1 only", type_name(c.type)));
    }
    direction(at, "alternate/a_i", c.alternate->a_i);
    direction(at, "alternate/a_j", c.alternate->a_j);
    finite(at, "alternate/f", c.alternate->f);
  }

  void joint(const Place& at, const Joint& j) const {
    known(at, "type", j.type);
    pair(at, j);
    if (j.frames) {
      for (const auto& [key, global] : {std::pair("point", &j.point), std::pair("axis", &j.axis),
                                        std::pair("axis_i", &j.axis_i), std::pair("axis_j", &j.axis_j)}) {
        if (!global->isZero(0)) at.fail(key, "found one beside the joint's frames, expected one of the two");
      }
      frames(at, j.type, *j.frames);
      return;
    }
    finite(at, "point", j.point);
    switch (j.type) {
      case JointType::spherical:
      case JointType::fixed:
        break;
      case JointType::universal:
        direction(at, "axis_i", j.axis_i);
        direction(at, "axis_j", j.axis_j);
        perpendicular(at, "axis_j", "an axis", j.axis_j, "axis_i", j.axis_i);
        break;
      case JointType::revolute:
      case JointType::cylindrical:
      case JointType::translational:
        direction(at, "axis", j.axis);
        break;
    }
  }

  static void frames(const Place& at, JointType type, const JointFrames& f) {
    finite(at, "s_i", f.s_i);
    finite(at, "s_j", f.s_j);
    if (type == JointType::spherical) return;
    direction(at, "axis_i", f.axis_i);
    direction(at, "axis_j", f.axis_j);
    const bool needed = type == JointType::translational || type == JointType::fixed;
    references(at, f.a_i, f.a_j, needed, "axis_i", f.axis_i);
    if (!f.a_j.isZero(0)) perpendicular(at, "a_j", "a direction", f.a_j, "axis_j", f.axis_j);
  }

  // Both directions or, where they are not needed, none.
  static void references(const Place& at, const Vector3& a_i, const Vector3& a_j, bool needed, const char* axis_key,
                         const Vector3& axis) {
    finite(at, "a_i", a_i);
    finite(at, "a_j", a_j);
    if (!needed && a_i.isZero(0) && a_j.isZero(0)) return;
    direction(at, "a_i", a_i);
    direction(at, "a_j", a_j);
    perpendicular(at, "a_i", "a direction", a_i, axis_key, axis);
  }

  static void perpendicular(const Place& at, std::string_view key, std::string_view what, const Vector3& a,
                            std::string_view axis_key, const Vector3& axis) {
    constexpr double kSquare = 1e-2;  // what is given to a few digits is put right
    const double cosine = a.stableNormalized().dot(axis.stableNormalized());
    if (std::abs(cosine) > kSquare) {
      at.fail(key, fmt::format("found {} at {:.4g} rad to {}, expected one perpendicular to it", what,
                               std::acos(std::clamp(cosine, -1.0, 1.0)), axis_key));
    }
  }

  void driver(const Place& at, const Driver& d) const {
    known(at, "type", d.type);
    pair(at, d);
    if (d.type == DriverType::angle) {
      direction(at, "axis", d.axis);
      references(at, d.a_i, d.a_j, false, "axis", d.axis);
      finite(at, "angle", d.value);
    } else {
      finite(at, "s_i", d.s_i);
      finite(at, "s_j", d.s_j);
      finite(at, "length", d.value);
      if (const double length = d.value.at(0.0).f; d.value.is_constant() && !(length > 0))
        at.fail("length", fmt::format("found {}, expected a positive length", length));
    }
  }

  void force(const Place& at, const PointForce& f) const {
    moving(at, f.body);
    finite(at, "point", f.point);
    constexpr const char* kKeys[] = {"force/0", "force/1", "force/2"};
    for (std::size_t k = 0; k < 3; ++k) finite(at, kKeys[k], f.force[k]);
    known(at, "frame", f.frame);
  }
  void force(const Place& at, const Torque& f) const {
    moving(at, f.body);
    constexpr const char* kKeys[] = {"torque/0", "torque/1", "torque/2"};
    for (std::size_t k = 0; k < 3; ++k) finite(at, kKeys[k], f.torque[k]);
    known(at, "frame", f.frame);
  }
  void force(const Place& at, const Spring& f) const {
    pair(at, f);
    finite(at, "s_i", f.s_i);
    finite(at, "s_j", f.s_j);
    law(at, f);
    finite(at, "length", f.length);
    if (f.length < 0) at.fail("length", fmt::format("found {}, expected a number that is not negative", f.length));
  }
  void force(const Place& at, const TorsionSpring& f) const {
    pair(at, f);
    direction(at, "axis", f.axis);
    references(at, f.a_i, f.a_j, false, "axis", f.axis);
    law(at, f);
    finite(at, "angle", f.angle);
  }
  void force(const Place& at, const LinearDrag& f) const {
    moving(at, f.body);
    finite(at, "translational", f.translational);
    finite(at, "rotational", f.rotational);
  }

  void force(const Place& at, const CallbackForce& f) const {
    if (!f.loads) at.fail("loads", "found no function, expected one");
    if (f.bodies.empty()) at.fail("bodies", "found none, expected at least one body");
    for (std::size_t k = 0; k < f.bodies.size(); ++k) {
      if (!is_body(f.bodies[k])) unknown(at, fmt::format("bodies/{}", k), f.bodies[k], "");
      if (std::ranges::count(f.bodies, f.bodies[k]) > 1)
        at.fail(fmt::format("bodies/{}", k), fmt::format("found {} twice, expected different bodies", f.bodies[k]));
    }
  }

  template <class AnySpring>
  static void law(const Place& at, const AnySpring& f) {
    finite(at, "stiffness", f.stiffness);
    finite(at, "damping", f.damping);
    if (!f.law) return;
    if (f.law->is_function()) at.fail("law", "found a function of time, expected an expression, or a CallbackForce");
    finite(at, "law", *f.law);
    if (f.stiffness != 0 || f.damping != 0) at.fail("law", "found stiffness or damping beside it, expected it alone");
  }

  template <class Item>
  void pair(const Place& at, const Item& item) const {
    if (!is_body(item.i) && item.i != kGround) unknown(at, "bodies/0", item.i, ", or -1 for the ground");
    if (!is_body(item.j) && item.j != kGround) unknown(at, "bodies/1", item.j, ", or -1 for the ground");
    if (item.i != item.j) return;
    const std::string twice = item.i == kGround ? "ground" : scene_.bodies[static_cast<std::size_t>(item.i)].name;
    at.fail("bodies", fmt::format("found \"{}\" twice, expected two different bodies", twice));
  }
  void moving(const Place& at, int body) const {
    if (body == kGround) {
      at.fail("body", fmt::format("found \"ground\", expected the name of a body that can move{}",
                                  after_colon("", scene_.bodies)));
    }
    if (!is_body(body)) unknown(at, "body", body, "");
  }
  bool is_body(int body) const { return body >= 0 && static_cast<std::size_t>(body) < scene_.bodies.size(); }
  [[noreturn]] void unknown(const Place& at, std::string_view key, int body, std::string_view or_ground) const {
    at.fail(key, fmt::format("found {}, expected the number of a body, less than {}{}", body, scene_.bodies.size(),
                             or_ground));
  }

  const Scene& scene_;
};

}  // namespace

void validate(const Scene& scene) {
  Validation(scene).run();
}

}  // namespace poinsot
