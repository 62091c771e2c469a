// Many ways to solve one scene, each measured against its reference: what `poinsot chart` and `poinsot advise` share.
//
// A case is a formulation, an integrator, a linear solver, and a step or a tolerance. Its first run is compared with
// the reference at the reference's output times; the runs after it are timed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/study/reference.h"

namespace poinsot::study {

struct Case {
  Settings settings;
  int level = 0;  // along its method's curve, from coarse to fine

  // So a case is called: "rA", "dop853", "block", "rtol", 1e-8.
  std::string parameter() const;
  double value() const;
  std::string method() const;  // "dop853 in rA", and its linear solver where that is not the usual one
};

struct Measured {
  std::string status = "ok";  // or why there are no figures
  PerQuantity error{};        // multipliers: not a number where the scene has none
  double violation_position = 0, violation_velocity = 0;
  double energy_drift = 0;  // relative to the largest kinetic energy; not a number where the scene's energy changes
  std::int64_t steps = 0, newton_iterations = 0, factorizations = 0;
  double seconds = 0, spread = 0;  // of the time-stepping loop: median, and distance of the quartiles relative to it

  bool ok() const { return status == "ok"; }
  bool left_out() const { return status.starts_with("left out"); }  // for the time it would take
};

inline constexpr int kOutputs = 20;  // output times after 0
inline const std::string kUsualSolver = Settings{}.linear_solver;

// What is varied and how long that may take: every formulation, and every integrator but those that pick
// among the others, where nothing else is said.
struct SweepPlan {
  std::vector<std::string> formulations, integrators, linear_solvers{kUsualSolver};
  std::vector<int> steps;          // over the whole time, multiples of kOutputs
  std::vector<double> tolerances;  // rtol
  // Runs expected to take longer than this, by the run before, are left out; integrators with error control may take
  // kPatience times as long: what they are for is the accuracy that takes time.
  double longest = 0;  // s
  int repetitions = 0;
  int digits = 0;        // of the reference
  bool reduced = false;  // as quick() has it, which the results say

  static SweepPlan full();
  static SweepPlan quick();
};
inline constexpr double kPatience = 5;
// Throws InputError where no integrator of the plan takes any of its formulations.
void require_cases(const SweepPlan& plan);

class Sweep {
 public:
  Sweep(const Scene& scene, double end, const Reference& reference);

  // `steps` over the whole time, or `rtol`, whichever the integrator goes by.
  Case make_case(const std::string& formulation, const IntegratorEntry& integrator, int steps, double rtol) const;
  // By level. Formulations an integrator refuses are left out.
  std::vector<std::vector<Case>> cases(const SweepPlan& plan) const;
  // The first run.
  Measured compare(const Case& one) const;
  // Compares all, then times those that are well, `repetitions` times in turn. `after`, if any, is told of every run.
  std::vector<Measured> measure(const std::vector<Case>& batch, int repetitions,
                                const std::function<void(const Case&)>& after = {}) const;

 private:
  const Scene& scene_;
  const Reference& reference_;
  Model model_;
  double end_;
  Sizes sizes_;
  double kinetic_energy_ = 0;
  bool conservative_ = false;
};

// Whether each point (error, seconds) is on the front: none is better in one and at least as good in the other. Errors
// below kResolved times `agreement`, how far the reference can be trusted, are equal; errors above kUseless and what is
// not a number do not count.
std::vector<bool> front(const std::vector<double>& errors, const std::vector<double>& seconds, double agreement);
// The same of measured cases in one quantity, by its number in kQuantities; failures are on no front.
std::vector<bool> front(const std::vector<Measured>& measured, std::size_t quantity, const Reference& reference);
inline constexpr double kResolved = 10, kUseless = 0.01;

}  // namespace poinsot::study
