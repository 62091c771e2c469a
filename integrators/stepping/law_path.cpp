#include "integrators/stepping/law_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bounds.h"
#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kSwitchInstant = 1e-14;  // of the time: what rounding may make of it
constexpr double kRoundedPlaces = 1e-13;  // of their extent: what rounding and projections make of a step
constexpr double kMostBulge = 2;          // of the change of a rate

// What a body carries: a point, or its turn.
struct Carried {
  Vector3 x = Vector3::Zero(), rate = Vector3::Zero(), second = Vector3::Zero();
  double turning = 0;  // of the second
};
Carried carried_by(std::span<const BodyState> bodies, int body, const Vector3& s) {
  if (body == kGround) return {s};
  const BodyState& b = bodies[index(body)];
  const Vector3 ws = b.w.cross(s);
  return {b.r + b.A * s, b.rd + b.A * ws, b.rdd + b.A * (b.wd.cross(s) + b.w.cross(ws)), b.w.cross(ws).norm()};
}

double mass_that_moves(const Model& model, int body) {
  return body == kGround ? HUGE_VAL : model.bodies[index(body)].mass;
}
double moment_that_turns(const Model& model, int body) {
  return body == kGround ? HUGE_VAL : model.bodies[index(body)].inertia.trace();
}

}  // namespace

std::vector<SpringLaw> spring_laws(const Model& model) {
  std::vector<SpringLaw> laws;
  const auto add = [&](const std::optional<Expression>& law, int spring, int torsion, double zero, double inertia) {
    if (law && !law->is_constant() && !law->is_function()) laws.push_back({&*law, spring, torsion, zero, inertia});
  };
  for (std::size_t k = 0; k < model.springs.size(); ++k) {
    const Spring& s = model.springs[k];
    add(s.law, static_cast<int>(k), -1, s.length, std::min(mass_that_moves(model, s.i), mass_that_moves(model, s.j)));
  }
  for (std::size_t k = 0; k < model.torsions.size(); ++k) {
    const TorsionSpring& s = model.torsions[k].spring;
    add(s.law, -1, static_cast<int>(k), s.angle,
        std::min(moment_that_turns(model, s.i), moment_that_turns(model, s.j)));
  }
  return laws;
}

std::vector<SpringLaw> springs_that_turn_round(const Model& model) {
  std::vector<SpringLaw> springs;
  for (std::size_t k = 0; k < model.springs.size(); ++k) {
    const Spring& s = model.springs[k];
    if (s.law && !s.law->is_constant()) continue;
    const double F = s.law ? s.law->law(Arguments<double>{}).F : -s.stiffness * s.length;
    if (F == 0) continue;
    const double mass = std::min(mass_that_moves(model, s.i), mass_that_moves(model, s.j));
    springs.push_back({nullptr, static_cast<int>(k), -1, s.length, mass, F, s.law ? 0 : s.stiffness});
  }
  return springs;
}

std::vector<SpringLaw> springs_that_may_turn_round(const Model& model) {
  std::vector<SpringLaw> springs = springs_that_turn_round(model);
  for (const SpringLaw& law : spring_laws(model))
    if (law.spring >= 0) springs.push_back(law);
  return springs;
}

double SpringLaw::at_rest(double length, double t) const {
  return F ? F->law(Arguments<double>{t, length - zero, 0}).F : without_length + stiffness * length;
}

double SpringLaw::at_no_length(double t) const {
  constexpr double kRounded = 1e-4;  // of what the law comes to at other lengths
  const double there = at_rest(0, t);
  if (!F) return there;
  double most = 0;
  for (const double part : {0.02, 0.1, 0.3, 1.0, 2.0}) most = std::max(most, std::abs(at_rest(part * zero, t)));
  return std::abs(there) < kRounded * most ? 0 : there;
}

double SpringLaw::turning(double length, double t) const {
  const double there = at_no_length(t);
  return std::isfinite(there) && std::abs(at_rest(length, t) - there) <= 0.5 * std::abs(there) ? there : 0;
}

