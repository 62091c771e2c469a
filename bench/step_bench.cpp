// Whole steps of implicit Euler at the paper's settings: mechanism × formulation × jacobian × linear solver, and
// growing chains, trees and loops. Timed is the step loop itself; counters are per body and Newton iteration.
#include "bench/bench_support.h"
#include "integrators/jacobian_policy.h"
#include "integrators/simulate.h"

namespace poinsot::bench {
namespace {

void run(benchmark::State& state, const SceneSource& source, Settings settings) {
  const Scene scene = source.scene();
  Statistics sum;
  InstructionCounter counter;
  std::int64_t instructions = 0;
  for (auto _ : state) {
    const auto before = counter.read();
    const Outcome outcome = simulate(scene, settings, {});
    const auto after = counter.read();
    if (!outcome.status.ok()) return state.SkipWithError(outcome.status.message.c_str());
    const Statistics& s = outcome.statistics;
    state.SetIterationTime(s.seconds.total);
    sum.steps += s.steps;
    sum.newton_iterations += s.newton_iterations;
    sum.seconds.total += s.seconds.total;
    sum.seconds.assembly += s.seconds.assembly;
    sum.seconds.factor += s.seconds.factor;
    sum.seconds.solve += s.seconds.solve;
    sum.seconds.other += s.seconds.other;
    if (before && after) instructions += *after - *before;
  }
  const double steps = static_cast<double>(sum.steps);
  const double units = static_cast<double>(sum.newton_iterations) * static_cast<double>(scene.bodies.size());
  state.counters["us_per_step"] = 1e6 * sum.seconds.total / steps;
  state.counters["iterations"] = static_cast<double>(sum.newton_iterations) / steps;
  state.counters["us_per_body"] = 1e6 * sum.seconds.total / units;
  state.counters["assembly"] = sum.seconds.assembly / sum.seconds.total;
  state.counters["factor"] = sum.seconds.factor / sum.seconds.total;
  state.counters["solve"] = sum.seconds.solve / sum.seconds.total;
  state.counters["other"] = sum.seconds.other / sum.seconds.total;
  if (instructions > 0) state.counters["instructions_per_body"] = static_cast<double>(instructions) / units;
}

void add(const SceneSource& source, double end, bool dense) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const JacobianEntry& jacobian : jacobians()) {
      for (const LinearSolverEntry& solver : linear_solvers()) {
        if (solver.name == "dense" && !dense) continue;  // cubic cost
        Settings settings;
        settings.formulation = formulation.name;
        settings.integrator = "implicit_euler";
        settings.jacobian = jacobian.name;
        settings.linear_solver = solver.name;
        settings.step = 1e-3;
        settings.end = settings.every = end;
        settings.tolerance = 1e-3;
        const std::string of =
            fmt::format("step/{}/{}/{}/{}", source.name, formulation.name, jacobian.name, solver.name);
        benchmark::RegisterBenchmark(of.c_str(), run, source, settings)->UseManualTime();
      }
    }
  }
}

void register_all() {
  for (const SceneSource& source : mechanisms()) add(source, 1, true);
  for (const SceneGenerator& generator : scene_generators()) {
    for (const int bodies : {1, 10, 100, 1000, 10000, 100000}) {
      // a tenth of a second for short ones, a few steps for long ones
      const double end = bodies <= 100 ? 0.1 : bodies <= 1000 ? 0.02 : 0.005;
      add(generated(generator, bodies), end, bodies <= 10);
    }
  }
}

}  // namespace
}  // namespace poinsot::bench

int main(int argc, char** argv) {
  poinsot::bench::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
