// What the constraint rows of a model look like: joints by their symbols, distances as lines.
//
// Joints of the scene are taken from their rows, whatever they were given by. Bare constraints that make a joint of the
// paper's Table 1 together are drawn as that joint: three CD at one point, and what DP1 between the same two bodies add
// to them (one: universal, two: revolute, three: fixed), or two DP2 and two or three DP1 (cylindrical, translational).
#pragma once

#include <string>
#include <vector>

#include "core/model.h"

namespace poinsot::view {

struct JointSymbol {
  std::string type;  // as the scene writes joints
  std::string name;
  int i = kGround, j = kGround;
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();        // m
  Vector3 axis_i = Vector3::Zero(), axis_j = Vector3::Zero();  // the axis in either body's frame; universal: its two
};

// A line between two points: a constraint or driver of distance, or a spring.
struct LineSymbol {
  std::string type;  // "D", "distance", "spring"
  std::string name;
  int i = kGround, j = kGround;
  Vector3 s_i = Vector3::Zero(), s_j = Vector3::Zero();  // m
};

// What turns about an axis: an angle driver or a torsion spring.
struct TurnSymbol {
  std::string type;  // "angle", "torsion_spring"
  std::string name;
  int i = kGround, j = kGround;
  Vector3 axis_i = Vector3::Zero();
};

struct Symbols {
  std::vector<JointSymbol> joints;
  std::vector<LineSymbol> lines;
  std::vector<TurnSymbol> turns;
};

Symbols symbols(const Model& model);

// Points of the bodies where constraints and forces attach, by body, each once. The end of a D constraint is left out
// where it is farther from its body than everything else is large: an auxiliary point far off is no part of the body.
std::vector<std::vector<Vector3>> attachment_points(const Model& model);

}  // namespace poinsot::view
