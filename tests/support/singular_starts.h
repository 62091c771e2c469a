// Starts in singular positions and beside them: whatever the formulation and the integrator, a run that ends is right,
// and one that is refused or stops names a constraint that is singular there.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/input_error.h"
#include "integrators/integrator.h"
#include "integrators/start/reactions.h"
#include "tests/support/planar_motion.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

inline constexpr double kStride = 2e-3, kUntil = 0.12;  // s

inline void add_joint(Scene& scene, const char* name, JointType type, int i, int j, const Vector3& at,
                      const Vector3& axis = Vector3::UnitZ()) {
  Joint& joint = scene.joints.emplace_back();
  joint.name = name, joint.type = type, joint.i = i, joint.j = j, joint.point = at, joint.axis = axis;
}

inline Constraint& add_constraint(Scene& scene, const char* name, ConstraintType type, int j, const std::string& f) {
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

inline Attempt attempt(const Scene& scene, const Settings& settings) {
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

inline double largest_multiplier(const Snapshot& s) {
  double largest = 0;
  for (const double x : s.lambda) largest = std::max(largest, std::abs(x));
  return largest;
}

// In a singular position itself no multipliers need fit: then that is said.
inline bool says_open(const Attempt& c, double t) {
  return std::ranges::any_of(c.outcome.notices, [when = fmt::format("at t = {:.6g} s", t)](const auto& n) {
    return n.find(when) == 0 && (n.find("multipliers grow without bound") != std::string::npos ||
                                 n.find("leaves multipliers open") != std::string::npos);
  });
}

// By the order of the method, at kStride or at rtol 1e-8.
struct Allowed {
  double position, velocity, acceleration;
  double energy;     // J
  double equations;  // parts of the forces; at steps' ends most methods solve them
};
inline Allowed allowed(const IntegratorEntry& integrator) {
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
    for (std::size_t k = 0; k < c.off.size(); ++k) {
      if (says_open(c, c.samples[k].t)) continue;
      EXPECT_LT(c.off[k], most.equations * (1 + c.force[k]) + 1e-12 * largest_multiplier(c.samples[k]))
          << c.samples[k].t;
    }
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
inline Start toggle(const std::string& what, const Way& way, const Vector3& gravity) {
  Start start{what, scene_on(way, gravity), way};
  Scene& scene = start.scene;
  const Vector3 knee = 2 * scene.bodies[0].position, foot = scene.bodies[2].position;
  add_joint(scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
  add_joint(scene, "knee", JointType::cylindrical, 0, 1, knee);
  add_joint(scene, "foot", JointType::spherical, 1, 2, foot);
  add_joint(scene, "guide", JointType::translational, kGround, 2, foot, Vector3::UnitX());
  return start;
}

}  // namespace poinsot::test
