// Kinks that show in no argument's sign, written so that they do: roots and arcs of what touches the end of their
// domain and turns back. There the numbers would be made of rounding, too.
//
//   (x²)^½ = |x|        √(a − a cos x) = √(2a) |sin(x/2)|     √(a + a cos x) = √(2a) |cos(x/2)|
//   √(a − a cos² x) = √a |sin x|, and so with sine and cosine exchanged
//   acos(cos x), whose kinks are where sin x is 0; acos(sin x) = acos(cos(x − π/2)), asin(u) = π/2 − acos(u)
//
// What is written in other ways, as a root of the sum of two squares that vanish together, stays what it is.
#pragma once

#include <vector>

#include "core/expression_tape.h"

namespace poinsot {

// Each works on the topmost value of the tape, and is false, the tape unchanged, where it has no such form.
bool take_root(std::vector<TapeInstruction>& tape, double exponent);  // no whole number
bool take_arc(std::vector<TapeInstruction>& tape, TapeOp arc);        // asin or acos

}  // namespace poinsot
