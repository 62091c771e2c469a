// Factorization and solve of the exact Newton matrix, every linear solver × mechanism × formulation, and growing
// scenes.
#include <algorithm>

#include "bench/bench_support.h"

namespace poinsot::bench {
namespace {

enum class Part { factor, solve };

void run(benchmark::State& state, const SceneSource& source, const FormulationEntry& formulation,
         const LinearSolverEntry& entry, Part part) {
  Standing standing(source.scene(), formulation);
  const std::unique_ptr<LinearSolver> solver = entry.make();
  if (!standing.good) return state.SkipWithError("no start");
  if (const LinearStatus s = solver->analyze(standing.problem->pattern(MatrixKind::exact)); !s.ok()) {
    return state.SkipWithError(s.message.c_str());
  }
  standing.assemble(MatrixKind::exact, solver->slots(), solver->values());
  std::vector<double> b(static_cast<std::size_t>(solver->size()), 1.0), x = b;
  for (int k = 0; k < 2; ++k) {  // the first factorization chooses pivots, the second keeps them
    if (const LinearStatus s = solver->factor(); !s.ok()) return state.SkipWithError(s.message.c_str());
    if (const LinearStatus s = solver->solve(x); !s.ok()) return state.SkipWithError(s.message.c_str());
  }
  {
    PerBody figures(state, standing.problem->bodies());
    for (auto _ : state) {
      if (part == Part::factor) {
        if (!solver->factor().ok()) return state.SkipWithError("factor");
      } else {
        std::copy(b.begin(), b.end(), x.begin());
        if (!solver->solve(x).ok()) return state.SkipWithError("solve");
      }
    }
  }
  state.counters["nonzeros"] = static_cast<double>(solver->statistics().nonzeros);
  state.counters["factor_nonzeros"] = static_cast<double>(solver->statistics().factor_nonzeros);
}

void register_all() {
  std::vector<SceneSource> sources = mechanisms();
  for (const SceneGenerator& generator : scene_generators()) {
    for (const int bodies : {100, 10000}) {
      sources.push_back(generated(generator, bodies));
    }
  }
  for (const SceneSource& source : sources) {
    for (const FormulationEntry& formulation : formulations()) {
      for (const LinearSolverEntry& entry : linear_solvers()) {
        if (entry.name == "dense" && source.bodies > 10) continue;  // cubic cost
        const std::string of = fmt::format("{}/{}/{}", source.name, formulation.name, entry.name);
        benchmark::RegisterBenchmark(("factor/" + of).c_str(), run, source, formulation, entry, Part::factor);
        benchmark::RegisterBenchmark(("solve/" + of).c_str(), run, source, formulation, entry, Part::solve);
      }
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