LawPlace SpringLaw::place(const Model& model, const Problem& problem, std::span<const BodyState> bodies) const {
  if (spring >= 0) {
    const Spring& s = model.springs[index(spring)];
    const Carried i = carried_by(bodies, s.i, s.s_i), j = carried_by(bodies, s.j, s.s_j);
    return {j.x - i.x, j.rate - i.rate, j.second - i.second, i.turning + j.turning, i.x.norm() + j.x.norm()};
  }
  const TorsionElement& e = model.torsions[index(torsion)];
  const auto turn = [&](int body) {
    return body == kGround
               ? Carried{}
               : Carried{
                     {}, bodies[index(body)].A * bodies[index(body)].w, bodies[index(body)].A * bodies[index(body)].wd};
  };
  const Carried i = turn(e.spring.i), j = turn(e.spring.j);
  Vector3 axis = e.a_i.cross(e.b_i);
  if (e.spring.i != kGround) axis = bodies[index(e.spring.i)].A * axis;
  const double twist = problem.twist(torsion);
  return {
      {twist, 0, 0}, {axis.dot(j.rate - i.rate), 0, 0}, {axis.dot(j.second - i.second), 0, 0}, 0, 1 + std::abs(twist)};
}

Arguments<double> SpringLaw::arguments(const LawPlace& place, double t) const {
  const Vector3 &d = place.d, &rate = place.rate;
  if (torsion >= 0) return {t, d.x() - zero, rate.x()};
  const double length = d.norm();
  return {t, length - zero, length > 0 ? d.dot(rate) / length : rate.norm()};
}

double SpringLaw::change(const LawPlace& place) const {
  if (torsion >= 0) return place.second.x();
  const double length = place.d.norm(), v = place.d.dot(place.rate) / length;
  return (place.d.dot(place.second) + place.rate.squaredNorm() - v * v) / length;
}

const std::string& SpringLaw::name(const Model& model) const {
  return torsion >= 0 ? model.torsions[index(torsion)].spring.name : model.springs[index(spring)].name;
}

std::string SpringLaw::called(const Model& model) const {
  return fmt::format("{}spring '{}'", torsion >= 0 ? "torsion " : "", name(model));
}

LawPath::LawPath(const SpringLaw& of, const LawPlace& from, double t_from, double t_to)
    : of_(of), t_(t_from), h_(t_to - t_from) {
  lead(from.d, from.rate, h_ * from.rate + 0.5 * h_ * h_ * from.second, from.rate + h_ * from.second, from.extent);
}

LawPath::LawPath(const SpringLaw& of, const LawPlace& from, const LawPlace& to, double t_from, double t_to)
    : of_(of), t_(t_from), h_(t_to - t_from) {
  constexpr double kError = 0.02;  // of a second derivative that is wrong at an end
  lead(from.d, from.rate, to.d - from.d, to.rate, from.extent);
  const double most = 4 * h_ * (to.rate - from.rate).norm() + h_ * h_ * std::max(from.turning, to.turning);
  const auto wrong = [&](const Vector& bend, const LawPlace& end) {
    return std::min((bend - h_ * h_ * end.second).norm(), most);
  };
  error_ = kError * (wrong(2 * c_[2], from) + wrong(2 * c_[2] + 6 * c_[3], to));
}

// The derivative of d is rate + s change + s (1 − s) bulge.
void LawPath::lead(const Vector& from, const Vector& from_rate, const Vector& step, const Vector& end_rate,
                   double extent) {
  c_[0] = from;
  c_[1] = h_ * from_rate;
  c_[2] = 3 * step - h_ * (2 * from_rate + end_rate);
  c_[3] = h_ * (from_rate + end_rate) - 2 * step;
  rate_ = from_rate, change_ = end_rate - from_rate;
  bulge_.setZero();
  if (c_[3].norm() > kRoundedPlaces * extent) bulge_ = -3 / h_ * c_[3];
  if (const double most = kMostBulge * change_.norm(); bulge_.norm() > most) bulge_ *= most / bulge_.norm();
  v_ = moving(0.5).v;
}

Arguments<double> LawPath::moving(double s) const {
  return of_.arguments(place(s), t_ + s * h_);
}

Arguments<double> LawPath::arguments(double s) const {
  const Vector d = at(s);
  return {t_ + s * h_, (of_.torsion >= 0 ? d.x() : d.norm()) - of_.zero, v_};
}

