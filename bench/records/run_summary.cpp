#include "bench/records/run_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/counted.h"
#include "core/printable.h"
#include "integrators/settings_reader.h"

namespace poinsot::records {
namespace {

constexpr std::size_t kShown = 20;  // bodies

// "klu on G: 3 factorizations with fresh pivots, 998 with kept ones, condition 17"
std::string description(const LinearWork& w) {
  std::string text = fmt::format("{} on {}", w.solver, w.system == "whole" ? "the whole matrix" : w.system);
  if (!w.handed_over_by.empty()) text += fmt::format(", handed over by {}", w.handed_over_by);
  text += fmt::format(": {} with fresh pivots, {} with kept ones", counted(w.factorizations, "factorization"),
                      w.refactorizations);
  if (w.refinements > 0) text += ", " + counted(w.refinements, "refinement");
  if (w.reciprocal_condition > 0) text += fmt::format(", condition {:.2g}", 1 / w.reciprocal_condition);
  return text;
}

// Where the bodies are.
std::string rows_of(const Scene& scene, const LastState& last) {
  std::string text = fmt::format("t = {:g} s\n", *last.t);
  std::size_t width = 4;
  for (const Body& body : scene.bodies) width = std::max(width, printable(body.name).size());
  const auto row = [](const Vector3& x) { return fmt::format("{:12.6g} {:12.6g} {:12.6g}", x.x(), x.y(), x.z()); };
  text += fmt::format("  {:<{}}  {:>38}  {:>38}  {:>38}\n", "body", width, "position, m", "velocity, m/s",
                      "angular velocity (body), rad/s");
  for (std::size_t b = 0; b < last.bodies.size(); ++b)
    text += fmt::format("  {:<{}}  {}  {}  {}\n", printable(scene.bodies[b].name), width, row(last.bodies[b].r),
                        row(last.bodies[b].rd), row(last.bodies[b].w));
  if (const std::size_t more = scene.bodies.size() - last.bodies.size(); more > 0 && !last.bodies.empty())
    text += fmt::format("  ... and {} more; --out FILE.csv writes all\n", more);
  return text;
}

// What a step cost.
std::string cost_of(const Statistics& s) {
  const auto steps = static_cast<double>(s.steps);
  std::string text = fmt::format("{}, {:.2f} Newton iterations, {:.2f} factorizations and {:.2f} solves a step\n",
                                 counted(s.steps, "step"), static_cast<double>(s.newton_iterations) / steps,
                                 static_cast<double>(s.factorizations) / steps, static_cast<double>(s.solves) / steps);
  const auto share = [&](double seconds) { return s.seconds.total > 0 ? 100 * seconds / s.seconds.total : 0.0; };
  text += fmt::format(
      "{:.3g} s, {:.3g} us a step: assembly {:.0f} %, factorization {:.0f} %, solve {:.0f} %, the rest {:.0f} %\n",
      s.seconds.total, 1e6 * s.seconds.total / steps, share(s.seconds.assembly), share(s.seconds.factor),
      share(s.seconds.solve), share(s.seconds.other));
  return text;
}

}  // namespace

void LastState::keep(const Sample& sample) {
  t = sample.t;
  bodies.resize(std::min(kShown, static_cast<std::size_t>(sample.problem.bodies())));
  sample.problem.to_bodies(sample.a, bodies);
}

std::string run_summary(const Scene& scene, const Settings& settings, const Outcome& outcome, const LastState& last) {
  std::string text;
  const Statistics& s = outcome.statistics;
  const bool kinematics = settings.analysis == Analysis::kinematics;
  text += fmt::format(
      "{}: {}, {}{}, {}, {}\n", printable(scene.name), kinematics ? "kinematics" : "dynamics", settings.formulation,
      kinematics ? "" : ", " + settings.integrator, settings.linear_solver,
      chooses_steps(settings) ? fmt::format("rtol = {:g}", settings.rtol) : fmt::format("h = {:g} s", settings.step));
  if (!last.t) return text;
  text += rows_of(scene, last) + (s.steps > 0 ? cost_of(s) : "no step came to its end\n");
  for (const MethodWork& w : s.methods)
    text += fmt::format("{}: t = {:.6g} to {:.6g} s in {}\n", w.integrator, w.from, w.to, counted(w.steps, "step"));
  for (const LinearWork& w : s.linear) text += fmt::format("{}\n", description(w));
  text += fmt::format("largest violation of the constraints: position {:.2g}, velocity {:.2g}\n", s.violation.position,
                      s.violation.velocity);
  if (s.energy_change)
    text += fmt::format("energy of what nothing drives or damps: off by {:.2g} of the largest kinetic energy\n",
                        *s.energy_change);
  return text;
}

}  // namespace poinsot::records
