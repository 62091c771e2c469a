#include "bench/paper/order_fit.h"

#include <fmt/format.h>

#include <cmath>

#include "integrators/simulate.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr std::size_t kFewest = 5;  // points that show an order

std::vector<Point> points_in(const Curve& curve, const Window& window) {
  std::vector<Point> points;
  for (const Point& point : curve.points)
    if (window.holds(point.x)) points.push_back(point);
  return points;
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

bool is_exact(const Curve& curve, const Window& window, double rounding) {
  for (const Point& point : points_in(curve, window))
    if (!(point.y < rounding)) return false;
  return true;
}

std::optional<Power> fit_order(Curve& curve, const Window& window, double rounding) {
  std::vector<double> x, y;
  for (const Point& point : points_in(curve, window)) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  if (x.size() < kFewest || is_exact(curve, window, rounding)) return std::nullopt;
  for (Point& point : curve.points) point.in_fit = window.holds(point.x);
  return fit_power(x, y);
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
