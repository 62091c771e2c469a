#include "integrators/signals.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/index.h"
#include "core/scene_types.h"
#include "core/so3.h"

namespace poinsot {
namespace {

// Free coordinates by type of joint, then their rates.
std::vector<std::string_view> columns_of(const std::string& joint) {
  if (joint == type_name(JointType::revolute)) return {"angle", "angle_rate"};
  if (joint == type_name(JointType::cylindrical)) return {"angle", "slide", "angle_rate", "slide_rate"};
  if (joint == type_name(JointType::translational)) return {"slide", "slide_rate"};
  if (joint == type_name(JointType::universal)) return {"angle_i", "angle_j", "angle_i_rate", "angle_j_rate"};
  if (joint == type_name(JointType::spherical)) return {"rx", "ry", "rz", "wx", "wy", "wz"};
  return {};
}

bool has_tension(const Row& row) {
  return row.type == RowType::D;
}

// A vector attached to a body (a direction or, from the origin, a point), and its rate: global.
struct Attached {
  Vector3 x, rate;
};
Attached direction(std::span<const BodyState> bodies, int body, const Vector3& a) {
  if (body == kGround) return {a, Vector3::Zero()};
  const BodyState& b = bodies[index(body)];
  return {b.A * a, b.A * b.w.cross(a)};
}
Attached point(std::span<const BodyState> bodies, int body, const Vector3& s) {
  Attached p = direction(bodies, body, s);
  if (body == kGround) return p;
  p.x += bodies[index(body)].r;
  p.rate += bodies[index(body)].rd;
  return p;
}
Attached span_of(std::span<const BodyState> bodies, int i, const Vector3& s_i, int j, const Vector3& s_j) {
  const Attached p = point(bodies, i, s_i), q = point(bodies, j, s_j);
  return {q.x - p.x, q.rate - p.rate};
}

// Of the angle of c from a towards b.
double angle_rate(const Attached& a, const Attached& b, const Attached& c) {
  const double x = a.x.dot(c.x), y = b.x.dot(c.x);
  const double xd = a.rate.dot(c.x) + a.x.dot(c.rate), yd = b.rate.dot(c.x) + b.x.dot(c.rate);
  return (x * yd - y * xd) / (x * x + y * y);
}

// What pulls the ends of a spring together, N, or turns body j of a torsion spring back, N m.
template <class AnySpring>
double spring_effort(const AnySpring& spring, double x, double rate, double t) {
  if (spring.law) return spring.law->law(Arguments<double>{t, x, rate}).F;
  return spring.stiffness * x + spring.damping * rate;
}

}  // namespace

std::vector<std::string> Signals::names(const Model& model) {
  std::vector<std::string> names{"kinetic", "potential", "energy", "px", "py", "pz", "Lx", "Ly", "Lz"};
  const auto add = [&](const std::string& name, const std::vector<std::string_view>& columns) {
    for (const std::string_view column : columns) names.push_back(fmt::format("{}.{}", name, column));
  };
  for (const Group& group : model.groups)
    if (group.kind == GroupKind::joint) add(group.name, columns_of(group.type));
  for (const Group& group : model.groups) {
    if (group.kind == GroupKind::driver) add(group.name, {"value", "effort", "power"});
    if (has_tension(model.rows[index(group.first_row)])) add(group.name, {"tension"});
  }
  const auto called = [&](const std::string& force, const char* type) {
    return std::ranges::find(model.groups, force, &Group::name) == model.groups.end()
               ? force
               : fmt::format("{} ({})", force, type);
  };
  for (const Spring& s : model.springs) add(called(s.name, "spring"), {"length", "rate", "force"});
  for (const TorsionElement& t : model.torsions)
    add(called(t.spring.name, "torsion_spring"), {"angle", "rate", "torque"});
  return names;
}

std::vector<FollowedAngle> joint_angles(const Model& model) {
  std::vector<FollowedAngle> angles;
  for_each_joint(model, [&](const Group& group, const JointFrames& f) {
    const int of = static_cast<int>(&group - model.groups.data());
    const bool universal = group.type == type_name(JointType::universal);
    const bool turns = group.type == type_name(JointType::revolute) || group.type == type_name(JointType::cylindrical);
    if (turns) angles.push_back({of, group.i, group.j, f.a_i, f.axis_i.cross(f.a_i), f.a_j});
    if (!universal) return;
    angles.push_back({of, group.i, group.j, f.a_i, f.axis_i.cross(f.a_i), f.axis_j});
    angles.push_back({of, group.j, group.i, f.a_j, f.axis_j.cross(f.a_j), f.axis_i});  // of i relative to j
  });
  return angles;
}

Signals::Signals(const Problem& problem) : bodies_(problem.model().bodies.size()) {
  const Model& model = problem.model();
  check(model.followed.size() == joint_angles(model).size(), "the run was asked for signals");
  const auto needs = [&](const Group& group) {
    return group.kind == GroupKind::driver || has_tension(model.rows[index(group.first_row)]);
  };
  if (std::ranges::any_of(model.groups, needs)) reactions_.emplace(problem);
}

void Signals::update(const Sample& sample) {
  sample_ = &sample;
  sample.problem.to_bodies(sample.a, bodies_);
  if (reactions_) reactions_->update(sample);
  values_.clear();
  add_totals();
  add_joints();
  add_rows();
  add_springs();
}

void Signals::add_totals() {
  const Model& model = sample_->problem.model();
  double kinetic = 0;
  Vector3 p = Vector3::Zero(), L = Vector3::Zero();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BodyState& state = bodies_[b];
    const Vector3 mv = model.bodies[b].mass * state.rd, spin = model.bodies[b].inertia * state.w;
    kinetic += 0.5 * (mv.dot(state.rd) + spin.dot(state.w));
    p += mv;
    L += state.r.cross(mv) + state.A * spin;
  }
  const double energy = sample_->problem.energy();
  add(kinetic);
  add(energy - kinetic);
  add(energy);
  add(p);
  add(L);
}

