// A tape as the sum that it is: what stands between its plus and minus signs, products of sums multiplied out.
//
// A feature is as plain in a term by itself as a smooth background makes it small in the whole.
#pragma once

#include <span>
#include <vector>

#include "core/expression_tape.h"

namespace poinsot {

using Tape = std::vector<TapeInstruction>;

// Terms whose sum is the tape's value but for a polynomial of the variables: none where that is all of it, or the tape
// is no sum, or one of too many.
std::vector<Tape> tape_terms(std::span<const TapeInstruction> tape);
Tape sum_of(std::span<const Tape> terms);

}  // namespace poinsot
