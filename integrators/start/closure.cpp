#include "integrators/start/closure.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/index.h"
#include "core/scene_types.h"
#include "core/so3.h"

namespace poinsot {
namespace {

class Opener {
 public:
  Opener(const Model& model, std::span<const BodyState> states) : model_(model), states_(states) {}

  std::vector<OpenPart> run() {
    std::size_t joint = 0;
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      group_ = static_cast<int>(g);
      i_ = model_.groups[g].i, j_ = model_.groups[g].j;
      if (model_.groups[g].kind == GroupKind::joint)
        open_joint(model_.groups[g].type, model_.joints[joint++]);
      else
        open_row(model_.rows[index(model_.groups[g].first_row)]);
    }
    return std::move(parts_);
  }

 private:
  Vector3 from(int body, const Vector3& a) const { return body == kGround ? a : Vector3(states_[index(body)].A * a); }
  Vector3 centre(int body) const { return body == kGround ? Vector3(Vector3::Zero()) : states_[index(body)].r; }

  void add(bool angle, double value, const Vector3& g, const Vector3& on_i, const Vector3& on_j) {
    parts_.push_back({group_, angle, value, g, on_i, on_j});
  }

  // Arms and span of the points s_i and s_j.
  struct Span {
    Vector3 p, q, d;
  };
  Span span_of(const Vector3& s_i, const Vector3& s_j) const {
    const Vector3 p = from(i_, s_i), q = from(j_, s_j);
    return {p, q, centre(j_) + q - centre(i_) - p};
  }
  // g·d − f, with g taken along by body i or by none.
  void along(const Span& s, const Vector3& g, double f, bool with_i) {
    Vector3 on_i = -s.p.cross(g);
    if (with_i) on_i += g.cross(s.d);
    add(false, g.dot(s.d) - f, g, on_i, s.q.cross(g));
  }
  void distance(const Span& s, double length) {
    const double l = s.d.norm();
    const Vector3 n = l > 0 ? Vector3(s.d / l) : Vector3(Vector3::Zero());
    add(false, l - length, n, -s.p.cross(n), s.q.cross(n));
  }
  // u·v − f of unit vectors.
  void product(const Vector3& u, const Vector3& v, double f) {
    const Vector3 turn = u.cross(v);
    add(true, u.dot(v) - f, Vector3::Zero(), turn, -turn);
  }
  // A vector e of body i that varies as E (φ_j − φ_i) beside i: its components along `axes` of body i.
  void relative(const Vector3& e, const Matrix3& E, std::initializer_list<Vector3> axes) {
    for (const Vector3& a : axes) {
      const Vector3 turn = E.transpose() * a;
      add(true, a.dot(e), Vector3::Zero(), -turn, turn);
    }
  }

  void open_joint(const std::string& type, const JointFrames& f) {
    const auto is = [&](JointType t) { return type == type_name(t); };
    const Vector3 u = from(i_, f.axis_i), v = from(j_, f.axis_j), a = from(i_, f.a_i), b = u.cross(a);
    const Span s = span_of(f.s_i, f.s_j);
    if (is(JointType::cylindrical) || is(JointType::translational)) {
      along(s, a, 0, true);
      along(s, b, 0, true);
    } else {
      for (int k = 0; k < 3; ++k) along(s, Vector3::Unit(k), 0, false);
    }
    if (is(JointType::universal)) product(u, v, 0);
    if (is(JointType::revolute) || is(JointType::cylindrical)) align(u, v, a, b);
    if (is(JointType::fixed) || is(JointType::translational)) {
      Matrix3 F_i, F_j;
      const Vector3 c = from(j_, f.a_j);
      F_i << a, b, u;
      F_j << c, v.cross(c), v;
      const Vec4<double> p = parameters_from_rotation<double>(Matrix3(F_j * F_i.transpose()));
      const double sine = p.tail<3>().norm();
      const Vector3 e = (sine > 0 ? 2 * std::atan2(sine, p[0]) / sine : 2.0) * p.tail<3>();
      relative(e, right_jacobian_inverse<double>(Vector3(-e)), {a, b, u});
    }
  }

  void align(const Vector3& u, const Vector3& v, const Vector3& a, const Vector3& b) {
    const Vector3 turn = u.cross(v);
    const double s = turn.norm(), c = u.dot(v), theta = std::atan2(s, c);
    constexpr double kOpposite = 1e-12;  // no direction is nearer than another: the first
    const Vector3 n = s > kOpposite ? Vector3(turn / s) : a, w = n.cross(u);
    const double theta_cot = theta < 1e-4 ? 1 : s > kOpposite ? theta * c / s : 0;
    relative(theta * n, n * n.transpose() + theta_cot * w * w.transpose() - theta * w * u.transpose(), {a, b});
  }

  void open_row(const Row& row) {
    const double f = row.f.at(0.0).f;
    switch (row.type) {
      case RowType::DP1: {
        constexpr double kAlternateAbove = 0.9;  // the scene contract's |f|
        const bool swap = row.alternate && std::abs(f) > kAlternateAbove;
        const Vector3 &a_i = swap ? row.alternate->a_i : row.a_i, &a_j = swap ? row.alternate->a_j : row.a_j;
        const double of = swap ? row.alternate->f.at(0.0).f : f;
        product(from(i_, a_i.normalized()), from(j_, a_j.normalized()), of / (a_i.norm() * a_j.norm()));
        break;
      }
      case RowType::DP2:
        along(span_of(row.s_i, row.s_j), from(i_, row.a_i.normalized()), f / row.a_i.norm(), true);
        break;
      case RowType::CD:
        along(span_of(row.s_i, row.s_j), row.c.normalized(), f / row.c.norm(), false);
        break;
      case RowType::D:
        distance(span_of(row.s_i, row.s_j), row.squared ? f : std::sqrt(std::max(f, 0.0)));
        break;
      case RowType::angle: {
        const Vector3 a = from(i_, row.a_i), b = from(i_, row.b_i), v = from(j_, row.a_j);
        const double x = a.dot(v), y = b.dot(v), rho2 = x * x + y * y;
        const Vector3 turn = rho2 > 0 ? Vector3(((x * b - y * a) / rho2).cross(v)) : Vector3(Vector3::Zero());
        add(true, std::remainder(std::atan2(y, x) - f, 2 * std::numbers::pi), Vector3::Zero(), turn, -turn);
        break;
      }
      case RowType::pfaffian:
        break;
    }
  }

  const Model& model_;
  const std::span<const BodyState> states_;
  int group_ = 0, i_ = kGround, j_ = kGround;
  std::vector<OpenPart> parts_;
};

}  // namespace

std::vector<OpenPart> open_parts(const Model& model, std::span<const BodyState> states) {
  return Opener(model, states).run();
}

std::string describe(const Gap& gap, std::string_view moved, std::string_view turned) {
  constexpr double rounding = 1e-12;  // nobody asks for
  if (gap.radians <= rounding) return fmt::format("{}{:.3g} m", moved, gap.metres);
  if (gap.metres <= rounding) return fmt::format("{}{:.3g} rad", turned, gap.radians);
  return fmt::format("{}{:.3g} m and {}{:.3g} rad", moved, gap.metres, turned, gap.radians);
}

std::vector<Gap> gaps(const Model& model, std::span<const BodyState> states) {
  std::vector<Gap> gaps(model.groups.size());
  for (const OpenPart& part : open_parts(model, states)) {
    Gap& gap = gaps[index(part.group)];
    double& sum = part.angle ? gap.radians : gap.metres;
    sum = std::hypot(sum, part.value);
  }
  return gaps;
}

}  // namespace poinsot
