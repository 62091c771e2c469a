// What it took to put a given state onto the constraints, told; and refused where it took far more than it was off.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/start/violation.h"

namespace poinsot {

double size_of(std::span<const BodyState> states);  // m, of the largest coordinate; 1 at least

struct WhatMoved {
  std::shared_ptr<const Model> model;
  std::span<const BodyState> from, to;
  Violation before;  // of `from`

  // One sentence each. Throw InputError where constraints that all but depend on one another are satisfied by a change
  // that nobody can have meant.
  std::string told_of_pose() const;
  std::string told_of_velocities() const;
};

}  // namespace poinsot
