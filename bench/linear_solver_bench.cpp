// Factorization and solve of the exact Newton matrix, every linear solver × mechanism × formulation, and growing
// scenes; the whole matrix, and its constraint Jacobian alone where that is square ("klu_on_G").
#include <algorithm>

#include "bench/bench_support.h"
#include "core/index.h"
#include "linsolve/linear_system.h"

namespace poinsot::bench {
namespace {

enum class Part { factor, solve };

void run(benchmark::State& state, const SceneSource& source, const FormulationEntry& formulation,
         const LinearChoice& choice, Part part) {
  Standing standing(source.scene(), formulation);
  LinearSystems systems(choice);
  LinearSystem& linear = systems.add();
  if (!standing.good) return state.SkipWithError("no start");
  if (const LinearStatus s = linear.analyze(standing.problem->pattern(MatrixKind::exact)); !s.ok()) {
    return state.SkipWithError(s.message.c_str());
  }
  standing.assemble(MatrixKind::exact, linear.slots(), linear.values());
  std::vector<double> b(index(standing.problem->nv() + standing.problem->nc()), 1.0), x = b;
  for (int k = 0; k < 2; ++k) {  // the first factorization chooses pivots, the second keeps them
    if (const LinearStatus s = linear.factor(); !s.ok()) return state.SkipWithError(s.message.c_str());
    if (const LinearStatus s = linear.solve(x); !s.ok()) return state.SkipWithError(s.message.c_str());
  }
  const LinearWork work = systems.work().front();
  if ((choice.system == "auto") != (work.system == "G")) return state.SkipWithError("G is not square");
  if (!work.handed_over_by.empty()) return state.SkipWithError("handed over");
  {
    PerBody figures(state, standing.problem->bodies());
    for (auto _ : state) {
      if (part == Part::factor) {
        if (!linear.factor().ok()) return state.SkipWithError("factor");
      } else {
        std::copy(b.begin(), b.end(), x.begin());
        if (!linear.solve(x).ok()) return state.SkipWithError("solve");
      }
    }
  }
  state.counters["nonzeros"] = static_cast<double>(linear.statistics().nonzeros);
  state.counters["factor_nonzeros"] = static_cast<double>(linear.statistics().factor_nonzeros);
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
        for (const LinearSystemEntry& system : linear_systems()) {
          if (system.square_jacobian && !entry.takes_jacobian) continue;
          const std::string of = fmt::format("{}/{}/{}{}", source.name, formulation.name, entry.name,
                                             system.square_jacobian ? "_on_G" : "");
          const LinearChoice choice{std::string(entry.name), std::string(system.name)};
          benchmark::RegisterBenchmark(("factor/" + of).c_str(), run, source, formulation, choice, Part::factor);
          benchmark::RegisterBenchmark(("solve/" + of).c_str(), run, source, formulation, choice, Part::solve);
        }
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
