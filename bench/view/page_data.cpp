#include "bench/view/page_data.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/view/comparison.h"
#include "bench/view/symbols.h"
#include "bench/view/trajectory_columns.h"
#include "core/provenance.h"
#include "core/scene_types.h"
#include "core/so3.h"

namespace poinsot::view {
using Json = nlohmann::ordered_json;
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are packed as they lie in memory");

template <class Number>
std::string base64(std::span<const Number> numbers) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  const std::size_t size = numbers.size_bytes();
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t k = 0; k < size; k += 3) {
    const std::size_t left = std::min<std::size_t>(3, size - k);
    std::uint32_t triple = 0;
    for (std::size_t n = 0; n < 3; ++n) triple = triple << 8 | (n < left ? bytes[k + n] : 0u);
    for (std::size_t n = 0; n < 4; ++n) text += n <= left ? kDigits[triple >> (18 - 6 * n) & 63] : '=';
  }
  return text;
}

Json json(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

// The homogeneous ellipsoid of the body's mass and moments: m (b² + c²)/5 = J1, and so on. No radius is imaginary:
// moments that no body has (the paper's rotor) give a flat one.
Json ellipsoid(const Body& body) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(body.inertia);
  const Vector3 J = principal.eigenvalues();
  Matrix3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  Vector3 radii;
  for (int k = 0; k < 3; ++k) radii[k] = std::sqrt(std::max(0.0, (J.sum() - 2 * J[k]) * 5 / (2 * body.mass)));
  const Vec4<double> p = parameters_from_rotation<double>(axes);
  return {{"radii", json(radii)}, {"parameters", {p[0], p[1], p[2], p[3]}}};
}

Json json(const Shape& shape) {
  Json points = Json::array();
  for (const Vector3& point : shape.points) points.push_back(json(point));
  return {
      {"type", type_name(shape.type)}, {"at", json(shape.at)},     {"size", json(shape.size)}, {"radius", shape.radius},
      {"length", shape.length},        {"axis", json(shape.axis)}, {"points", points}};
}

template <class Symbol>
Json ends(const Symbol& symbol) {
  return {{"type", symbol.type}, {"name", symbol.name}, {"i", symbol.i}, {"j", symbol.j}};
}

Json json(const Symbols& symbols) {
  Json joints = Json::array(), lines = Json::array(), turns = Json::array();
  for (const JointSymbol& joint : symbols.joints) {
    Json& one = joints.emplace_back(ends(joint));
    one["s_i"] = json(joint.s_i), one["s_j"] = json(joint.s_j);
    one["axis_i"] = json(joint.axis_i), one["axis_j"] = json(joint.axis_j);
  }
  for (const LineSymbol& line : symbols.lines) {
    Json& one = lines.emplace_back(ends(line));
    one["s_i"] = json(line.s_i), one["s_j"] = json(line.s_j);
  }
  for (const TurnSymbol& turn : symbols.turns) turns.emplace_back(ends(turn))["axis_i"] = json(turn.axis_i);
  return {{"joints", joints}, {"lines", lines}, {"turns", turns}};
}

Json loads(const Model& model) {
  Json all = Json::array();
  const auto add = [&](const char* type, const auto& load, const Vector3& point, const char* unit) {
    all.push_back({{"type", type},
                   {"name", load.name},
                   {"body", load.body},
                   {"point", json(point)},
                   {"frame", type_name(load.frame)},
                   {"unit", unit}});
  };
  for (const PointForce& force : model.point_forces) add("force", force, force.point, "N");
  for (const Torque& torque : model.torques) add("torque", torque, Vector3::Zero(), "N m");
  return all;
}

Json bodies(const Model& model) {
  const auto points = attachment_points(model);
  Json all = Json::array();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    Json& one = all.emplace_back(Json{{"name", body.name}, {"mass", body.mass}, {"ellipsoid", ellipsoid(body)}});
    one["points"] = Json::array();
    for (const Vector3& point : points[b]) one["points"].push_back(json(point));
    if (body.shape) one["shape"] = json(*body.shape);
  }
  return all;
}

// A column over the frames, as float32.
class Columns {
 public:
  explicit Columns(const std::vector<Frame>& frames) : frames_(frames) {}
  template <class Value>
  void add(Value value) {
    for (const Frame& frame : frames_) numbers_.push_back(static_cast<float>(value(frame)));
  }
  std::string text() const { return base64(std::span<const float>(numbers_)); }

 private:
  const std::vector<Frame>& frames_;
  std::vector<float> numbers_;
};

