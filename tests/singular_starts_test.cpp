// Mechanisms that start in singular positions: whatever the formulation and the integrator, a run that ends is right,
// and one that is refused or stops names a constraint that is singular there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/input_error.h"
#include "integrators/integrator.h"
#include "integrators/start/reactions.h"
#include "tests/support/loops.h"
#include "tests/support/passages.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;

constexpr double kStride = 2e-3, kUntil = 0.12;  // s

struct Planar {
  double x, y, angle;
};
// How the bodies lie in the plane z = 0 by time, also before 0.
using Way = std::function<std::vector<Planar>(double t)>;

struct Rates {
  Planar at, rate, second;
};

// By differences of fourth order.
std::vector<Rates> rates(const Way& way, double t) {
  constexpr double e = 2e-3;
  const std::vector<Planar> x[] = {way(t - 2 * e), way(t - e), way(t), way(t + e), way(t + 2 * e)};
  std::vector<Rates> all;
  for (std::size_t b = 0; b < x[2].size(); ++b) {
    Rates& of = all.emplace_back(Rates{x[2][b], Planar{}, Planar{}});
    for (double Planar::*c : {&Planar::x, &Planar::y, &Planar::angle}) {
      of.rate.*c = (8 * (x[3][b].*c - x[1][b].*c) - (x[4][b].*c - x[0][b].*c)) / (12 * e);
      of.second.*c = (16 * (x[3][b].*c + x[1][b].*c) - (x[4][b].*c + x[0][b].*c) - 30 * x[2][b].*c) / (12 * e * e);
    }
  }
  return all;
}

// The angle after a time, which may be negative, from its acceleration; of fourth order.
double turned(double t, double phi, double w, const std::function<double(double phi, double w)>& acceleration) {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(t) / 2e-3)));
  const double h = t / steps;
  for (int n = 0; n < steps; ++n) {
    const double k1 = w, l1 = acceleration(phi, w);
    const double k2 = w + h / 2 * l1, l2 = acceleration(phi + h / 2 * k1, k2);
    const double k3 = w + h / 2 * l2, l3 = acceleration(phi + h / 2 * k2, k3);
    const double k4 = w + h * l3, l4 = acceleration(phi + h * k3, k4);
    phi += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    w += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  }
  return phi;
}

// The most that a motion is off its way, m and rad, over bodies and samples.
struct Off {
  double position = 0, velocity = 0, first_acceleration = 0, acceleration = 0;
};

Off off_way(const Way& way, const std::vector<Snapshot>& samples) {
  Off off;
  const auto vector = [](const Planar& p) { return Vector3(p.x, p.y, 0); };
  for (const Snapshot& s : samples) {
    const std::vector<Rates> right = rates(way, s.t);
    for (std::size_t b = 0; b < right.size(); ++b) {
      const auto& [at, rate, second] = right[b];
      const BodyState& body = s.bodies[b];
      const Vector3 x(std::cos(at.angle), std::sin(at.angle), 0), z = Vector3::UnitZ();
      off.position = std::max(off.position, (body.r - vector(at)).norm() + (body.A.col(0) - x).norm());
      off.velocity = std::max(off.velocity, (body.rd - vector(rate)).norm() + (body.w - rate.angle * z).norm());
      double& worst = s.t == 0 ? off.first_acceleration : off.acceleration;
      worst = std::max(worst, (body.rdd - vector(second)).norm() + (body.wd - second.angle * z).norm());
    }
  }
  return off;
}

// Bodies as they lie and move on the way at t = 0.
Scene scene_on(const Way& way, const Vector3& gravity) {
  Scene scene;
  scene.gravity = gravity;
  for (const auto& [at, rate, second] : rates(way, 0)) {
    Body& b = scene.bodies.emplace_back();
    b.name = fmt::format("bar{}", scene.bodies.size());
    b.mass = 1, b.inertia = Vector3(0.02, 0.1, 0.1).asDiagonal();
    b.position = {at.x, at.y, 0};
    b.orientation = Eigen::AngleAxisd(at.angle, Vector3::UnitZ()).toRotationMatrix();
    const auto rounded = [](double x) { return std::round(x * 1e6) / 1e6; };  // rates here are of few digits
    b.velocity = {rounded(rate.x), rounded(rate.y), 0}, b.angular_velocity = {0, 0, rounded(rate.angle)};
  }
  return scene;
}

