// What the order figures share: motions and their references, the steps an exponent is fitted to, and the fit.
//
// Reference of a mechanism without degrees of freedom: its kinematics, solved to 1e-12 at every instant, with the
// multipliers of inverse dynamics; it does not depend on a step. Of free motion: dop853 at rtol 1e-13.
#pragma once

#include <optional>

#include "bench/paper/figure.h"
#include "bench/study/fit.h"
#include "bench/study/motion.h"

namespace poinsot::paper {

// Nothing, and a sentence among the failures, where the run fails.
std::optional<study::Motion> motion_of(const Scene& scene, const Settings& settings, FigureResult& result);
std::optional<study::Motion> exact_motion(const Scene& scene, bool driven, double end, double every,
                                          FigureResult& result);

// Steps, s.
struct Window {
  double from, to;
  bool holds(double step) const { return from * (1 - 1e-9) <= step && step <= to * (1 + 1e-9); }
};

// Errors that are rounding alone show no order.
inline constexpr double kRounding = 1e-10;

// Marks the points in the window and fits them. Nothing where errors are rounding or fewer than five points are there.
std::optional<study::Power> fit_order(study::Curve& curve, const Window& window, double rounding = kRounding);

// A row of a table of kOrderColumns: fits the curves of one method, quantity by quantity. `exact` stands where errors
// are rounding.
std::vector<std::string> fit_row(const char* mechanism, int order, std::span<study::Curve> curves, const Window& window,
                                 double rounding, const char* exact, study::Range& exponents);
inline const std::vector<std::string> kOrderColumns{"mechanism",  "integrator", "formulation",   "order",
                                                    "positions",  "velocities", "accelerations", "multipliers",
                                                    "neighbours", "from h, s",  "to h, s"};

// A line of slope `order` below the fitted points.
study::Curve guide(const study::Curve& curve, int order);

}  // namespace poinsot::paper
