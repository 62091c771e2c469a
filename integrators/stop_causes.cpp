#include "integrators/stop_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/model_faults.h"
#include "core/scene_doubts.h"
#include "integrators/settings_table.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/sticking.h"
#include "integrators/stepping/turning.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

bool explain_by_functions(Status& status, const Problem& problem, const Settings& settings) {
  if (status.ok() || status.failure == Failure::interrupted) return false;
  constexpr double kNear = 1e-3;  // of the time: methods stop before
  const double t = status.time, near = std::max(chooses_steps(settings) ? 0 : settings.step, kNear * t);
  std::string fault = problem.fault();
  if (fault.empty()) fault = fault_of_functions(problem.model(), t);  // it may have gone back a step
  if (!fault.empty()) {
    status = no_value(t, fault);
  } else if (const std::string fast = faster_than_times(problem.model(), t, t + near, settings.end); !fast.empty()) {
    const bool at_once = !faster_than_times(problem.model(), 0, 0, settings.end).empty();
    status = with_remedy(Failure::rotation_too_large, t, fmt::format("at t = {:.9g} s {}", t, fast),
                         at_once ? "change the function" : "end before it, or change the function");
  } else if (const std::string grows = growing_without_bound(problem.model(), std::max(t - near, 0.0), t + near);
             !grows.empty()) {
    status = with_remedy(Failure::not_finite, t, fmt::format("at t = {:.9g} s {}", t, grows),
                         "end the run before, or change the function");
  } else if (const std::string why = overflowing(problem.model(), t); !why.empty()) {
    status = with_remedy(Failure::not_finite, t, fmt::format("at t = {:.9g} s a number overflows: {}", t, why),
                         "give it in units in which it is smaller");
  } else if (const std::string asked = beyond_any_position(problem.model(), std::max(t - near, 0.0), t + near);
             !asked.empty()) {
    status = with_remedy(Failure::singular_position, t,
                         fmt::format("at t = {:.9g} s the mechanism cannot go on: {}, which no position has", t, asked),
                         "end before it, or change the function");
  } else if (settings.analysis == Analysis::kinematics && status.failure == Failure::not_finite) {
    status = no_value(t, fmt::format("at t = {:.9g} s the matrix or the solution is not finite: a driver asks for "
                                     "more, or for it faster, than numbers can hold",
                                     t));
  } else {
    return false;
  }
  return true;
}

void explain_by_position(Status& status, Problem& problem, const Settings& settings, int rows, const Doubt& doubt,
                         const Eigen::VectorXd& q_start, const State& state) {
  const Failure failure = status.failure;
  const bool unexplained = failure == Failure::step_size_too_small || failure == Failure::not_converged ||
                           failure == Failure::singular_matrix ||
                           (failure == Failure::rotation_too_large && status.time > 0);
  if (!unexplained && failure != Failure::singular_position) return;
  // An output time within the last step: who finds nothing there to give out names the row, and stands elsewhere now.
  if (failure == Failure::singular_position && state.t > status.time) return;
  if (doubt.row >= 0 && !doubt.vanishing) {
    status.withdraw_remedy();
    status.explain(fmt::format(
        "{} follows from the other constraints but for less than {:.0e} of its length where the run begins, as axes "
        "and points of few digits leave it, and what it asks for beside them is rounding",
        describe_row(problem.model(), doubt.row), doubt.part));
    status =
        with_remedy(failure, status.time, std::move(status.message), "write axes and points with 12 digits or more");
    return;
  }
  const double instant = chooses_steps(settings) ? instant_of(settings.end) : settings.step;
  problem.set_position(state.t, span(state.q));
  problem.set_velocity(span(state.v));
  std::string why = undefined_angle(problem);
  if (!why.empty() && failure == Failure::rotation_too_large) return;  // which it says already
  if (why.empty()) why = sticking_law(problem, settings.linear(), state, instant);
  if (why.empty()) why = resting_law(problem, settings.linear(), state, instant);
  if (why.empty()) why = vanished_gradient(problem, state);
  bool barred = !why.empty();  // nothing helps but to change what these say
  if (!barred) {
    const NearSingular near = near_singular_position(problem, rows, span(q_start), status.time, span(state.q));
    if (unexplained || near.barred)
      why = near.sentence;
    else if (near.driven)
      why = kMayBeBarred;
    barred = near.barred;
  }
  if (barred) status.withdraw_remedy();
  if (!why.empty()) status.explain(why);
  if (barred || failure != Failure::step_size_too_small || status.remedy > 0) return;
  if (const std::string growing = why.empty() ? growing_motion(problem, state) : ""; !growing.empty()) {
    status.explain(growing);
    status = with_remedy(failure, status.time, std::move(status.message), "end before it");
  }
  status = with_settings(std::move(status), "try larger tolerances or an implicit integrator with a fixed step");
}

}  // namespace poinsot