void add_joint(Scene& scene, const char* name, JointType type, int i, int j, const Vector3& at,
               const Vector3& axis = Vector3::UnitZ()) {
  Joint& joint = scene.joints.emplace_back();
  joint.name = name, joint.type = type, joint.i = i, joint.j = j, joint.point = at, joint.axis = axis;
}

Constraint& add_constraint(Scene& scene, const char* name, ConstraintType type, int j, const std::string& f) {
  Constraint& c = scene.constraints.emplace_back();
  c.name = name, c.type = type, c.j = j, c.f = Expression::parse(f);
  return c;
}

struct Start {
  std::string what;
  Scene scene;
  std::optional<Way> way = std::nullopt;  // where the velocities lead; without one no run may end
  bool may_stop = false;                  // there is a way, but a run need not find it
  bool conserves = false;                 // energy
  bool kinematics = false;                // it has no degree of freedom

  // One of its constraints, by its name.
  bool named_in(const std::string& text) const {
    const auto named = [&](const auto& all) {
      return std::ranges::any_of(all, [&](const auto& of) { return text.find("'" + of.name + "'") != text.npos; });
    };
    return named(scene.joints) || named(scene.constraints) || named(scene.drivers);
  }
};

struct Attempt : Recorded {
  std::string refusal;         // of the run or its status; empty where it ended
  std::vector<double> energy;  // J, by sample, as the next
  std::vector<double> force;   // N, the largest reaction of a joint
  std::vector<double> off;     // N, |M a + Gᵀλ − Q|
};

Attempt attempt(const Scene& scene, const Settings& settings) {
  Attempt c;
  std::optional<Reactions> reactions;
  const auto observe = [&](const Sample& sample) {
    c.samples.push_back(snapshot(sample));
    if (settings.analysis == Analysis::kinematics) return;
    c.energy.push_back(sample.problem.energy());
    if (!reactions) reactions.emplace(sample.problem);
    reactions->update(sample);
    c.force.push_back(0);
    for (std::size_t g = 0; g < sample.problem.model().groups.size(); ++g) {
      Vector3 force, moment;
      reactions->of_group(static_cast<int>(g), force, moment);
      c.force.back() = std::max(c.force.back(), force.norm());
    }
    Eigen::VectorXd off(sample.problem.nv());
    const auto copy = sample.problem.clone();
    copy->set_position(sample.t, sample.q);
    copy->set_velocity(sample.v);
    copy->equations_of_motion(sample.a, sample.lambda, {off.data(), static_cast<std::size_t>(off.size())});
    c.off.push_back(off.cwiseAbs().maxCoeff());
  };
  try {
    c.outcome = simulate(scene, settings, observe);
    if (!c.outcome.status.ok()) c.refusal = "stopped: " + c.outcome.status.message;
  } catch (const InputError& error) {
    c.refusal = error.what();
  }
  return c;
}

// By the order of the method, at kStride or at rtol 1e-8.
struct Allowed {
  double position, velocity, acceleration;
  double energy;     // J
  double equations;  // parts of the forces; at steps' ends most methods solve them
};
Allowed allowed(const IntegratorEntry& integrator) {
  if (integrator.controls_error) return {1e-7, 1e-6, 1e-4, 5e-7, 1e-9};
  if (integrator.order == 1) return {5e-3, 0.05, 0.5, 5e-2, integrator.name == "half_implicit" ? 0.2 : 1e-9};
  return {2e-5, 2e-4, 0.3, 5e-4, 1e-9};  // accelerations of generalized_alpha ring after such a start
}

class SingularStarts : public ::testing::TestWithParam<std::string> {
 protected:
  static Settings settings_of(const IntegratorEntry& integrator, double end = kUntil) {
    Settings settings = dynamics(GetParam(), kStride, end, end / 4);
    settings.analysis = integrator.analysis;
    settings.integrator = integrator.name;
    settings.stopping = Settings{}.stopping;
    settings.tolerance = integrator.analysis == Analysis::kinematics ? 1e-12 : 1e-8;
    settings.rtol = 1e-8;
    return settings;
  }

