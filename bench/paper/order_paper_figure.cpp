// The paper's order analysis: implicit Euler after 3 s, one coordinate of each mechanism, against its kinematics.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "bench/paper/order_fit.h"
#include "bench/study/progress.h"
#include "formulations/registry.h"

namespace poinsot::paper {
using namespace study;
namespace {

// The coordinates of the paper's figures.
struct Coordinate {
  const char* model;
  const char* title;
  std::size_t body;
  int axis;
};
constexpr Coordinate kCoordinates[] = {{"single_pendulum", "single pendulum, z", 0, 2},
                                       {"slider_crank", "slider crank, x of the slider", 2, 0},
                                       {"four_link", "four link, z of link 3", 2, 2}};

constexpr double kPaperEnd = 3;           // s
constexpr double kPaperPosition = 1e-11;  // m: the paper's Θ h²

}  // namespace

FigureResult order_paper(const FigureRequest& request) {
  std::vector<double> steps{1e-2, 8e-3, 4e-3, 2e-3, 1e-3};
  if (!request.quick) steps = {4e-2, 2e-2, 1e-2, 8e-3, 4e-3, 2e-3, 1e-3, 8e-4, 4e-4, 2e-4, 1e-4};  // the original's
  const Window window{steps.back(), 1e-2};

  FigureResult result;
  PanelPlot plot{"order_paper", fmt::format("Order of implicit Euler: one coordinate at t = {:g} s", kPaperEnd),
                 "step size h, s", "|difference| from kinematics"};
  Table table{
      "order_paper_table",
      "Order of implicit Euler, the paper's coordinates",
      fmt::format("|difference| from the kinematics at t = {:g} s; tolerance Θ with Θ h² = {:g}. Exponents of h "
                  "fitted from h to h as given, and the least and largest between neighbouring steps. Positions "
                  "are prescribed: the last column, their largest difference, is rounding.",
                  kPaperEnd, kPaperPosition),
      {"coordinate", "formulation", "quantity", "exponent", "least", "largest", "from h, s", "to h, s", "position, m"}};
  RunCounter counter(std::size(kCoordinates) * formulations().size() * steps.size(), request.progress);
  Range exponents;
  for (const Coordinate& coordinate : kCoordinates) {
    const Scene scene = request.scene(coordinate.model);
    const std::optional<Motion> exact = exact_motion(scene, true, kPaperEnd, kPaperEnd, result);
    if (!exact) continue;
    const BodyState& truth = exact->bodies.back()[coordinate.body];
    for (const FormulationEntry& formulation : formulations()) {
      const std::string name(formulation.name);
      std::array curves{Curve{fmt::format("{}: velocity, m/s", coordinate.title), name, name},
                        Curve{fmt::format("{}: acceleration, m/s²", coordinate.title), name, name}};
      double position = 0;
      for (const double step : steps) {
        counter.next();
        Settings settings;
        settings.formulation = name;
        settings.integrator = "implicit_euler";
        settings.retry = false;
        settings.stopping = "correction";
        settings.step = step;
        settings.end = settings.every = kPaperEnd;
        settings.tolerance = kPaperPosition / (step * step);
        const std::optional<Motion> found = motion_of(scene, settings, result);
        if (!found) continue;
        const BodyState& state = found->bodies.back()[coordinate.body];
        const auto apart = [&](auto member) {
          return std::abs((state.*member)[coordinate.axis] - (truth.*member)[coordinate.axis]);
        };
        curves[0].points.push_back({step, apart(&BodyState::rd)});
        curves[1].points.push_back({step, apart(&BodyState::rdd)});
        position = std::max(position, apart(&BodyState::r));
      }
      for (std::size_t k = 0; k < curves.size(); ++k) {
        const std::optional<Power> power = fit_order(curves[k], window);
        if (power) {
          exponents.add(power->exponent);
          table.rows.push_back({coordinate.title, name, k == 0 ? "velocity" : "acceleration",
                                fmt::format("{:.3f}", power->exponent), fmt::format("{:.3f}", power->neighbours.low),
                                fmt::format("{:.3f}", power->neighbours.high), fmt::format("{:g}", window.from),
                                fmt::format("{:g}", window.to), fmt::format("{:.1e}", position)});
        }
        if (power && &formulation == &formulations().front()) plot.curves.push_back(guide(curves[k], 1));
        plot.curves.push_back(curves[k]);
      }
    }
  }
  if (!exponents.empty())
    result.summary.push_back(fmt::format("implicit_euler (order 1): exponents {}", exponents.text(3)));
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace poinsot::paper
