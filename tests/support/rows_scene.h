// Constraint rows of every kind on bodies that move freely: a linkage with redundant rows, a cart driven in time that
// carries a pendulum, and a blade with a velocity row, with springs between them.
#pragma once

#include "core/scene_reader.h"

namespace poinsot::test {

inline Scene rows_of_every_kind() {
  return parse_scene(R"json({
    "scene": 1, "name": "rows", "gravity": [0, -9.81, 0],
    "bodies": [
      {"name": "left", "mass": 1, "inertia": [0.01, 0.01, 0.09], "position": [0, 0.5, 0], "velocity": [0.5, 0, 0], "angular_velocity": [0, 0, -1]},
      {"name": "coupler", "mass": 1, "inertia": [0.01, 0.02, 0.09], "position": [0.5, 1, 0], "velocity": [1, 0, 0]},
      {"name": "right", "mass": 1.5, "inertia": [0.01, 0.01, 0.09], "position": [1, 0.5, 0], "velocity": [0.5, 0, 0], "angular_velocity": [0, 0, -1]},
      {"name": "cart", "mass": 2, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, 1], "velocity": [1, 0, 0]},
      {"name": "bob", "mass": 1, "inertia": [0.02, 0.03, 0.01], "position": [0, -0.4, 1.3], "velocity": [1, 0, 0], "angular_velocity": [1, 2, 0.5]},
      {"name": "blade", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0, 0, -1], "velocity": [0.5, 0, 0], "angular_velocity": [0, 0, 2]}],
    "joints": [
      {"type": "revolute", "bodies": ["ground", "left"], "point": [0, 0, 0], "axis": [0, 0, 1]},
      {"type": "revolute", "bodies": ["left", "coupler"], "point": [0, 1, 0], "axis": [0, 0, 1]},
      {"type": "revolute", "bodies": ["coupler", "right"], "point": [1, 1, 0], "axis": [0, 0, 1]},
      {"type": "revolute", "bodies": ["ground", "right"], "point": [1, 0, 0], "axis": [0, 0, 1]},
      {"type": "translational", "bodies": ["ground", "cart"], "point": [0, 0, 1], "axis": [1, 0, 0]},
      {"type": "spherical", "bodies": ["cart", "bob"], "point": [0, 0, 1]}],
    "drivers": [
      {"type": "distance", "bodies": ["ground", "cart"], "s_i": [-2, 0, 1], "s_j": [0, 0, 0], "length": "2 + 0.2*sin(5*t)"}],
    "constraints": [
      {"type": "pfaffian", "bodies": ["ground", "blade"], "a_j": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [0.2, 0, 0]},
      {"type": "CD", "bodies": ["ground", "blade"], "c": [0, 0, 1], "s_i": [0, 0, -1], "s_j": [0, 0, 0]},
      {"type": "DP1", "bodies": ["ground", "blade"], "a_i": [0, 0, 1], "a_j": [1, 0, 0]},
      {"type": "DP1", "bodies": ["ground", "blade"], "a_i": [0, 0, 1], "a_j": [0, 1, 0]}],
    "forces": [
      {"type": "spring", "bodies": ["bob", "coupler"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "stiffness": 20, "damping": 2, "length": 1},
      {"type": "spring", "bodies": ["coupler", "blade"], "s_i": [0, 0, 0], "s_j": [0, 0.1, 0], "stiffness": 10, "damping": 0.4, "length": 0.5}]})json",
                     "rows");
}

}  // namespace poinsot::test
