// Forces of every kind, dissipative ones and such as depend on time, on a spatial double pendulum.
#pragma once

#include "core/scene_reader.h"

namespace poinsot::test {

inline Scene forced() {
  return parse_scene(R"json({
    "scene": 1, "name": "forced", "gravity": [0, 0, -9.81],
    "bodies": [
      {"name": "upper", "mass": 2, "inertia": [0.1, 0.2, 0.25], "position": [0, 0.5, 0], "angular_velocity": [1, 0.5, -1]},
      {"name": "lower", "mass": 1, "inertia": [0.05, 0.02, 0.06], "position": [0.4, 1, 0], "angular_velocity": [0, 1, 2],
       "orientation": {"axis": [1, 0, 0], "angle": 0.4}}],
    "joints": [
      {"type": "spherical", "bodies": ["ground", "upper"], "point": [0, 0, 0]},
      {"type": "revolute", "bodies": ["upper", "lower"], "point": [0, 1, 0], "axis": [0, 1, 1]}],
    "forces": [
      {"type": "force", "body": "lower", "point": [0.1, 0, 0.2], "force": ["2*sin(3*t)", 0, "cos(2*t)"], "frame": "body"},
      {"type": "torque", "body": "upper", "torque": [0, 0, "0.5*cos(t)"]},
      {"type": "spring", "bodies": ["ground", "lower"], "s_i": [1, 1, 1], "s_j": [0, 0, 0.1], "stiffness": 40, "damping": 3, "length": 0.5},
      {"type": "torsion_spring", "bodies": ["upper", "lower"], "axis": [0, 1, 1], "stiffness": 5, "damping": 0.3, "angle": 0.1},
      {"type": "linear_drag", "body": "upper", "translational": 0.4, "rotational": 0.2}]})json",
                     "forced");
}

}  // namespace poinsot::test
