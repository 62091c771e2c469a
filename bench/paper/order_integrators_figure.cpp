// Errors over the step size of every integrator of fixed step, in positions, velocities, accelerations and multipliers,
// on the paper's mechanisms, in every formulation, and the exponents fitted to them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "bench/paper/order_fit.h"
#include "bench/study/progress.h"
#include "formulations/registry.h"
#include "integrators/integrator.h"

namespace poinsot::paper {
using namespace study;
namespace {

struct DrivenOrFree {
  const char* model;
  const char* title;
  bool driven;
  double end;  // s; free motion is compared while neighbouring motions stay neighbours
};
constexpr DrivenOrFree kCompared[] = {{"single_pendulum", "single pendulum", true, 3},
                                      {"slider_crank", "slider crank", true, 3},
                                      {"four_link", "four link", true, 3},
                                      {"double_pendulum", "double pendulum, set off", false, 1}};
// The double pendulum is set off with this, projected onto its constraints: from rest the velocity errors of
// half-implicit Euler cancel to second order.
constexpr double kSpin = 1;  // rad/s about the body's z axis, the hinges'

constexpr double kBetweenInstants = 0.1;   // s between the instants compared; a multiple of every step
constexpr double kNewtonPosition = 1e-12;  // m: Θ h² of Newton's method; below it the accelerations are rounding

// First order shows at small steps, second order before Φ/h² magnifies rounding into the accelerations.
Window window_of(int order, bool quick) {
  return order > 1 || quick ? Window{1e-3, 5e-3} : Window{1e-4, 1e-3};
}

std::vector<double> steps_of(bool quick) {
  if (quick) return {5e-3, 4e-3, 2.5e-3, 2e-3, 1e-3};
  return {2e-2, 1e-2, 5e-3, 4e-3, 2.5e-3, 2e-3, 1e-3, 5e-4, 4e-4, 2e-4, 1e-4};
}

Settings settings_for(const IntegratorEntry& method, std::string_view formulation, double step, double end) {
  Settings settings;
  settings.integrator = method.name;
  settings.formulation = formulation;
  settings.step = step;
  settings.end = end;
  settings.every = kBetweenInstants;
  settings.stopping = "correction";
  settings.tolerance = kNewtonPosition / (step * step);
  settings.max_iterations = 50;
  return settings;
}

Scene scene_of(const DrivenOrFree& mechanism, const FigureRequest& request) {
  Scene scene = request.scene(mechanism.model);
  if (!mechanism.driven)
    for (Body& body : scene.bodies) body.angular_velocity = {0, 0, kSpin};
  return scene;
}

Table empty_table() {
  return {
      "order_integrators_table", "Orders of the integrators of fixed step",
      fmt::format(
          "Exponents of h, fitted to at least five steps from h to h as given; neighbours: the least and the largest "
          "between neighbouring steps there, over all quantities. Errors are the largest over instants every {:g} s, "
          "bodies and components, relative to the largest value of their kind. exact: errors below {:g} at every "
          "step, which shows no order: drivers prescribe the positions, RATTLE and the stabilized index 2 keep the "
          "velocities on the constraints, too, and RATTLE's accelerations and multipliers follow from both. The "
          "reference of driven mechanisms is their kinematics solved to 1e-12, with the multipliers of inverse "
          "dynamics; of free motion dop853 at rtol 1e-13. Newton's tolerance Θ with Θ h² = {:g}.",
          kBetweenInstants, kRounding, kNewtonPosition),
      kOrderColumns};
}

const Point* largest_fitted(const Curve& curve) {
  const auto at = std::find_if(curve.points.begin(), curve.points.end(), [](const Point& p) { return p.in_fit; });
  return at == curve.points.end() ? nullptr : &*at;
}

// Below the lowest curve of each order in a panel.
void add_guides(const std::map<int, std::vector<Curve>>& by_order, PanelPlot& plot) {
  for (const auto& [order, curves] : by_order) {
    std::map<std::string, const Curve*> lowest;
    for (const Curve& curve : curves) {
      const Curve*& low = lowest[curve.panel];
      if (!low || largest_fitted(curve)->y < largest_fitted(*low)->y) low = &curve;
    }
    for (const auto& [panel, curve] : lowest) plot.curves.push_back(guide(*curve, order));
  }
}

}  // namespace

FigureResult order_integrators(const FigureRequest& request) {
  const std::vector<double> steps = steps_of(request.quick);
  std::vector<const IntegratorEntry*> methods;
  for (const IntegratorEntry& entry : integrators())
    if (entry.analysis == Analysis::dynamics && !entry.controls_error) methods.push_back(&entry);

  FigureResult result;
  PanelPlot plot{"order_integrators", "Errors over the step size: integrators of fixed step", "step size h, s",
                 "relative error"};
  plot.columns = static_cast<int>(kQuantities.size());
  Table table = empty_table();
  std::map<int, std::vector<Curve>> fitted;  // by order
  RunCounter counter(std::size(kCompared) * methods.size() * formulations().size() * steps.size(), request.progress);
  std::map<const IntegratorEntry*, Range> exponents;
  for (const DrivenOrFree& mechanism : kCompared) {
    const Scene scene = scene_of(mechanism, request);
    const Model model = compile(scene);
    const double end = request.quick ? 1 : mechanism.end;
    const std::optional<Motion> exact = exact_motion(scene, mechanism.driven, end, kBetweenInstants, result);
    if (!exact) continue;
    const Sizes size = sizes(*exact, model);
    for (const IntegratorEntry* method : methods) {
      for (const FormulationEntry& formulation : formulations()) {
        std::array<Curve, kQuantities.size()> curves;
        for (std::size_t k = 0; k < curves.size(); ++k)
          curves[k] = {fmt::format("{}: {}", mechanism.title, kQuantities[k]), std::string(method->name),
                       std::string(formulation.name)};
        for (const double step : steps) {
          counter.next();
          const auto found = motion_of(scene, settings_for(*method, formulation.name, step, end), result);
          if (!found) continue;
          const PerQuantity errors = difference(*found, *exact, size, model);
          for (std::size_t k = 0; k < errors.size(); ++k) curves[k].points.push_back({step, errors[k]});
        }
        table.rows.push_back(fit_row(mechanism.title, method->order, curves, window_of(method->order, request.quick),
                                     kRounding, "exact", exponents[method]));
        for (const Curve& curve : curves) {
          if (largest_fitted(curve)) fitted[method->order].push_back(curve);
          plot.curves.push_back(curve);
        }
      }
    }
  }
  for (const IntegratorEntry* method : methods)
    if (!exponents[method].empty())
      result.summary.push_back(
          fmt::format("{} (order {}): exponents {}", method->name, method->order, exponents[method].text(3)));
  add_guides(fitted, plot);
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace poinsot::paper
