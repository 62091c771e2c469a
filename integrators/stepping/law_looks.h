// What a method does not see of a law on its way over a step (law_path.h).
//
// It sees F where interval arithmetic holds it, piece by piece, within what it comes to at the ends of the step or at
// four of nine places in between, widened by twice as much to either side.
#pragma once

#include "integrators/stepping/law_path.h"

namespace poinsot {

// The first place of a step at which F may come to more than is seen, by more than `nothing`; known: it does.
struct UnseenForce {
  double s = 1;
  bool known = false;
};
UnseenForce first_unseen(const LawPath& path, const LawEnds& ends, double nothing);
// Some place where it is known that F does, in less work.
UnseenForce first_known(const LawPath& path, const LawEnds& ends, double nothing);
// The same for a method that looks at forces where its steps end, and nowhere between: where F leaves what its ends,
// and the slopes there, lead to.
UnseenForce first_between(const LawPath& path, const LawEnds& ends, double nothing);
// Where F varies more steeply than the stages of a step can tell, as tanh(1e4 x) in passing, which makes estimates of
// the error a matter of luck: it is off the polynomial of degree six through its values and slopes at the ends and its
// values at three places between.
UnseenForce first_steep(const LawPath& path, const LawEnds& ends, double nothing);
// Where F goes on by another cubic of a table and that matters (table_knots.h); 1 if nowhere.
double first_table_knot(const LawPath& path, double nothing);

}  // namespace poinsot
