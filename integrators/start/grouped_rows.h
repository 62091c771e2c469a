// Rows by their joint or constraint, of which as few as possible give rows to be set aside (linsolve/separation.h).
//
// A loop is opened where rows are set aside, and how long its matrices take depends on where. Of joints that could give
// as many rows those come first that meet most others at their bodies: a loop on a body that carries it is opened
// there, the cells of a ladder between each other. Among those it is the joint farthest from the ground, in a loop by
// itself the nearest one, of two the last. Joints on the ground come last. Factorizations in rA, of loops of four to
// eight links beside those without redundancy: carried, [M Gᵀ; G 0] takes 0.63 to 0.69 times as long opened at the body
// that carries them, 0.77 to 1.05 elsewhere. Of a carried ladder of 30 cells the Newton matrix of implicit Euler takes
// 0.70, [M Gᵀ; G 0] 0.99, chosen by coefficients alone 1.09 and 1.11. Of the two joints on a body that carries a loop
// of five to eight links the last takes 0 to 7 % fewer instructions in rp, where fewer solutions are refined, and 0 to
// 3 % in rA (frames at random, 0.5 s by dop853 and half-implicit Euler). Whole runs of loops of four, six and eight
// links on the ground, beside those without redundancy (these by another processor, integrators/README.md): implicit
// Euler takes 0.85 to 0.91 opened at the joint taken, 0.86 to 0.99 at others off the ground, 1.08 at the first joint on
// the ground; half-implicit Euler, RATTLE, dopri5 and dop853 1.01 to 1.10, 1.03 to 1.16 and 1.08 to 1.22.
#pragma once

#include <span>
#include <vector>

#include "core/model.h"
#include "linsolve/separation.h"

namespace poinsot {

// By group of the model, each another.
std::vector<int> opening_turns(const Model& model);

// `rows`: of the model.
Grouped grouped_rows(const Model& model, std::span<const int> turns, std::span<const int> rows);

}  // namespace poinsot
