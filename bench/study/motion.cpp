#include "bench/study/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/input_error.h"
#include "core/so3.h"

namespace poinsot::study {
namespace {

constexpr double kNegligible = 1e-6;  // of the other kind of motion
constexpr double kRest = 1e-10;       // of what takes its place then: rounding
constexpr double kNoLength = 1e-12;   // m: rounding
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Sizes of linear and angular motion; where one is rounding, the other stands in, and where both are, `usual`, a linear
// one.
void settle(double& linear, double& angular, double length, double usual) {
  if (std::max(linear, length * angular) < kRest * usual) linear = usual;
  if (linear < kNegligible * length * angular) linear = length * angular;
  if (angular * length < kNegligible * linear) angular = linear / length;
}

// A multiplier as a force, N.
double as_force(const Row& row, double lambda, double length) {
  if (row.type == RowType::DP1 || row.type == RowType::angle) return lambda / length;
  return row.type == RowType::D ? lambda * length : lambda;
}

// What is no number stays.
void raise(double& largest, double x) {
  if (x > largest || std::isnan(x)) largest = x;
}

}  // namespace

void MotionRecorder::add(const Sample& sample) {
  motion_.t.push_back(sample.t);
  sample.problem.to_bodies(sample.a, motion_.bodies.emplace_back(static_cast<std::size_t>(sample.problem.bodies())));
  if (!reactions_) reactions_.emplace(sample.problem);
  reactions_->update(sample);
  std::vector<double>& lambda = motion_.lambda.emplace_back(sample.problem.model().rows.size());
  for (std::size_t row = 0; row < lambda.size(); ++row) lambda[row] = reactions_->lambda(static_cast<int>(row));
}

MotionRun run_motion(const Scene& scene, const Settings& settings, double longest) {
  using Clock = std::chrono::steady_clock;
  struct TooLong {
    double t;
  };
  const auto began = Clock::now();
  MotionRun run;
  MotionRecorder recorder(run.motion);
  double energy = 0;
  const auto keep = [&](const Sample& sample) {
    if (std::chrono::duration<double>(Clock::now() - began).count() > longest) throw TooLong{sample.t};
    if (run.motion.t.empty()) energy = sample.problem.energy();
    recorder.add(sample);
    run.energy_drift = std::max(run.energy_drift, std::abs(sample.problem.energy() - energy));
  };
  try {
    run.outcome = simulate(scene, settings, keep);
  } catch (const InputError& refused) {
    run.outcome.status = {Failure::inconsistent_state, 0, refused.what()};
  } catch (const TooLong& at) {
    run.outcome.status = {Failure::step_size_too_small, at.t,
                          fmt::format("given up after {:g} s, at t = {:g} s", longest, at.t)};
  }
  return run;
}

Sizes body_sizes(const Motion& motion) {
  Sizes s{0, 0, 0, 0, 0, 0};
  for (const auto& bodies : motion.bodies) {
    for (const BodyState& body : bodies) {
      s.length = std::max(s.length, body.r.norm());
      s.velocity = std::max(s.velocity, body.rd.norm());
      s.angular_velocity = std::max(s.angular_velocity, body.w.norm());
      s.acceleration = std::max(s.acceleration, body.rdd.norm());
      s.angular_acceleration = std::max(s.angular_acceleration, body.wd.norm());
    }
  }
  if (s.length < kNoLength) s.length = 1;
  const double time = motion.t.back() > 0 ? motion.t.back() : 1;
  settle(s.velocity, s.angular_velocity, s.length, s.length / time);
  settle(s.acceleration, s.angular_acceleration, s.length, s.velocity / time);
  return s;
}

Sizes sizes(const Motion& motion, const Model& model) {
  Sizes s = body_sizes(motion);
  for (const auto& lambda : motion.lambda)
    for (std::size_t row = 0; row < lambda.size(); ++row)
      s.force = std::max(s.force, std::abs(as_force(model.rows[row], lambda[row], s.length)));
  double mass = 0;
  for (const auto& body : model.bodies) mass += body.mass;
  if (s.force < kRest * mass * s.acceleration) s.force = mass * s.acceleration;
  return s;
}

BodyDifference body_difference(const Motion& motion, const Motion& from, const Sizes& sizes) {
  if (motion.t.size() != from.t.size()) return {kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, kInfinity};
  BodyDifference d;
  for (std::size_t k = 0; k < from.t.size(); ++k) {
    for (std::size_t b = 0; b < from.bodies[k].size(); ++b) {
      const BodyState &x = motion.bodies[k][b], &y = from.bodies[k][b];
      raise(d.r, (x.r - y.r).norm() / sizes.length);
      raise(d.A, angle_between(x.A, y.A));
      raise(d.rd, (x.rd - y.rd).norm() / sizes.velocity);
      raise(d.w, (x.w - y.w).norm() / sizes.angular_velocity);
      raise(d.rdd, (x.rdd - y.rdd).norm() / sizes.acceleration);
      raise(d.wd, (x.wd - y.wd).norm() / sizes.angular_acceleration);
    }
  }
  return d;
}

PerQuantity difference(const Motion& motion, const Motion& from, const Sizes& sizes, const Model& model) {
  const BodyDifference bodies = body_difference(motion, from, sizes);
  PerQuantity d{bodies.r, bodies.rd, bodies.rdd, motion.t.size() == from.t.size() ? 0 : kInfinity};
  raise(d[0], bodies.A);
  raise(d[1], bodies.w);
  raise(d[2], bodies.wd);
  if (d[3] > 0) return d;
  for (std::size_t k = 0; k < from.t.size(); ++k)
    for (std::size_t row = 0; row < from.lambda[k].size(); ++row)
      raise(d[3], std::abs(as_force(model.rows[row], motion.lambda[k][row] - from.lambda[k][row], sizes.length)) /
                      sizes.force);
  return d;
}

double kinetic_energy(const Motion& motion, const Model& model) {
  double largest = 0;
  for (const auto& bodies : motion.bodies) {
    double energy = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      energy += model.bodies[b].mass * bodies[b].rd.squaredNorm() / 2 +
                bodies[b].w.dot(model.bodies[b].inertia * bodies[b].w) / 2;
    largest = std::max(largest, energy);
  }
  return largest;
}

}  // namespace poinsot::study
