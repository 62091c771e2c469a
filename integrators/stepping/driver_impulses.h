// Drivers and constraints whose rate jumps, as of 2*max(0, t - 0.5): velocities jump with it, by an impulse that no
// reaction, effort or power shows, which are those of the motion before and after. Told once, with the energy it
// brings.
#pragma once

#include "integrators/integrator.h"

namespace poinsot {

class DriverImpulses {
 public:
  explicit DriverImpulses(const Run& run) : run_(run) {}

  // Before a switch of a function of time is crossed, from `at` to a time beyond; the problem stands at `at` then where
  // a rate jumps there.
  void expect(const State& at, double beyond);
  // The problem stands beyond it.
  void look(const State& beyond);

 private:
  double kinetic(const State& at) const;

  const Run& run_;
  bool told_ = false;
  int row_ = -1;  // whose rate jumps
  double jump_ = 0;
  double kinetic_ = 0;  // J, before
};

}  // namespace poinsot
