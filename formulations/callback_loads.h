// The loads of a CallbackForce (core/scene.h) and how they vary, at one state: the room for them, and the calls.
#pragma once

#include <span>
#include <vector>

#include "core/scene.h"

namespace poinsot {

struct CallbackLoads {
  explicit CallbackLoads(const CallbackForce& of);  // of a model that stays

  // Of the states put in before; nothing is allocated.
  void evaluate(double t);
  void differentiate(double t);  // as the force says, or by forward differences
  void difference(double t);

  const CallbackForce* force;
  std::vector<BodyState> states;
  std::vector<Load> loads;
  LoadSensitivity by;

 private:
  std::vector<Load> beside_;
};

// The largest difference between what a force says its sensitivity is and differences, relative to the largest entry of
// either.
double sensitivity_error(const CallbackForce& force, std::span<const BodyState> states);

}  // namespace poinsot
