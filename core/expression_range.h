// Where an expression's switches can change sign: its tape evaluated on intervals of time.
//
// Every value of the stack machine is an interval that holds all the values taken over the stretch of time, widened by
// what rounding adds. A switch whose interval is on one side of zero, or is zero throughout, does not change sign
// there.
#pragma once

#include <span>

#include "core/expression_tape.h"

namespace poinsot {

bool tape_may_switch(std::span<const TapeInstruction> tape, double from, double to);

}  // namespace poinsot
