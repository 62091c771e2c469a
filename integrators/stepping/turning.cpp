#include "integrators/stepping/turning.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/index.h"

namespace poinsot {
namespace {

struct Fastest {
  std::string name;
  double rate;  // rad/s
};
Fastest fastest(const Problem& problem, std::span<const double> a) {
  std::vector<BodyState> states(index(problem.bodies()));
  problem.to_bodies(a, states);
  const auto body = std::ranges::max_element(states, {}, [](const BodyState& state) { return state.w.squaredNorm(); });
  return {problem.model().bodies[index(static_cast<int>(body - states.begin()))].name, body->w.norm()};
}

std::string name_of(const Model& model, const CountedTurn& turn) {
  if (turn.torsion >= 0) return "torsion spring '" + model.torsions[index(turn.torsion)].spring.name + "'";
  return turn.driver >= 0 ? describe_row(model, turn.driver)
                          : describe_group(model, model.followed[index(turn.followed)].group);
}

Status too_long_a_step(double t, std::string what, double serves) {
  Status status = with_settings({Failure::rotation_too_large, t, std::move(what)},
                                fmt::format("try a step of at most {:.2g} s", serves));
  status.step = serves;
  return status;
}

}  // namespace

std::string undefined_angle(const Problem& problem) {
  constexpr double kAlong = 0.1;
  const CountedTurn turn = problem.counted_turn();
  if (!(turn.across < kAlong)) return {};
  return fmt::format(
      "{} has no angle where its direction on the second body lies along its axis, as all but happens "
      "here ({:.1g} of it is across): name by \"a_i\" and \"a_j\" one that stays across",
      name_of(problem.model(), turn), turn.across);
}

Status turned_too_far(const Problem& problem, double t, double h) {
  if (const std::string undefined = undefined_angle(problem); !undefined.empty())
    return {Failure::rotation_too_large, t, fmt::format("at t = {:.9g} s {}", t, undefined)};
  const CountedTurn turn = problem.counted_turn();
  return too_long_a_step(
      t,
      fmt::format("at t = {:.9g} s {} turns at {:.4g} rad/s, by {:.3g} rad in a step: beyond half a turn its turns "
                  "cannot be counted",
                  t, name_of(problem.model(), turn), turn.rate, h * turn.rate),
      0.3 * kMostCounted / turn.rate);
}

Status rotated_too_far(const Problem& problem, std::span<const double> a, double t, double h, double most, double began,
                       double serves) {
  constexpr double kGrown = 4;
  const auto [name, rate] = fastest(problem, a);
  const bool grown = t > 0 && h * rate > kGrown * began;
  return too_long_a_step(
      t,
      fmt::format("at t = {:.9g} s body '{}' turns by {:.3g} rad in a step; in formulation {} the integrator makes "
                  "no sense beyond {:.2g}: rotation is lost or invented{}",
                  t, name, h * rate, problem.formulation(), most,
                  grown ? fmt::format("; the run began with at most {:.2g} rad: it has become so fast since, or what "
                                      "is computed grows by itself",
                                      began)
                        : ""),
      serves);
}

Status turned_unexpectedly(const Problem& problem, std::span<const double> a, double t, double h, double unexpected,
                           double serves) {
  const auto [name, rate] = fastest(problem, a);
  return too_long_a_step(
      t,
      fmt::format("at t = {:.9g} s the step may have ended on another branch than the motion leads to: body '{}' "
                  "turns by {:.3g} rad in it, a body by {:.3g} rad more or less than in the step before",
                  t, name, h * rate, unexpected),
      serves);
}

Status leads_too_far(const Problem& problem, std::span<const double> a, double t, int parts, double serves) {
  const auto [name, rate] = fastest(problem, a);
  return too_long_a_step(
      t,
      fmt::format("at t = {:.9g} s a step goes further than {} parts of it can follow: body '{}' turns at {:.3g} "
                  "rad/s",
                  t, parts, name, rate),
      serves);
}

}  // namespace poinsot
