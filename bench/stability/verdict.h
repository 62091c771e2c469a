// What a result is worth that came out of a run, by what was promised.
//
// E is the largest error of the family's columns at four times, relative to the size L of the motion; S the motion's
// own sensitivity: by what factor a small relative change of its initial velocity comes out changed, the largest on the
// way (what a motion lost where it was sensitive it does not get back where it is not). Promised is
//
//   error control   √n N S (rtol l + atol/L): each of N steps is held to rtol and atol in a norm over n numbers of the
//                   state, and what it leaves is carried on by the motion; positions are l L from the origin; S >= 1
//   fixed steps     10 (C S r T (h r)^p + 1e-9 S): each of the steps of a run of length T leaves so much of order p +
//   1,
//                   r being the rate of the motion, and C the largest so measured at the family's benign cells with
//                   1e-7 < E < 0.1 (where there is none: at the finest); 1e-9 is what Newton's test leaves
//                   (integrators/README.md)
//
// each with 10 S (ε l + what the family's data leave open) beside. That is the linear part of an error: above 0.1 it
// says no more than that two motions of one size are no further apart than twice that, E <= 2. Then a result is
//
//   accurate   E <= promised, and E <= 0.01
//   coarse     E <= promised, more than 0.01: the order promises no better with this step
//   told       E > promised, and the run said something that the benign one did not
//   wrong      E > promised, and not a word
//   stop       no result: a status, or refused at the start
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poinsot::stability {

struct Family;

enum class Verdict { accurate, coarse, told, stop, wrong };
inline constexpr int kVerdicts = 5;
std::string_view name(Verdict verdict);

struct Cell {
  std::string formulation, integrator;
  double x = 0, y = 0;  // y, or x, of accuracy: the step in s, or rtol
  std::size_t x_place = 0, y_place = 0;
  double step = 0, rtol = 0, end = 0;  // as the run was asked for them; the method goes by one of the first two
  std::size_t bodies = 0;
  std::string status, message;     // of a run that ended well: its notices
  double steps = 0;                // it made
  std::vector<double> values;      // of each column, by time
  double error = 0, promised = 0;  // not a number where there is none
  Verdict verdict = Verdict::stop;

  bool ended() const { return status == "ok"; }
  std::string method() const { return integrator + " in " + formulation; }
};

// Finds error, promise and verdict of each cell of a family.
void judge(const Family& family, std::vector<Cell>& cells);

}  // namespace poinsot::stability
