// Errors over the step size of the one-step methods with error control, driven with equal steps, in every formulation,
// and the exponents fitted to them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include "bench/paper/order_fit.h"
#include "formulations/registry.h"
#include "integrators/equal_steps.h"
#include "integrators/methods/dop853.h"
#include "integrators/methods/dopri5.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr int kSamples = 4;  // instants compared, at even times up to the end; numbers of steps are multiples of it
constexpr double kNoise = 1e-12;     // relative errors that show no order
constexpr double kTightest = 1e-14;  // rtol: of the stages' iteration and of the projection

// An error shows its order between steps so long that the next term of the error disturbs the slope and steps so
// short that rounding does: the fit takes those from `first` to `last`, counted over the whole motion.
struct Method {
  const char* name;
  std::vector<int> steps;
  int first, last;
};
struct ControlledCase {
  const char* model;
  const char* title;
  double end;
  Vector3 spin;  // of every body, rad/s
  std::vector<Method> methods;
};
const std::vector<ControlledCase>& mechanisms() {
  static const std::vector<ControlledCase> all{
      {"single_pendulum_free",
       "free pendulum, set off",
       2,
       {0, 0, 3},
       {{"dopri5", {20, 28, 40, 60, 80, 100, 120, 144, 172, 208, 248}, 80, 172},
        {"radau5", {40, 48, 56, 68, 80, 100, 120, 144, 172}, 40, 80}}},
      {"heavy_top",
       "heavy top, slow",
       1,
       {2.6, -4.2, 1.4},
       {{"radau5", {52, 68, 88, 112, 132, 160, 188, 244}, 68, 160}}},
      {"knife_edge",
       "knife edge",
       8,
       {0, 2, 0},
       {{"radau5", {68, 88, 112, 144, 188, 244, 316, 400}, 112, 316},
        {"dop853", {32, 40, 48, 52, 60, 68, 80, 92, 108, 128}, 60, 108}}}};
  return all;
}

Motion march(const Scene& scene, const Method& method, std::string_view formulation, double end, int steps,
             Status& status) {
  Settings settings;
  settings.formulation = formulation;
  settings.rtol = kTightest;
  settings.atol = kTightest;
  settings.linear_solver = "dense";  // fresh pivots: orders are measured down to 1e-13
  Motion motion;
  MotionRecorder recorder(motion);
  const auto run = [&]<class Stepper>(EqualSteps<Stepper> equal) {
    status = equal.march(end, steps, steps / kSamples, [&](const Sample& sample) { recorder.add(sample); });
  };
  if (std::string_view(method.name) == "radau5") {
    run(EqualSteps<RadauStepper>(scene, settings, [&](auto& problem, auto& systems, auto& statistics, auto& clock) {
      return std::make_unique<RadauStepper>(problem, systems, settings.rtol, settings.absolute_tolerance(), statistics,
                                            clock);
    }));
  } else {
    const RungeKuttaPair& pair = std::string_view(method.name) == "dop853" ? dop853_pair() : dopri5_pair();
    run(EqualSteps<ExplicitStepper>(scene, settings, [&](auto& problem, auto& systems, auto& statistics, auto& clock) {
      return std::make_unique<ExplicitStepper>(pair, problem, systems, settings.rtol, settings.absolute_tolerance(),
                                               statistics, clock);
    }));
  }
  return motion;
}

// Whose curves have the line of their order below them.
bool last_of_order(const ControlledCase& mechanism, const Method& method) {
  const int order = integrators().require(method.name).order;
  const auto last = std::find_if(mechanism.methods.rbegin(), mechanism.methods.rend(),
                                 [&](const Method& m) { return integrators().require(m.name).order == order; });
  return &*last == &method;
}

}  // namespace

FigureResult order_controlled(const FigureRequest& request) {
  FigureResult result;
  PanelPlot plot{"order_controlled", "Errors over the step size: one-step methods with error control, equal steps",
                 "step size h, s", "relative error"};
  plot.columns = static_cast<int>(kQuantities.size());
  Table table{
      "order_controlled_table", "Orders of the one-step methods with error control",
      fmt::format("Error control off, steps of equal length. Exponents of h, fitted to at least five steps from "
                  "h to h as given; neighbours: the least and the largest between neighbouring steps there, "
                  "over all quantities. Errors are the largest over {} instants at even times, bodies and "
                  "components, relative to the largest value of their kind. The reference is dop853 at rtol "
                  "{:g}. IDA has no order of its own: it chooses formulas of order 1 to 5.",
                  kSamples, kTightest),
      kOrderColumns};
  std::map<std::string_view, Range> exponents;
  for (const ControlledCase& mechanism : mechanisms()) {
    Scene scene = request.scene(mechanism.model);
    for (Body& body : scene.bodies) body.angular_velocity = mechanism.spin;
    const Model model = compile(scene);
    Settings settings;
    settings.integrator = "dop853";
    settings.rtol = kTightest;
    settings.atol = kTightest;
    settings.linear_solver = "dense";  // fresh pivots: orders are measured down to 1e-13
    settings.end = mechanism.end;
    settings.every = mechanism.end / kSamples;
    std::optional<Motion> exact = motion_of(scene, settings, result);
    if (!exact) continue;
    exact->t.erase(exact->t.begin());  // the start
    exact->bodies.erase(exact->bodies.begin());
    exact->lambda.erase(exact->lambda.begin());
    const Sizes size = sizes(*exact, model);
    for (const Method& method : mechanism.methods) {
      const Window window{mechanism.end / method.last, mechanism.end / method.first};
      const int order = integrators().require(method.name).order;
      for (const FormulationEntry& formulation : formulations()) {
        std::array<Curve, kQuantities.size()> curves;
        for (std::size_t k = 0; k < curves.size(); ++k)
          curves[k] = {fmt::format("{}: {}", mechanism.title, kQuantities[k]), method.name,
                       std::string(formulation.name)};
        for (const int steps : method.steps) {
          Status status;
          const Motion found = march(scene, method, formulation.name, mechanism.end, steps, status);
          if (!status.ok()) continue;  // a step of that length cannot be taken
          const PerQuantity errors = difference(found, *exact, size, model);
          for (std::size_t k = 0; k < errors.size(); ++k)
            curves[k].points.push_back({mechanism.end / steps, errors[k]});
        }
        table.rows.push_back(fit_row(mechanism.title, order, curves, window, kNoise, "-", exponents[method.name]));
        for (Curve& curve : curves) {
          if (formulation.name == formulations().back().name && last_of_order(mechanism, method))
            plot.curves.push_back(guide(curve, order));
          plot.curves.push_back(std::move(curve));
        }
      }
    }
  }
  for (const auto& [name, range] : exponents)
    if (!range.empty())
      result.summary.push_back(
          fmt::format("{} (order {}): exponents {}", name, integrators().require(name).order, range.text(3)));
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace poinsot::paper
