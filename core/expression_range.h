// Bounds of an expression over a stretch of time, with its first two derivatives, and of its switches: its tape
// evaluated on intervals (core/bounds.h).
//
// The variables are intervals, x and v of a law unknown where nothing is said of them; what depends on them is unknown
// then. A switch whose interval is on one side of zero, or is zero throughout, does not change sign there. The
// interval of a single time is as wide as rounding leaves a value uncertain.
#pragma once

#include <span>

#include "core/bounds.h"
#include "core/expression_tape.h"

namespace poinsot {

// The derivatives are those by one of the variables.
Jet2<Bounds> tape_range(std::span<const TapeInstruction> tape, const Arguments<Bounds>& at, TapeOp by = TapeOp::time);

// Of the switch k, in the order of the tape.
Bounds tape_switch_range(std::span<const TapeInstruction> tape, const Arguments<Bounds>& at, int k);

// Whether f jumps there: a sign or a step.
bool tape_switch_jumps(std::span<const TapeInstruction> tape, int k);

}  // namespace poinsot
