#include "bench/paper/order_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace poinsot::paper {
using namespace study;
namespace {

constexpr std::size_t kFewest = 5;  // points that show an order

bool is_exact(const Curve& curve, const Window& window, double rounding) {
  return std::ranges::all_of(curve.points, [&](const Point& p) { return !window.holds(p.x) || p.y < rounding; });
}

}  // namespace

std::optional<Motion> motion_of(const Scene& scene, const Settings& settings, FigureResult& result) {
  MotionRun run = run_motion(scene, settings);
  if (run.outcome.status.ok()) return std::move(run.motion);
  result.failures.push_back(fmt::format("{}, {}, {}, h = {:g} s: {}", scene.name, settings.integrator,
                                        settings.formulation, settings.step, run.outcome.status.message));
  return std::nullopt;
}

std::optional<Motion> exact_motion(const Scene& scene, bool driven, double end, double every, FigureResult& result) {
  Settings settings;
  settings.end = end;
  settings.every = every;
  if (driven) {
    settings.analysis = Analysis::kinematics;
    settings.tolerance = 1e-12;
    settings.reactions = true;
  } else {
    settings.integrator = "dop853";
    settings.rtol = 1e-13;
    settings.atol = 1e-14;
  }
  return motion_of(scene, settings, result);
}

std::optional<Power> fit_order(Curve& curve, const Window& window, double rounding) {
  std::vector<double> x, y;
  for (const Point& point : curve.points) {
    if (!window.holds(point.x)) continue;
    x.push_back(point.x);
    y.push_back(point.y);
  }
  if (x.size() < kFewest || is_exact(curve, window, rounding)) return std::nullopt;
  for (Point& point : curve.points) point.in_fit = window.holds(point.x);
  return fit_power(x, y);
}

std::vector<std::string> fit_row(const char* mechanism, int order, std::span<Curve> curves, const Window& window,
                                 double rounding, const char* exact, Range& exponents) {
  std::vector<std::string> row{mechanism, curves[0].series, curves[0].variant, std::to_string(order)};
  Range neighbours;
  for (Curve& curve : curves) {
    const std::optional<Power> power = fit_order(curve, window, rounding);
    row.push_back(power ? fmt::format("{:.3f}", power->exponent) : is_exact(curve, window, rounding) ? exact : "-");
    if (!power) continue;
    exponents.add(power->exponent);
    neighbours.add(power->neighbours.low);
    neighbours.add(power->neighbours.high);
  }
  row.push_back(neighbours.empty() ? "-" : neighbours.text(3));
  row.push_back(fmt::format("{:.3g}", window.from));
  row.push_back(fmt::format("{:.3g}", window.to));
  return row;
}

Curve guide(const Curve& curve, int order) {
  constexpr double kBelow = 0.4;
  Curve line{curve.panel, fmt::format("order {}", order), kGuide};
  for (const Point& point : curve.points) {
    if (!point.in_fit) continue;
    const double y = line.points.empty() ? kBelow * point.y
                                         : line.points.front().y * std::pow(point.x / line.points.front().x, order);
    line.points.push_back({point.x, y});
  }
  return line;
}

}  // namespace poinsot::paper
