// What a step makes of an oscillator, measured on the code: a body on a spring, or turning against a torsion spring,
// free or on a joint along a skew axis, its unit states taken a step further.
//
// With the natural frequency w, y = (x, ẋ/w) after a step of the unit states is the amplification matrix; its spectral
// radius, over h w, says what is damped (below 1) and what grows. A method that carries more from step to step than
// positions and velocities (generalized-α) is known by that y₂ is not the matrix applied to y₁; its sequences obey a
// recurrence of order three, whose roots are the eigenvalues. Methods with error control are driven with equal steps;
// those without steps of their own (ida, auto) have none.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/study/panels.h"

namespace poinsot::stability {

struct Oscillator {
  bool rotation = false, constrained = false;
  double damping = 0;  // relative to the critical one

  std::string name() const;
};

// The spectral radius of a step with h w; nothing where the method has no steps of its own, or a step fails.
std::optional<double> spectral_radius(const Oscillator& oscillator, std::string_view integrator,
                                      std::string_view formulation, double hw);

// The known ones, of x'' + 2 ζ w x' + w² x = 0 without constraints.
double generalized_alpha_radius(double hw, double zeta, double at_infinity);
double radau5_radius(double hw, double zeta);
double implicit_euler_radius(double hw, double zeta);
double verlet_radius(double hw);  // undamped: RATTLE and half-implicit Euler

// Over h w, for every oscillator, integrator and formulation, with the known curves as guides. Radii above 1.5 are left
// out.
study::PanelPlot amplification_plot(bool quick);

}  // namespace poinsot::stability
