#include "integrators/stepping/passed_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/bounds.h"
#include "core/index.h"

namespace poinsot {
namespace {

// What a body carries: a point, or its turn.
struct Carried {
  Vector3 x = Vector3::Zero(), rate = Vector3::Zero(), second = Vector3::Zero();
  double turning = 0;  // of the second
};
Carried carried(std::span<const BodyState> bodies, int body, const Vector3& s) {
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

// F on the way of a spring, by s from 0 to 1.
class PassedLaws::Path {
 public:
  Path(const Law& of, double from, double to, bool has_end) : of_(of), t_(from), h_(to - from) {
    const Vector step =
        has_end ? Vector(of.to.d - of.from.d) : Vector(h_ * of.from.rate + 0.5 * h_ * h_ * of.from.second);
    const Vector end_rate = has_end ? of.to.rate : Vector(of.from.rate + h_ * of.from.second);
    c_[0] = of.from.d;
    c_[1] = h_ * of.from.rate;
    c_[2] = 3 * step - h_ * (2 * of.from.rate + end_rate);
    c_[3] = h_ * (of.from.rate + end_rate) - 2 * step;
    if (has_end) {
      constexpr double kError = 0.02;  // of a second derivative that is wrong at an end
      const double most =
          4 * h_ * (of.to.rate - of.from.rate).norm() + h_ * h_ * std::max(of.from.turning, of.to.turning);
      const auto wrong = [&](const Vector& bend, const Place& at) {
        return std::min((bend - h_ * h_ * at.second).norm(), most);
      };
      error_ = kError * (wrong(2 * c_[2], of.from) + wrong(2 * c_[2] + 6 * c_[3], of.to));
    }
    const Vector d = at(0.5), rate = derivative(0.5) / h_;
    v_ = of.torsion >= 0 ? rate.x() : d.norm() > 0 ? d.dot(rate) / d.norm() : rate.norm();
  }

  double force(double s) const {
    const Vector d = at(s);
    return of_.F->law(Arguments<double>{t_ + s * h_, (of_.torsion >= 0 ? d.x() : d.norm()) - of_.zero, v_}).F;
  }

  Bounds force(double from, double to) const {
    Bounds x;
    if (of_.torsion >= 0) {
      x = component(0, from, to);
    } else {
      x = square(component(0, from, to)) + square(component(1, from, to)) + square(component(2, from, to));
      x = rising({std::max(x.least, 0.0), x.most}, [](double y) { return std::sqrt(y); });
    }
    const double least = x.least - of_.zero, most = x.most - of_.zero;
    // At its ends the step may touch switches of time, which are not within it.
    const double instant = std::min(kInstant * (std::abs(t_) + h_), 0.25 * (to - from) * h_);
    const double begin = t_ + from * h_ + (from == 0 ? instant : 0), end = t_ + to * h_ - (to == 1 ? instant : 0);
    return of_.F->range({{begin, end}, {least, most}, {v_, v_}}).f;
  }

 private:
  Vector at(double s) const { return c_[0] + s * (c_[1] + s * (c_[2] + s * c_[3])); }
  Vector derivative(double s) const { return c_[1] + s * (2 * c_[2] + 3 * s * c_[3]); }
  // A cubic stays within its Bézier points.
  Bounds component(int k, double from, double to) const {
    const double third = (to - from) / 3, first = at(from)[k], last = at(to)[k];
    const double second = first + third * derivative(from)[k], before = last - third * derivative(to)[k];
    return {std::min({first, second, before, last}) - error_, std::max({first, second, before, last}) + error_};
  }

  const Law& of_;
  const double t_, h_;
  std::array<Vector, 4> c_;
  double error_ = 0, v_ = 0;
};

// What F comes to at the ends of a step and at several places of it, widened to either side.
class PassedLaws::Seen {
 public:
  Seen(Bounds values, double nothing) : values_(values), nothing_(nothing) {}
  void add(double F) { values_ = hull(values_, {F, F}); }
  bool holds(Bounds F) const {
    const double beyond = kBeyond * (values_.most - values_.least) + nothing_;
    return !(F.least < values_.least - beyond) && !(F.most > values_.most + beyond);
  }

 private:
  Bounds values_;
  double nothing_;
};

// Where F comes to more, about: shortly after `from`, where it does not, or before `to`, where it does. In the middle
// of it a force may have no direction.
double PassedLaws::entry(const Path& path, const Seen& seen, double from, double to) {
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = from + 0.5 * (to - from), there = path.force(middle);
    (seen.holds({there, there}) ? from : to) = middle;
  }
  return to;
}

PassedLaws::Unseen PassedLaws::first_unseen(const Path& path, const Seen& seen, double from, double to, int partings,
                                            int& pieces) {
  if (seen.holds(path.force(from, to))) return {};
  const double middle = from + 0.5 * (to - from), there = path.force(middle);
  if (!seen.holds({there, there})) return {entry(path, seen, from, middle), true};
  if (partings == 0 || --pieces < 0) return {from, false};
  const Unseen sooner = first_unseen(path, seen, from, middle, partings - 1, pieces);
  return sooner.s < 1 ? sooner : first_unseen(path, seen, middle, to, partings - 1, pieces);
}

PassedLaws::PassedLaws(const Model& model, double end, double rtol, double atol, Tell tell)
    : model_(model), end_(end), rtol_(rtol), atol_(atol), tell_(std::move(tell)) {
  const auto add = [&](const std::optional<Expression>& law, int spring, int torsion, double zero, double inertia) {
    if (law && !law->is_constant() && !law->is_function())
      laws_.push_back({&*law, spring, torsion, zero, inertia, {}, {}, {}});
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
  if (!laws_.empty()) bodies_.resize(model.bodies.size());
}

PassedLaws::Place PassedLaws::place(const Problem& problem, const Law& of) const {
  if (of.spring >= 0) {
    const Spring& s = model_.springs[index(of.spring)];
    const Carried i = carried(bodies_, s.i, s.s_i), j = carried(bodies_, s.j, s.s_j);
    return {j.x - i.x, j.rate - i.rate, j.second - i.second, i.turning + j.turning};
  }
  const TorsionElement& e = model_.torsions[index(of.torsion)];
  const auto turn = [&](int body) {
    return body == kGround ? Carried{}
                           : Carried{{},
                                     bodies_[index(body)].A * bodies_[index(body)].w,
                                     bodies_[index(body)].A * bodies_[index(body)].wd};
  };
  const Carried i = turn(e.spring.i), j = turn(e.spring.j);
  Vector3 axis = e.a_i.cross(e.b_i);
  if (e.spring.i != kGround) axis = bodies_[index(e.spring.i)].A * axis;
  return {{problem.twist(of.torsion), 0, 0}, {axis.dot(j.rate - i.rate), 0, 0}, {axis.dot(j.second - i.second), 0, 0}};
}

void PassedLaws::look(const Problem& problem, const State& at) {
  problem.to_bodies(at.a(), bodies_);
  for (Law& of : laws_) of.to = place(problem, of);
}

void PassedLaws::begin(const Problem& problem, const State& from) {
  if (laws_.empty()) return;
  look(problem, from);
  for (Law& of : laws_) of.from = of.to;
  t_ = from.t;
}

double PassedLaws::reach(const Problem& problem, const State& to) {
  if (laws_.empty()) return to.t;
  look(problem, to);
  double reach = to.t;
  for (Law& of : laws_) reach = std::min(reach, cut(of, Path(of, t_, to.t, true), t_, to.t));
  if (reach < to.t) {
    leave_unknown(reach);
    return reach;
  }
  for (Law& of : laws_) of.before = std::exchange(of.from, of.to);
  before_ = std::exchange(t_, to.t);
  return reach;
}

void PassedLaws::take_back() {
  for (Law& of : laws_) of.from = of.before;
  t_ = before_;
}

double PassedLaws::ahead(double to) {
  double reach = to;
  for (Law& of : laws_) reach = std::min(reach, cut(of, Path(of, t_, to, false), t_, to));
  if (reach < to) leave_unknown(reach);
  return reach;
}

double PassedLaws::cut(Law& of, const Path& path, double from, double to) const {
  const double h = to - from, before = path.force(0), after = path.force(1);
  of.largest = std::max({of.largest, std::abs(before), std::abs(after)});
  const double nothing = kUnseen * std::max(rtol_ * of.largest, atol_ * of.inertia / h);
  Seen seen({std::min(before, after), std::max(before, after)}, nothing);
  if (h <= kResolved * end_ || seen.holds(path.force(0, 1))) return to;
  std::array<double, std::size(kNodes)> there;
  std::ranges::transform(kNodes, there.begin(), [&](double s) { return path.force(s); });
  std::ranges::sort(there);
  seen.add(there[kPlaces - 1]), seen.add(there[there.size() - kPlaces]);
  int pieces = kMostPieces;
  const Unseen first = first_unseen(path, seen, 0, 1, kPartings, pieces);
  if (!(first.s < 1)) return to;
  of.unknown = first.known ? 0 : of.unknown + 1;
  return from + h * (first.known || first.s > kPart ? first.s : 0.5);
}

// Arithmetic on intervals may not say what a law comes to, or no more than bounds far from the truth.
void PassedLaws::leave_unknown(double t) {
  std::erase_if(laws_, [&](const Law& of) {
    if (of.unknown < kMostUnknown) return false;
    tell_(
        fmt::format("from t = {:.6g} s on '{}' is not watched for what it does within less than a step, since it has "
                    "no close bounds there",
                    t, of.F->text()));
    return true;
  });
}

}  // namespace poinsot