  static void expect_right(const Attempt& c, const Start& start, const IntegratorEntry& integrator) {
    ASSERT_EQ(c.samples.size(), 5u);
    const Allowed most = allowed(integrator);
    const Off off = off_way(*start.way, c.samples);
    EXPECT_LT(off.position, most.position);
    EXPECT_LT(off.velocity, most.velocity);
    EXPECT_LT(off.first_acceleration, 1e-4);
    EXPECT_LT(off.acceleration, most.acceleration);
    for (std::size_t k = 1; k < c.off.size(); ++k)  // in the position itself no multipliers need fit
      EXPECT_LT(c.off[k], most.equations * (1 + c.force[k])) << c.samples[k].t;
    if (!start.conserves) return;
    const auto [least, largest] = std::ranges::minmax(c.energy);
    EXPECT_LT(largest - least, most.energy);
  }

  // Of all integrators of dynamics and, where the scene has no degree of freedom, of kinematics.
  static void expect_right_or_named(const std::vector<Start>& starts) {
    for (const Start& start : starts) {
      int ended = 0;
      for (const IntegratorEntry& integrator : integrators()) {
        const bool kinematic = integrator.analysis == Analysis::kinematics;
        if (refusal_of(integrator, GetParam()) || (kinematic && !start.kinematics)) continue;
        SCOPED_TRACE(::testing::Message() << start.what << ", " << integrator.name);
        const Attempt c = attempt(start.scene, settings_of(integrator));
        if (c.refusal.empty()) {
          EXPECT_TRUE(start.way) << "it ended where no motion is";
          if (start.way) expect_right(c, start, integrator);
          ++ended;
        } else if (kinematic && start.way && !start.may_stop) {
          // It takes no velocities from the scene, and two branches leave them open.
          EXPECT_EQ(c.outcome.status.time, 0) << c.refusal;
          EXPECT_TRUE(std::ranges::any_of(c.outcome.notices, [&](const auto& n) { return start.named_in(n); }));
        } else {
          EXPECT_TRUE(start.named_in(c.refusal)) << c.refusal;
          EXPECT_TRUE(!start.way || start.may_stop) << c.refusal;
        }
      }
      if (start.way && !start.may_stop) {
        EXPECT_GE(ended, 9) << start.what;
      }
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, SingularStarts, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// Crank from the origin and rod, 1 m each, at the angles φ and ψ, and a slider on the x axis.
std::vector<Planar> crank_and_rod(double phi, double psi) {
  const double x = std::cos(phi), y = std::sin(phi), u = std::cos(psi), v = std::sin(psi);
  return {{x / 2, y / 2, phi}, {x + u / 2, y + v / 2, psi}, {x + u, 0, 0}};
}

Way toggle_way(const std::function<double(double t)>& phi) {
  return [=](double t) { return crank_and_rod(phi(t), -phi(t)); };
}

// J φ̈ + ½ J' φ̇² = Q, where J = 0.7 + 6 sin²φ.
double toggle_acceleration(double phi, double w, const Vector3& g) {
  const double s = std::sin(phi), c = std::cos(phi);
  return (g.y() * c - 4 * g.x() * s - 6 * s * c * w * w) / (0.7 + 6 * s * s);
}

Start toggle(const std::string& what, const Way& way, const Vector3& gravity) {
  Start start{what, scene_on(way, gravity), way};
  Scene& scene = start.scene;
  const Vector3 knee = 2 * scene.bodies[0].position, foot = scene.bodies[2].position;
  add_joint(scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
  add_joint(scene, "knee", JointType::cylindrical, 0, 1, knee);
  add_joint(scene, "foot", JointType::spherical, 1, 2, foot);
  add_joint(scene, "guide", JointType::translational, kGround, 2, foot, Vector3::UnitX());
  return start;
}

// With a free slider the straight position is a regular one: what the same toggle does once it is driven is due to
// that.
TEST_P(SingularStarts, AStraightToggleWithAFreeSliderMovesAsOneCoordinate) {
  std::vector<Start> starts;
  for (const double w : {0.0, 2.0}) {
    for (const Vector3& g : {Vector3(-5, 0, 0), Vector3(1, -9.81, 0)}) {
      const auto acceleration = [=](double phi, double rate) { return toggle_acceleration(phi, rate, g); };
      const Way way = toggle_way([=](double t) { return turned(t, 0, w, acceleration); });
      starts.push_back(toggle(fmt::format("toggle at {} rad/s, gravity {} {}", w, g.x(), g.y()), way, g));
      starts.back().conserves = true;
    }
  }
  expect_right_or_named(starts);
}

// The slider of a straight toggle is driven, from rest: the knee goes up or down, as the velocities say. At rest there
// are two ways to go, or none, and none either for a law that begins with a velocity or stays where it is.
TEST_P(SingularStarts, AStraightToggleThatIsDrivenGoesWhereItsVelocitiesLead) {
  std::vector<Start> starts;
  for (const Vector3& g : {Vector3(5, 0, 0), Vector3(0, -9.81, 0)}) {
    for (const double w : {1.0, -1.0, 0.0}) {
      for (const char* law : {"2*cos(t)", "2 - t^2", "2 - t^4", "2 - t", "2"}) {
        const bool cosine = law == std::string("2*cos(t)"), leads = cosine || law == std::string("2 - t^2");
        const Way way = toggle_way([=](double t) { return w * (cosine ? t : 2 * std::asin(t / 2)); });
        Start start = toggle(fmt::format("press {} at {} rad/s, gravity {} {}", law, w, g.x(), g.y()), way, g);
        add_constraint(start.scene, "press", ConstraintType::CD, 2, law).c = Vector3::UnitX();
        start.kinematics = true;
        if (w == 0 || !leads) start.way.reset();
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// With gravity along it the press holds back with 3 cos φ + 2 g: bounded, unlike with gravity across.
TEST_P(SingularStarts, TheForceOfAPressOnAStraightToggleIsThatOfTheClosedForm) {
  const double g = 5;
  Start start = toggle("press", toggle_way([](double t) { return t; }), {g, 0, 0});
  add_constraint(start.scene, "press", ConstraintType::CD, 2, "2*cos(t)").c = Vector3::UnitX();
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
    SCOPED_TRACE(integrator.name);
    int seen = 0;
    std::optional<Reactions> reactions;
    const Outcome outcome = simulate(start.scene, settings_of(integrator), [&](const Sample& sample) {
      if (!reactions) reactions.emplace(sample.problem);
      reactions->update(sample);
      if (sample.t == 0) return;  // where the straight links can press as hard as they like against one another
      const Model& model = sample.problem.model();
      for (std::size_t k = 0; k < model.rows.size(); ++k) {
        if (model.groups[static_cast<std::size_t>(model.rows[k].group)].name != "press") continue;
        EXPECT_NEAR(reactions->lambda(static_cast<int>(k)), 3 * std::cos(sample.t) + 2 * g, 0.05) << sample.t;
        ++seen;
      }
    });
    ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
    EXPECT_EQ(seen, 4);
  }
}

// Two links in line between two pivots, which cannot move at all, though to first order the knee can.
TEST_P(SingularStarts, AStraightToggleHeldAtBothEndsDoesNotMove) {
  std::vector<Start> starts;
  for (const bool redundant : {false, true}) {
    for (const Vector3& g : {Vector3(0, 0, 0), Vector3(5, 0, 0), Vector3(0, -9.81, 0)}) {
      for (const double w : {0.0, 1.0}) {
        const Way way = [=](double t) {
          return std::vector<Planar>{{0.5, w * t / 2, w * t}, {1.5, w * t / 2, -w * t}};
        };
        Start start{fmt::format("held at {} rad/s, gravity {} {}, {}", w, g.x(), g.y(), redundant), scene_on(way, g)};
        add_joint(start.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
        add_joint(start.scene, "knee", redundant ? JointType::revolute : JointType::cylindrical, 0, 1, {1, 0, 0});
        add_joint(start.scene, "foot", redundant ? JointType::revolute : JointType::spherical, kGround, 1, {2, 0, 0});
        start.kinematics = true;
        start.may_stop = true;
        if (w == 0 && g.y() == 0) start.way = way;  // no force holds it against a load across
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// Crank and rod one upon the other, the slider at the crank's hinge: it slides on, or stays while both turn on.
TEST_P(SingularStarts, AFoldedToggleSlidesOrTurnsAsItsVelocitiesLead) {
  std::vector<Start> starts;
  const Vector3 g(1, -9.81, 0);
  const auto slides = [=](double phi, double w) { return toggle_acceleration(phi, w, g); };
  const auto turns = [=](double phi, double) { return (g.y() * std::cos(phi) - g.x() * std::sin(phi)) / 0.7; };
  for (const double w : {3.0, -3.0, 0.0}) {
    const Way sliding = toggle_way([=](double t) { return turned(t, pi / 2, w, slides); });
    const Way turning = [=](double t) {
      const double phi = turned(t, pi / 2, w, turns);
      return crank_and_rod(phi, phi + pi);
    };
    starts.push_back(toggle(fmt::format("sliding at {} rad/s", w), sliding, g));
    starts.push_back(toggle(fmt::format("turning at {} rad/s", w), turning, g));
  }
  for (Start& start : starts) start.conserves = true;
  for (std::size_t k = starts.size() - 2; k < starts.size(); ++k) starts[k].way.reset();
  expect_right_or_named(starts);
}

// Ground and coupler of 2 m, crank and rocker of 1 m, at the angles φ and ψ.
std::vector<Planar> parallelogram(double phi, double psi) {
  const double x = std::cos(phi), y = std::sin(phi), u = 2 + std::cos(psi), v = std::sin(psi);
  return {{x / 2, y / 2, phi}, {(x + u) / 2, (y + v) / 2, std::atan2(v - y, u - x)}, {1 + u / 2, v / 2, psi}};
}

// Flat, with its crank driven: as a parallelogram, ψ = φ, or crossed, tan ψ/2 = −3 tan φ/2.
TEST_P(SingularStarts, AFlatParallelogramThatIsDrivenStaysParallelOrCrosses) {
  std::vector<Start> starts;
  for (const bool redundant : {false, true}) {
    for (const char* law : {"t", "sin(t)", "t^2", "0"}) {
      const bool moves = law != std::string("t^2") && law != std::string("0");
      for (const bool crossed : {false, true}) {
        if (crossed && !moves) continue;
        const Way way = [=](double t) {
          const double phi = !moves ? 0 : law[0] == 's' ? std::sin(t) : t;
          return parallelogram(phi, crossed ? -2 * std::atan(3 * std::tan(phi / 2)) : phi);
        };
        Start start{fmt::format("motor {}{}{}", law, crossed ? ", crossed" : "", redundant ? ", redundant" : ""),
                    scene_on(way, {1, -9.81, 0})};
        Scene& scene = start.scene;
        add_joint(scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
        add_joint(scene, "knee", redundant ? JointType::revolute : JointType::cylindrical, 0, 1, {1, 0, 0});
        add_joint(scene, "elbow", redundant ? JointType::revolute : JointType::spherical, 1, 2, {3, 0, 0});
        add_joint(scene, "foot", JointType::revolute, kGround, 2, {2, 0, 0});
        Driver& motor = scene.drivers.emplace_back();
        motor.name = "motor", motor.j = 0, motor.axis = {0, 0, 1}, motor.value = Expression::parse(law);
        start.kinematics = true;
        if (moves) start.way = way;
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// A rod turned by the cosine of its angle from 0 on: at ±1 rad/s it turns on, at rest it has nowhere to go. A cosine
// that stays 1 holds it, one of 1 − t⁴ turns it from rest, either way: both are refused.
TEST_P(SingularStarts, ADirectionDrivenFromOneTurnsAsItsVelocityLeads) {
  std::vector<Start> starts;
  for (const char* law : {"cos(t)", "1", "1 - t^4"}) {
    for (const double w : {1.0, -1.0, 0.0}) {
      for (const bool helped : {false, true}) {
        const bool leads = law == std::string("cos(t)") && w != 0;
        if (helped && !leads) continue;
        const Way way = [=](double t) { return std::vector<Planar>{{std::cos(w * t), std::sin(w * t), w * t}}; };
        Start start{fmt::format("cosine {} at {} rad/s{}", law, w, helped ? ", helped" : ""),
                    scene_on(way, {0, -9.81, 0})};
        add_joint(start.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
        Constraint& cosine = add_constraint(start.scene, "cosine", ConstraintType::DP1, 0, law);
        cosine.a_i = cosine.a_j = {1, 0, 0};
        if (helped) cosine.alternate = {{0, 1, 0}, {1, 0, 0}, Expression::parse(fmt::format("sin({}*t)", w))};
        start.kinematics = true;
        if (leads) start.way = way;
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// A distance of 0 says nothing of the way in which it grows.
TEST_P(SingularStarts, ADistanceDrivenFromZeroIsRightOrRefusedByName) {
  std::vector<Start> starts;
  for (const bool driver : {false, true}) {
    for (const bool guided : {false, true}) {
      for (const char* law : {"t", "sin(t)", "t^2", "0"}) {
        for (const double v : {1.0, -1.0, 0.0}) {
          const bool sine = law[0] == 's', leads = v != 0 && (sine || law == std::string("t"));
          const Way way = [=](double t) { return std::vector<Planar>{{v * (sine ? std::sin(t) : t), 0, 0}}; };
          Start start{
              fmt::format("{} {} at {} m/s{}", driver ? "driver" : "distance", law, v, guided ? ", guided" : ""),
              scene_on(way, {guided ? 1.0 : 0.0, 0, 0})};
          if (guided)
            add_joint(start.scene, "guide", JointType::translational, kGround, 0, Vector3::Zero(), Vector3::UnitX());
          if (driver) {
            Driver& leg = start.scene.drivers.emplace_back();
            leg.name = "leg", leg.type = DriverType::distance, leg.j = 0, leg.value = Expression::parse(law);
          } else {
            add_constraint(start.scene, "leg", ConstraintType::D, 0, fmt::format("({})^2", law));
          }
          start.kinematics = guided;
          start.may_stop = true;
          if (leads && (guided || !sine)) start.way = way;
          starts.push_back(std::move(start));
        }
      }
    }
  }
  expect_right_or_named(starts);
}

// To first order each crank of a flat parallelogram may turn as it likes; only two of these ways lead on. Likewise a
// rod driven by the cosine of its angle, a press and a folded toggle.
TEST_P(SingularStarts, VelocitiesOnNoBranchAreRefusedByName) {
  std::vector<Start> starts;
  for (const double w : {0.0, -1.5, -2.999}) {
    Start start{fmt::format("posts, the other at {} rad/s", w), posts(1, 0, kSpin, false)};
    std::vector<Body>& bodies = start.scene.bodies;
    bodies[1].velocity = {0, w / 2, 0}, bodies[1].angular_velocity = {0, 0, w};
    bodies[2].velocity = {0, (w + kSpin) / 2, 0}, bodies[2].angular_velocity = {0, 0, w - kSpin};
    starts.push_back(std::move(start));
  }
  for (const double w : {0.5, 1.01, 2.0}) {
    const Way turning = [=](double t) { return std::vector<Planar>{{std::cos(w * t), std::sin(w * t), w * t}}; };
    Start cosine{fmt::format("cosine at {} rad/s", w), scene_on(turning, {0, -9.81, 0})};
    add_joint(cosine.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
    Constraint& row = add_constraint(cosine.scene, "cosine", ConstraintType::DP1, 0, "cos(t)");
    row.a_i = row.a_j = {1, 0, 0};
    cosine.kinematics = true;
    starts.push_back(std::move(cosine));

    Start press = toggle(fmt::format("press at {} rad/s", w), toggle_way([=](double t) { return w * t; }), {5, 0, 0});
    add_constraint(press.scene, "press", ConstraintType::CD, 2, "2*cos(t)").c = Vector3::UnitX();
    press.kinematics = true;
    press.way.reset();
    starts.push_back(std::move(press));
  }
  Start folded = toggle("folded", [](double t) { return crank_and_rod(pi / 2 + 2 * t, -pi / 2 - t); }, {1, -9.81, 0});
  folded.way.reset();
  starts.push_back(std::move(folded));
  expect_right_or_named(starts);
}

// Without accelerations what is left of them beside the position is rounding, and no jump.
TEST_P(SingularStarts, ARodThatTurnsAboutItsCentreKeepsTurning) {
  const Way way = [](double t) { return std::vector<Planar>{{0, 0, t}}; };
  Start start{"centred", scene_on(way, Vector3::Zero()), way};
  add_joint(start.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
  Constraint& cosine = add_constraint(start.scene, "cosine", ConstraintType::DP1, 0, "cos(t)");
  cosine.a_i = cosine.a_j = {1, 0, 0};
  start.kinematics = true;
  expect_right_or_named({start});
}

// The constraints alone leave rates open: none is given out, and a constraint is named.
TEST_P(SingularStarts, KinematicsFromASingularPositionIsRefusedByName) {
  for (const double beside : {0.0, 1e-13, 1e-10, 1e-7}) {
    const Way way = toggle_way([=](double t) { return beside + t; });
    Start start = toggle(fmt::format("{} rad beside", beside), way, {5, 0, 0});
    add_constraint(start.scene, "press", ConstraintType::CD, 2, fmt::format("2*cos(t + {})", beside)).c =
        Vector3::UnitX();
    Settings settings = dynamics(GetParam(), kStride, kUntil, kUntil / 4);
    settings.analysis = Analysis::kinematics;
    settings.integrator = "kinematics";
    settings.tolerance = 1e-12;
    const Attempt c = attempt(start.scene, settings);
    EXPECT_TRUE(start.named_in(c.refusal)) << beside << ' ' << c.refusal;
    EXPECT_THAT(c.refusal, ::testing::HasSubstr("singular here: ")) << beside;
    EXPECT_TRUE(c.samples.empty()) << beside;
  }
}

Way posts_way(int N, double angle, double w) {
  const double J = (N + 1) * 0.35 + N, m = (N + 1) * 0.5 + N;
  return [=](double t) {
    const double phi = turned(t, angle, w, [=](double at, double) { return -m * 9.81 * std::cos(at) / J; });
    std::vector<Planar> all;
    for (int k = 0; k <= N; ++k) all.push_back({k + 0.5 * std::cos(phi), 0.5 * std::sin(phi), phi});
    for (int k = 0; k < N; ++k) all.push_back({k + 0.5 + std::cos(phi), std::sin(phi), 0});
    return all;
  };
}

double largest_acceleration(const Snapshot& s) {
  double largest = 0;
  for (const BodyState& b : s.bodies) largest = std::max({largest, b.rdd.norm(), b.wd.norm()});
  return largest;
}

double largest_multiplier(const Snapshot& s) {
  double largest = 0;
  for (const double x : s.lambda) largest = std::max(largest, std::abs(x));
  return largest;
}

// Four-bars lying flat: what is given out there is of the size of what the same motion has 0.01 s before and after.
TEST_P(SingularStarts, FlatFourBarsHaveTheAccelerationsAndForcesOfThoseBeside) {
  constexpr double kBeside = 0.01;
  for (const int N : {1, 2}) {
    const Way way = posts_way(N, 0, kSpin);
    for (const bool redundant : {false, true}) {
      const Start flat{fmt::format("{} four-bars{}", N, redundant ? ", redundant" : ""), posts(N, 0, kSpin, redundant),
                       way, false, true};
      for (const IntegratorEntry& integrator : integrators()) {
        if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
        SCOPED_TRACE(::testing::Message() << flat.what << ", " << integrator.name);
        const Settings settings = settings_of(integrator, 4 * kBeside);
        const Attempt c = attempt(flat.scene, settings);
        ASSERT_TRUE(c.refusal.empty()) << c.refusal;
        expect_right(c, flat, integrator);
        // Of two, the middle post's share makes them grow without bound towards the position: the bound of ten times
        // is that of 0.01 s beside.
        if (N == 1) {
          EXPECT_LT(c.off[0], 1e-9);
        }
        for (const double beside : {-kBeside, kBeside}) {
          const Rates there = rates(way, beside)[0];
          const Attempt b =
              attempt(posts(N, there.at.angle, there.rate.angle, redundant), settings_of(integrator, kBeside / 2));
          ASSERT_TRUE(b.refusal.empty()) << b.refusal;
          for (const std::size_t k : {0u, 1u}) {
            EXPECT_NEAR(largest_acceleration(c.samples[k]) / largest_acceleration(b.samples[0]), 1, 0.2) << k;
            EXPECT_LT(c.force[k], 10 * b.force[0]) << k;
            EXPECT_GT(c.force[k], b.force[0] / 10) << k;
            EXPECT_LT(largest_multiplier(c.samples[k]), 10 * largest_multiplier(b.samples[0])) << k;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
