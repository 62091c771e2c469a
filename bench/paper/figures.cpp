#include <fmt/format.h>

#include "bench/paper/figure.h"
#include "core/scene_reader.h"

namespace poinsot::paper {
namespace {

constexpr FigureEntry kFigures[] = {
    {"order_paper", "the paper's order analysis: one coordinate at 3 s, implicit Euler, all formulations", order_paper},
    {"order_integrators",
     "orders of every integrator of fixed step in positions, velocities, accelerations, multipliers",
     order_integrators},
    {"order_controlled", "the same of the one-step methods with error control, driven with equal steps",
     order_controlled},
    {"solution_deltas", "the paper's double pendulum: Δz from the reference over 5 s", solution_deltas},
    {"iterations", "the paper's two figures of Newton iterations over the step size, exact and simplified", iterations},
    {"energy", "energy of the free double pendulum over 1000 s, every integrator of fixed step", energy},
};

}  // namespace

std::span<const FigureEntry> figures() {
  return kFigures;
}

Scene FigureRequest::scene(std::string_view model) const {
  return read_scene(models / fmt::format("{}.json", model));
}

}  // namespace poinsot::paper