Jet2<double> LawPath::along(double s) const {
  if (by_rate()) return moving_along(s);
  const Vector d = at(s), by_s = derivative(s);
  const double length = of_.torsion >= 0 ? d.x() : d.norm();
  const double longer = of_.torsion >= 0 ? by_s.x() : length > 0 ? d.dot(by_s) / length : 0;
  return of_.F->along<double>({{t_ + s * h_, h_, 0}, {length - of_.zero, longer, 0}, {v_, 0, 0}});
}

Jet2<double> LawPath::moving_along(double s) const {
  if (!moves()) return along(s);
  const LawPlace here = place(s);
  const Vector faster = change_ + (1 - 2 * s) * bulge_;
  const Arguments<double> x = of_.arguments(here, t_ + s * h_);
  double accelerated = faster.x();
  if (of_.torsion < 0) {
    const double length = here.d.norm();
    accelerated = length > 0 ? (here.d.dot(faster) + h_ * (here.rate.squaredNorm() - x.v * x.v)) / length : 0;
  }
  return of_.F->along<double>({{x.t, h_, 0}, {x.x, h_ * x.v, 0}, {x.v, accelerated, 0}});
}

double LawPath::slope(double s) const {
  return of_.F->law(arguments(s)).F_x;
}

Bounds LawPath::force(double from, double to) const {
  return of_.F->range(reached(from, to)).f;
}

// Taylor's formula about the middle of x, or v, too.
Bounds LawPath::close_force(double from, double to) const {
  const Expression& F = *of_.F;
  Arguments<Bounds> at = reached(from, to);
  const TapeOp by = by_rate() ? TapeOp::rate : TapeOp::elongation;
  Bounds& y = by_rate() ? at.v : at.x;
  const Jet2<Bounds> all = F.law_range(at, by);
  const auto switches = [&] {
    for (int k = 0; k < F.switch_count(); ++k) {
      const Bounds side = F.switch_range(k, at);
      if (!(side.least > 0 || side.most < 0)) return true;
    }
    return false;
  };
  if (F.depends_on_time() || switches()) return all.f;
  const double middle = y.least + 0.5 * (y.most - y.least);
  const Bounds off{y.least - middle, y.most - middle};
  y = {middle, middle};
  const Jet2<Bounds> there = F.law_range(at, by);
  const Bounds by_slope = there.f + all.fd * off;
  const Bounds by_bend = there.f + there.fd * off + 0.5 * (all.fdd * square(off));
  return {std::max({all.f.least, by_slope.least, by_bend.least}), std::min({all.f.most, by_slope.most, by_bend.most})};
}

Arguments<Bounds> LawPath::reached(double from, double to) const {
  Bounds x, v{v_, v_};
  if (of_.torsion >= 0) {
    x = component(0, from, to);
    if (by_rate()) v = rate_component(0, from, to);
  } else {
    const Bounds d[] = {component(0, from, to), component(1, from, to), component(2, from, to)};
    x = square(d[0]) + square(d[1]) + square(d[2]);
    x = rising({std::max(x.least, 0.0), x.most}, [](double y) { return std::sqrt(y); });
    if (by_rate()) {
      v = {0, 0};
      for (int k = 0; k < 3; ++k) v = v + d[k] * rate_component(k, from, to);
      v = v * reciprocal(x);
    }
  }
  const double least = x.least - of_.zero, most = x.most - of_.zero;
  // At its ends the step may touch switches of time, which are not within it.
  const double instant = std::min(kSwitchInstant * (std::abs(t_) + h_), 0.25 * (to - from) * h_);
  const double begin = t_ + from * h_ + (from == 0 ? instant : 0), end = t_ + to * h_ - (to == 1 ? instant : 0);
  return {{begin, end}, {least, most}, v};
}

// A quadratic, likewise.
Bounds LawPath::rate_component(int k, double from, double to) const {
  const double first = place(from).rate[k], last = place(to).rate[k];
  const double between = first + 0.5 * (to - from) * (change_ + (1 - 2 * from) * bulge_)[k];
  return {std::min({first, between, last}), std::max({first, between, last})};
}

// A cubic stays within its Bézier points.
Bounds LawPath::component(int k, double from, double to) const {
  const double third = (to - from) / 3, first = at(from)[k], last = at(to)[k];
  const double second = first + third * derivative(from)[k], before = last - third * derivative(to)[k];
  return {std::min({first, second, before, last}) - error_, std::max({first, second, before, last}) + error_};
}

}  // namespace poinsot
