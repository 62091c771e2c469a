// Assembly: the Newton matrix into its slots, against triplets with a rebuild of the compressed matrix.
#include <Eigen/SparseCore>
#include <algorithm>

#include "bench/bench_support.h"

namespace poinsot::bench {
namespace {

constexpr std::pair<const char*, MatrixKind> kKinds[] = {{"simplified", MatrixKind::simplified},
                                                         {"exact", MatrixKind::exact}};

void by_slot(benchmark::State& state, const SceneSource& source, const FormulationEntry& formulation, MatrixKind kind) {
  Standing standing(source.scene(), formulation);
  const std::unique_ptr<LinearSolver> layout = linear_solvers().require("klu").make();
  if (!standing.good || !layout->analyze(standing.problem->pattern(kind)).ok()) return state.SkipWithError("no start");
  PerBody figures(state, standing.problem->bodies());
  for (auto _ : state) {
    standing.assemble(kind, layout->slots(), layout->values());
    benchmark::ClobberMemory();
  }
}

// What an assembler without fixed slots does: a list of (row, column, value), compressed anew every time.
void by_triplets(benchmark::State& state, const SceneSource& source, const FormulationEntry& formulation,
                 MatrixKind kind) {
  Standing standing(source.scene(), formulation);
  const Pattern pattern = standing.problem->pattern(kind);
  std::vector<int> slots;
  int size = 0;
  for (const Block& block : pattern.blocks) {
    for (int c = 0; c < block.cols; ++c, size += block.rows) slots.push_back(size);
  }
  std::vector<double> values(static_cast<std::size_t>(size));
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(values.size());
  Eigen::SparseMatrix<double> matrix(pattern.n, pattern.n);
  PerBody figures(state, standing.problem->bodies());
  for (auto _ : state) {
    std::ranges::fill(values, 0.0);  // blocks that share an entry do not share a place here
    standing.assemble(kind, slots, values);
    triplets.clear();
    for (const Block& block : pattern.blocks) {
      for (int c = 0; c < block.cols; ++c) {
        for (int r = 0; r < block.rows; ++r)
          triplets.emplace_back(block.row + r, block.col + c, values[triplets.size()]);
      }
    }
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    benchmark::ClobberMemory();
  }
}

void residual(benchmark::State& state, const SceneSource& source, const FormulationEntry& formulation) {
  Standing standing(source.scene(), formulation);
  Problem& problem = *standing.problem;
  std::vector<double> out(static_cast<std::size_t>(problem.nv() + problem.nc()));
  PerBody figures(state, problem.bodies());
  for (auto _ : state) {
    problem.set_position(0, standing.q);
    problem.set_velocity(standing.v);
    problem.step_residual({1, Standing::kStep, Standing::kStep * Standing::kStep}, standing.a, standing.lambda, out);
    benchmark::ClobberMemory();
  }
}

void register_all() {
  std::vector<SceneSource> sources = mechanisms();
  sources.push_back(generated(*find_scene_generator("chain"), 100));
  for (const SceneSource& source : sources) {
    for (const FormulationEntry& formulation : formulations()) {
      const std::string of = fmt::format("{}/{}", source.name, formulation.name);
      benchmark::RegisterBenchmark(("residual/" + of).c_str(), residual, source, formulation);
      for (const auto& [kind_name, kind] : kKinds) {
        benchmark::RegisterBenchmark(fmt::format("slots/{}/{}", of, kind_name).c_str(), by_slot, source, formulation,
                                     kind);
        benchmark::RegisterBenchmark(fmt::format("triplets/{}/{}", of, kind_name).c_str(), by_triplets, source,
                                     formulation, kind);
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
