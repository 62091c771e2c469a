// What the benchmarks share: scenes by name, and a problem that stands at its start, ready to be assembled and solved.
#pragma once

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/instruction_counter.h"
#include "core/model.h"
#include "core/scene_generator.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/start/initial_state.h"
#include "integrators/state.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/registry.h"

namespace poinsot::bench {

// Where a scene comes from; read or generated only when its benchmark runs, since the large ones fill memory.
struct SceneSource {
  std::string name;
  const SceneGenerator* generator = nullptr;  // null: the model file of this name
  int bodies = 0;

  Scene scene() const {
    return generator ? generator->make(bodies)
                     : read_scene(std::string(POINSOT_SOURCE_DIR) + "/models/" + name + ".json");
  }
};
inline std::vector<SceneSource> mechanisms() {
  return {{"single_pendulum"}, {"double_pendulum"}, {"four_link"}, {"slider_crank"}};
}
inline SceneSource generated(const SceneGenerator& generator, int bodies) {
  return {fmt::format("{}_{}", generator.name, bodies), &generator, bodies};
}

// A scene in a formulation at its initial state, at rest in time: the matrices of a step of 1 ms.
class Standing {
 public:
  Standing(const Scene& scene, const FormulationEntry& formulation)
      : model_(std::make_shared<const Model>(compile(scene))) {
    const InitialState start = find_initial_state(model_, Settings());
    problem = formulation.make(model_, start.rank.aside);
    State state(*problem);
    good = start.status.ok();
    if (good) problem->from_bodies(start.bodies, span(state.q), span(state.v));
    q.assign(state.q.begin(), state.q.end());
    v.assign(state.v.begin(), state.v.end());
    a.assign(v.size(), 0.1);
    dq.assign(v.size(), 1e-4);
    lambda.assign(state.lambda().size(), 1.0);
    problem->set_position(0, q);
    problem->set_velocity(v);
  }

  void assemble(MatrixKind kind, std::span<const int> slots, std::span<double> values) {
    problem->assemble(kind, {1, kStep, kStep * kStep}, dq, a, lambda, slots, values);
  }

  static constexpr double kStep = 1e-3;
  std::unique_ptr<Problem> problem;
  std::vector<double> q, v, a, dq, lambda;
  bool good = false;

 private:
  std::shared_ptr<const Model> model_;
};

// Time and instructions for each body and iteration of the benchmark's loop.
class PerBody {
 public:
  PerBody(benchmark::State& state, int bodies) : state_(state), bodies_(bodies), before_(counter_.read()) {}
  ~PerBody() {
    const double units = static_cast<double>(state_.iterations()) * bodies_;
    if (units == 0) return;
    state_.counters["time_per_body"] =  // shown with its unit
        benchmark::Counter(units, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    if (const auto now = counter_.read(); now && before_) {
      state_.counters["instructions_per_body"] = static_cast<double>(*now - *before_) / units;
    }
  }

 private:
  benchmark::State& state_;
  int bodies_;
  InstructionCounter counter_;
  std::optional<std::int64_t> before_;
};

}  // namespace poinsot::bench
