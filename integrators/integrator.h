// The seam of the integrators: one run of one problem, a sample at every output time, statistics and a status at the
// end.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/registry.h"
#include "core/status.h"
#include "formulations/formulation.h"
#include "formulations/problem.h"
#include "integrators/settings.h"
#include "integrators/state.h"
#include "linsolve/linear_system.h"

namespace poinsot {

// What one method did of a run that may have several.
struct MethodWork {
  std::string_view integrator;  // by its name
  double from = 0, to = 0;      // s
  std::int64_t steps = 0;
};

// Estimated for the accelerations (in the formulation's coordinates) and multipliers that were given out last: of index
// 3 as computed by the steps, or of index 1 (stepping/index1_output.h).
struct AccelerationError {
  int index = 3;
  double acceleration = 0, multiplier = 0;
};

// The contract's run statistics. Seconds: total is the time-stepping loop without reading and writing.
struct Statistics {
  std::int64_t steps = 0, rejected_steps = 0;  // rejected: by error control, done again with a smaller step
  std::int64_t divided_steps = 0;              // of fixed size: that failed as a whole and were done in parts
  std::int64_t newton_iterations = 0, jacobian_evaluations = 0, factorizations = 0, solves = 0;
  struct {
    double total = 0, assembly = 0, factor = 0, solve = 0, other = 0;
  } seconds;
  // Of Newton's method: ratios of successive corrections within a step.
  struct {
    double sum = 0;
    std::int64_t count = 0;
    double rate() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
  } convergence;
  LargestResidual violation;                            // the largest over the run
  std::optional<AccelerationError> acceleration_error;  // of methods that solve at index 3
  // |T + V at the end − at the start| over the largest T, of mechanisms that nothing drives or damps: the largest. None
  // where there are none, or they rest.
  std::optional<double> energy_change;
  double largest_rotation = 0;      // rad, of a body in an accepted step: h |ω| at its end
  std::vector<LinearWork> linear;   // which linear solvers factored which systems; the busiest first
  std::vector<MethodWork> methods;  // of an integrator that picks among the others: which it picked, in turn
};

// A point of the trajectory. The problem stands at (t, q, v); where a function of time has a kink or jumps at t, what
// is given is of its side at `instant`, a last digit beside t.
struct Sample {
  double t;
  double instant;
  const Problem& problem;
  std::span<const double> q, v, a, lambda;
};
using Observer = std::function<void(const Sample&)>;
// A sentence the user should know of, the moment it is known.
using Tell = std::function<void(const std::string& notice)>;

// How far a body may turn in a step of fixed length, rad, by the space of the formulation's coordinates: as measured on
// free bodies over one turn (integrators/README.md).
struct Rotations {
  struct Limit {
    double wrong = kUnlimited;      // from here on |ω| is off by more than 3 % after a turn, without any load
    double senseless = kUnlimited;  // from here on by more than half, or Newton's method fails
  };
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  Limit lie_group = {}, vector_space = {}, charts = {};

  const Limit& in(CoordinateSpace space) const {
    return space == CoordinateSpace::lie_group ? lie_group : space == CoordinateSpace::charts ? charts : vector_space;
  }
};

class EnergyBalance;  // integrators/stepping/energy_balance.h

// What an integrator is given: the problem, how to solve it, and where what it finds goes.
struct Run {
  Problem& problem;
  LinearSystems& systems;
  const Settings& settings;
  State& state;  // consistent at 0
  const Observer& observe;
  Statistics& statistics;
  const Tell& tell;
  double most_rotation = Rotations::kUnlimited;  // rad of a body in a step of fixed length, beyond which it stops
  // s: where the state is in a singular position, after which its velocities have led away; else 0. The state's a and λ
  // are limits there, which [M Gᵀ; G 0] does not give.
  double singular_for = 0;
  EnergyBalance* energy = nullptr;  // where something is to keep it; looked at after every step
  // Of a run beside another one under error control: steps rejected, beyond which it is given up.
  std::int64_t most_rejected = std::numeric_limits<std::int64_t>::max();
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  // Advances the run's state to settings.end. After a failure its q and v are those of the last good step, as the
  // samples given out are.
  virtual Status run(const Run& run) = 0;
};

// A number that means something to one method or to some: a key of the configuration like the others.
struct MethodParameter {
  std::string_view name;
  std::string_view about;  // one line
  double by_default;
  double least, most;

  double of(const Settings& settings) const {
    const auto given = settings.parameters.find(name);
    return given == settings.parameters.end() ? by_default : given->second;
  }
};

struct IntegratorEntry {
  std::string_view name;
  std::string_view about;  // one line: order, what it needs, what it refuses
  Analysis analysis;
  int order;  // in the step, of positions, velocities, accelerations and multipliers alike; 0: not a matter of steps
  std::unique_ptr<Integrator> (*make)();
  bool controls_error = false;      // chooses its steps by rtol and atol; `step` and `tolerance` mean nothing to it
  bool needs_vector_space = false;  // of coordinates with their rates as velocities: CoordinateSpace::vector_space
  std::span<const MethodParameter> parameters = {};
  Rotations rotations = {};
  bool picks = false;  // among the others: those who compare methods leave it out
};

Registry<IntegratorEntry>& integrators();

// A formulation an integrator cannot be used with, and why.
struct Refusal {
  std::string_view formulation;
  std::string why;  // a clause: "it needs a vector space of coordinates ..."
};
// Nothing where the integrator takes the formulation.
std::optional<Refusal> refusal_of(const IntegratorEntry& integrator, std::string_view formulation);

}  // namespace poinsot