void Signals::add_joints() {
  std::size_t followed = 0;
  for_each_joint(sample_->problem.model(),
                 [&](const Group& group, const JointFrames& f) { add_joint(group, f, followed); });
}

void Signals::add_joint(const Group& group, const JointFrames& f, std::size_t& followed) {
  const Model& model = sample_->problem.model();
  // sign: the second angle of a universal joint is followed the other way round
  const auto take_angle = [&](double sign) {
    const FollowedAngle& angle = model.followed[followed];
    const double value = sign * sample_->problem.followed_angle(static_cast<int>(followed++));
    const double rate =
        sign * angle_rate(direction(bodies_, angle.i, angle.a_i), direction(bodies_, angle.i, angle.b_i),
                          direction(bodies_, angle.j, angle.c_j));
    return std::pair(value, rate);
  };
  const auto slide = [&] {
    const Attached axis = direction(bodies_, group.i, f.axis_i);
    const Attached d = span_of(bodies_, group.i, f.s_i, group.j, f.s_j);
    return std::pair(axis.x.dot(d.x), axis.rate.dot(d.x) + axis.x.dot(d.rate));
  };
  const auto add_pairs = [&](std::initializer_list<std::pair<double, double>> coordinates) {
    for (const auto& [value, rate] : coordinates) add(value);
    for (const auto& [value, rate] : coordinates) add(rate);
  };
  if (group.type == type_name(JointType::revolute)) add_pairs({take_angle(1)});
  if (group.type == type_name(JointType::cylindrical)) add_pairs({take_angle(1), slide()});
  if (group.type == type_name(JointType::translational)) add_pairs({slide()});
  if (group.type == type_name(JointType::universal)) add_pairs({take_angle(1), take_angle(-1)});
  if (group.type != type_name(JointType::spherical)) return;
  const auto state = [&](int body) { return body == kGround ? BodyState() : bodies_[index(body)]; };
  const BodyState i = state(group.i), j = state(group.j);
  const Matrix3 relative = i.A.transpose() * j.A;
  const Vec4<double> e = parameters_from_rotation<double>(relative);
  const double sine = e.tail<3>().norm();
  add(Vector3(sine > 0 ? 2 * std::atan2(sine, e[0]) / sine * e.tail<3>() : 2 * e.tail<3>()));
  add(Vector3(relative * j.w - i.w));
}

void Signals::add_rows() {
  const Model& model = sample_->problem.model();
  for (const Group& group : model.groups) {
    const Row& row = model.rows[index(group.first_row)];
    const bool tension = has_tension(row);
    if (group.kind != GroupKind::driver && !tension) continue;
    const double lambda = reactions_->lambda(group.first_row);
    if (group.kind == GroupKind::driver) {
      const Jet2<double> f = row.f.at(sample_->instant);
      double effort = -2 * f.f * lambda;  // λ ∂Φ/∂f
      if (row.type == RowType::angle) {
        const Vector3 ahead = direction(bodies_, row.i, std::cos(f.f) * row.a_i + std::sin(f.f) * row.b_i).x;
        effort = -lambda * ahead.dot(direction(bodies_, row.j, row.a_j).x);
      }
      add(f.f);
      add(effort);
      add(effort * f.fd);
    }
    if (tension) add(2 * lambda * span_of(bodies_, row.i, row.s_i, row.j, row.s_j).x.norm());
  }
}

void Signals::add_springs() {
  const Model& model = sample_->problem.model();
  for (const Spring& s : model.springs) {
    const Attached d = span_of(bodies_, s.i, s.s_i, s.j, s.s_j);
    const double length = d.x.norm();
    const double rate = length > 0 ? d.x.dot(d.rate) / length : 0;
    add(length);
    add(rate);
    add(length > 0 ? spring_effort(s, length - s.length, rate, sample_->instant)
                   : 0);  // of no length, it pulls in no direction
  }
  for (std::size_t k = 0; k < model.torsions.size(); ++k) {
    const TorsionElement& t = model.torsions[k];
    const double angle = sample_->problem.twist(static_cast<int>(k));
    const double rate = angle_rate(direction(bodies_, t.spring.i, t.a_i), direction(bodies_, t.spring.i, t.b_i),
                                   direction(bodies_, t.spring.j, t.c_j));
    add(angle);
    add(rate);
    add(spring_effort(t.spring, angle - t.spring.angle, rate, sample_->instant));
  }
}

}  // namespace poinsot
