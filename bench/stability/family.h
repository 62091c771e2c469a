// An edge: a family of scenes over two parameters, whose motion is known in closed form or by few coordinates.
//
// A family is data and a small function, one entry of the table families(). Its scene is a scene file with parameters;
// each of its two axes is one of these, or something of the settings:
//
//   parameter   a number of the scene, by its name
//   variant     which of the family's scenes
//   accuracy    of fixed steps how many there are to the end, of error control rtol
//   step        of fixed steps the step; the run is so many times as long (also of error control)
//   length      how many times `end` the run is long, by steps as long
//
// Where neither is accuracy or step, all runs make `steps` steps, or take `rtol`. A result is right where columns of
// the run at times 1/4, 1/2, 3/4 and 1 of it are near the truth (verdict.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot::stability {

struct Axis {
  enum Along { parameter, variant, accuracy, step, length } along = parameter;
  std::string_view label;               // with its unit
  std::string_view name;                // of the parameter
  std::vector<double> values = {};      // of accuracy: numbers of steps
  std::vector<double> quick = {};       // some of them
  double benign = 0;                    // far from the edge: one of the values that `quick` has, too
  std::vector<double> tolerances = {};  // of accuracy, and
  std::vector<double> quick_tolerances = {};

  bool of_settings() const { return along != parameter && along != variant; }
  const std::vector<double>& of(bool is_quick, bool controls_error = false) const {
    if (along == accuracy && controls_error) return is_quick ? quick_tolerances : tolerances;
    return is_quick ? quick : values;
  }
};

// A place of the map. `nudge`: by how much, relatively, the initial velocity (of a motion from rest the load) is
// another.
struct Place {
  double x = 0, y = 0;  // along accuracy: 0
  double end = 0;       // s, of the run
  double nudge = 0;
};

// The axis of accuracy that most families have: 40 to 2560 steps, rtol 1e-4 to 1e-10.
Axis accuracy(std::vector<double> steps = {40, 160, 640, 2560}, std::vector<double> quick = {40, 640},
              std::vector<double> tolerances = {1e-4, 1e-6, 1e-8, 1e-10},
              std::vector<double> quick_tolerances = {1e-4, 1e-8});

struct Family {
  std::string_view name, title;
  std::string_view about;  // what the edge is, and the truth
  std::vector<std::string> scenes;
  Axis x, y = accuracy();
  double end = 1;      // s
  double steps = 400;  // to the end; of an axis `step`: of every run
  double rtol = 1e-8;
  std::vector<std::string_view> columns;  // whose numbers are compared
  // What the columns should be at t. Several motions where the data do not decide between them (a constraint violated
  // by less than is told apart): the nearest counts.
  std::vector<std::vector<double>> (*truth)(const Place& at, double t) = nullptr;
  // Of the motion: its size, which errors are relative to; its rate, 1/s, by which a step is short or long; how far its
  // positions are from the origin, in its sizes; and of its error what the data leave open.
  double (*size)(const Place& at) = [](const Place&) { return 1.0; };
  double (*rate)(const Place& at) = [](const Place&) { return 1.0; };
  double (*reach)(const Place& at) = [](const Place&) { return 1.0; };
  double (*floor)(const Place& at) = [](const Place&) { return 0.0; };
  std::string_view warning = {};  // of a notice that speaks of this edge, wherever it is
};

std::span<const Family> families();
// Throws InputError where there is none of the name, and says which there are.
const Family& require_family(std::string_view name);
// These, or all where none is named.
std::vector<const Family*> require_families(const std::vector<std::string>& names);

}  // namespace poinsot::stability
