#include "core/saved_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/check.h"
#include "core/expression_parser.h"
#include "core/input_error.h"
#include "core/model.h"

namespace poinsot {
namespace {

using Ordered = nlohmann::ordered_json;

Ordered array(const Vector3& v) {
  return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};  // no −0
}

void set_state(Ordered& body, const BodyState& state) {
  Ordered rows = Ordered::array();
  for (Eigen::Index k = 0; k < 3; ++k) rows.push_back(array(state.A.row(k)));
  body["position"] = array(state.r);
  body["orientation"] = {{"matrix", rows}};
  body["velocity"] = array(state.rd);
  body["angular_velocity"] = array(state.w);
}

void set_references(Ordered& item, const Vector3& a_i, const Vector3& a_j) {
  if (item.contains("a_i")) return;
  item["a_i"] = array(a_i);
  item["a_j"] = array(a_j);
}

void set_frames(Ordered& joint, JointType type, const JointFrames& f) {
  const bool given = joint.contains("s_i");  // these stay as they are, and get what they left to the pose
  if (!given) {
    for (const char* global : {"point", "axis", "axis_i", "axis_j"}) joint.erase(global);
    joint["s_i"] = array(f.s_i);
    joint["s_j"] = array(f.s_j);
  }
  if (type == JointType::spherical) return;
  if (!given) {
    joint["axis_i"] = array(f.axis_i);
    joint["axis_j"] = array(f.axis_j);
  }
  set_references(joint, f.a_i, f.a_j);
}

void shift(Ordered& value, double by) {
  if (value.is_string()) value = later(value.get_ref<const std::string&>(), by);
}
void shift(Ordered& item, std::initializer_list<const char*> keys, double by) {
  for (const char* key : keys) {
    if (!item.contains(key)) continue;
    if (item[key].is_array())
      for (Ordered& component : item[key]) shift(component, by);
    else
      shift(item[key], by);
  }
}

bool is_number(char c) {
  return (c >= '0' && c <= '9') || c == '.';
}

// The end of a number, "1.5e-3", that begins at k.
std::size_t number_end(std::string_view text, std::size_t k) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + k, text.data() + text.size(), value);
  return error == std::errc() ? static_cast<std::size_t>(end - text.data()) : k + 1;
}

// What the program computes is in no file.
void refuse_functions(const Scene& scene) {
  const auto refuse = [](bool is_function, const char* section, std::size_t k) {
    if (is_function)
      throw InputError(
          fmt::format("/{}/{}: found a function of the program, expected what a scene file can hold", section, k));
  };
  const auto any = [](const Expression(&components)[3]) {
    return std::ranges::any_of(components, &Expression::is_function);
  };
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    const Constraint& c = scene.constraints[k];
    refuse(c.f.is_function() || (c.alternate && c.alternate->f.is_function()), "constraints", k);
  }
  for (std::size_t k = 0; k < scene.drivers.size(); ++k) refuse(scene.drivers[k].value.is_function(), "drivers", k);
  for (std::size_t k = 0; k < scene.forces.size(); ++k) {
    const Force& force = scene.forces[k];
    const auto* at_point = std::get_if<PointForce>(&force);
    const auto* torque = std::get_if<Torque>(&force);
    refuse(std::holds_alternative<CallbackForce>(force) || (at_point && any(at_point->force)) ||
               (torque && any(torque->torque)),
           "forces", k);
  }
}

}  // namespace

std::string later(std::string_view text, double by) {
  if (by == 0) return std::string(text);
  std::string result;
  for (std::size_t k = 0; k < text.size();) {
    std::size_t end = k + 1;
    if (is_number(text[k])) {
      end = number_end(text, k);
    } else if (is_letter(text[k])) {
      while (end < text.size() && (is_letter(text[end]) || is_number(text[end]))) ++end;
      if (text.substr(k, end - k) == "t") {
        constexpr std::string_view kPlus = " + ";
        const bool shifted = k > 0 && text[k - 1] == '(' && text.substr(end, kPlus.size()) == kPlus &&
                             end + kPlus.size() < text.size() && is_number(text[end + kPlus.size()]);
        const std::size_t sum = end + kPlus.size(), sum_end = shifted ? number_end(text, sum) : 0;
        if (shifted && sum_end < text.size() && text[sum_end] == ')') {
          double before = 0;
          std::from_chars(text.data() + sum, text.data() + sum_end, before);
          result += fmt::format("t + {}", before + by);
          k = sum_end;
        } else {
          result += fmt::format("(t + {})", by);
          k = end;
        }
        continue;
      }
    }
    result += text.substr(k, end - k);
    k = end;
  }
  return result;
}

std::string saved_scene(const Scene& scene, double time, std::span<const BodyState> bodies,
                        std::span<const double> twists) {
  check(!scene.source.empty(), "a scene that is saved was read from text");
  refuse_functions(scene);
  const Model model = compile(scene);
  check(bodies.size() == model.bodies.size() && twists.size() == model.torsions.size(), "the state is the scene's");
  Ordered json = Ordered::parse(scene.source, nullptr, true, true);
  for (std::size_t b = 0; b < bodies.size(); ++b) set_state(json["bodies"][b], bodies[b]);
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    Ordered& constraint = json["constraints"][k];
    shift(constraint, {"f"}, time);
    if (constraint.contains("alternate")) shift(constraint["alternate"], {"f"}, time);
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k)
    set_frames(json["joints"][k], scene.joints[k].type, model.joints[k]);
  const std::size_t first_driver = model.groups.size() - scene.drivers.size();
  for (std::size_t k = 0; k < scene.drivers.size(); ++k) {
    const Row& row = model.rows[static_cast<std::size_t>(model.groups[first_driver + k].first_row)];
    if (row.type == RowType::angle) set_references(json["drivers"][k], row.a_i, row.a_j);
    shift(json["drivers"][k], {"angle", "length"}, time);
  }
  std::size_t torsion = 0;
  for (std::size_t k = 0; k < scene.forces.size(); ++k) {
    Ordered& force = json["forces"][k];
    shift(force, {"force", "torque", "law"}, time);
    if (!std::holds_alternative<TorsionSpring>(scene.forces[k])) continue;
    const TorsionElement& element = model.torsions[torsion];
    set_references(force, element.a_i, element.c_j);
    constexpr double kTurn = 2 * std::numbers::pi;
    const double turns = std::round(twists[torsion++] / kTurn);
    if (turns != 0) force["angle"] = element.spring.angle - kTurn * turns;
  }
  return json.dump(2) + "\n";
}

}  // namespace poinsot