void add_body(Columns& columns, std::size_t b, const Vector3& centre, bool pose_only) {
  for (int k = 0; k < 3; ++k) columns.add([&](const Frame& f) { return f.bodies[b].r[k] - centre[k]; });
  for (int k = 0; k < 4; ++k)
    columns.add([&](const Frame& f) { return parameters_from_rotation<double>(f.bodies[b].A)[k]; });
  if (pose_only) return;
  for (const auto member : {&BodyState::rd, &BodyState::w, &BodyState::rdd, &BodyState::wd})
    for (int k = 0; k < 3; ++k) columns.add([&](const Frame& f) { return (f.bodies[b].*member)[k]; });
}

struct Curve {
  const char* name;
  const char* unit;
  double (*value)(const Frame& frame, const Frame& first);
};
constexpr Curve kCurves[] = {
    {"energy", "J", [](const Frame& f, const Frame&) { return f.energy; }},
    {"change of energy", "J", [](const Frame& f, const Frame& first) { return f.energy - first.energy; }},
    {"kinetic energy", "J", [](const Frame& f, const Frame&) { return f.kinetic; }},
    {"potential energy", "J", [](const Frame& f, const Frame&) { return f.energy - f.kinetic; }},
    {"violation of positions", "", [](const Frame& f, const Frame&) { return f.position_violation; }},
    {"violation of velocities", "", [](const Frame& f, const Frame&) { return f.velocity_violation; }}};

Vector3 middle(const std::vector<Frame>& frames, std::size_t b) {
  Vector3 least = frames.front().bodies[b].r, most = least;
  for (const Frame& frame : frames) {
    least = least.cwiseMin(frame.bodies[b].r);
    most = most.cwiseMax(frame.bodies[b].r);
  }
  return (least + most) / 2;
}

Json packed(const Model& model, const Motion& motion, bool pose_only) {
  const std::vector<Frame>& frames = motion.frames;
  std::vector<double> t, centres;
  for (const Frame& frame : frames) t.push_back(frame.t);
  Columns columns(frames);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Vector3 centre = middle(frames, b);
    centres.insert(centres.end(), centre.begin(), centre.end());
    add_body(columns, b, centre, pose_only);
  }
  for (const Curve& curve : kCurves) columns.add([&](const Frame& f) { return curve.value(f, frames.front()); });
  for (const PointForce& force : model.point_forces)
    for (const Expression& component : force.force) columns.add([&](const Frame& f) { return component.at(f.t).f; });
  for (const Torque& torque : model.torques)
    for (const Expression& component : torque.torque) columns.add([&](const Frame& f) { return component.at(f.t).f; });
  return {{"label", motion.label},
          {"message", motion.message},
          {"t", base64(std::span<const double>(t))},
          {"centres", base64(std::span<const double>(centres))},
          {"columns", columns.text()}};
}

Json packed(const std::vector<Apart>& apart) {
  std::vector<float> numbers;
  for (const Apart& at : apart) numbers.push_back(static_cast<float>(at.position));
  for (const Apart& at : apart) numbers.push_back(static_cast<float>(at.angle));
  for (const Apart& at : apart) numbers.push_back(static_cast<float>(at.body));
  return base64(std::span<const float>(numbers));
}

}  // namespace

std::string page_data(const Model& model, const std::string& about, std::span<const Motion> motions) {
  const bool many = std::ranges::any_of(
      motions, [&](const Motion& motion) { return motion.frames.size() * model.bodies.size() > kManyPoses; });
  const std::size_t stored = many ? kPoseColumns : kTrajectoryColumns.size();

  Json data;
  data["program"] = fmt::format("poinsot {}", provenance().version);
  data["name"] = model.name;
  data["about"] = about;
  data["gravity"] = json(model.gravity);
  data["bodies"] = bodies(model);
  data["symbols"] = json(symbols(model));
  data["loads"] = loads(model);
  data["body_columns"] = Json::array();
  for (std::size_t k = 0; k < stored; ++k) data["body_columns"].push_back(kTrajectoryColumns[k]);
  data["curves"] = Json::array();
  for (const Curve& curve : kCurves) data["curves"].push_back({{"name", curve.name}, {"unit", curve.unit}});
  data["motions"] = Json::array();
  for (const Motion& motion : motions) data["motions"].push_back(packed(model, motion, many));
  if (motions.size() > 1) data["apart"] = packed(apart(motions[0], motions[1]));

  const std::string text = data.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size() + 4096);
  for (const char c : text) {
    if (c == '<' || c == '>' || c == '&')
      safe += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      safe += c;
  }
  return safe;
}

}  // namespace poinsot::view
