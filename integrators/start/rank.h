// Which constraint rows follow from others, which are singular where the mechanism stands, and which contradict.
//
// A row is redundant when it follows from the others: its gradient is a combination of theirs, and where they are kept
// it holds by itself, here and at positions beside. Those positions are looked at: the mechanism is moved a little
// along its velocities and along random directions its constraints leave free, time going on where drivers ask for it,
// and put back onto the independent rows. A row that has become independent there, or does not hold any more, is
// singular here: its gradient is a combination of the others' (or vanishes) at the given position only.
//
// Long mechanisms have rows of which as little is left beside the others as in a singular position, wherever they
// stand: loads may change slowly from one end to the other. Such rows lean on what has grown along the mechanism, and
// are taken as independent (FrontQr::stretched).
//
// Rank is decided on unit vectors in lengths of bodies (integrators/start/row_space.h), and among the rows of loops
// only (loop_rows.h). The cost grows with the number of rows (linsolve/column_dependencies.h).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/start/conflicts.h"
#include "integrators/start/doubtful_rows.h"
#include "integrators/start/undetermined.h"

namespace poinsot {

struct Dependency {
  int row;                  // model row that adds nothing
  std::vector<int> others;  // model rows it is a combination of
};

struct RankAnalysis {
  int variables = 0;                  // 6 per body
  int rank = 0;                       // of G but for singular positions: rows that are not redundant
  int rank_here = 0;                  // of G at the given position
  std::vector<Dependency> dependent;  // redundant rows, by row: each follows from rows before it; see RankNames
  std::vector<Dependency> singular;   // rows that are no more than combinations of others here
  std::vector<Dependency> touching;   // singular along the motion, too, and set aside (touching_rows.h)
  std::vector<int> loops;             // rows among which all of these are (loop_rows.h)
  // As many rows as are redundant, ascending, chosen so that the others are as independent as can be.
  std::vector<int> aside;
  // Rows that are singular here and rows to be set aside: without them G has full rank at the given position.
  std::vector<int> aside_here;
  // By group. Where there are very many redundant rows, all groups with some nearby.
  std::vector<Undetermined> undetermined;
  std::vector<Conflict> conflicts;  // by row
  // Singular rows follow from others to the first order of a move: next to the position they are hardly independent.
  bool to_first_order = false;
  bool named = true;       // false: too many to say what each depends on; `others` are empty
  bool moves_on = true;    // singular: whether the velocities lead away from the singular position
  double time_beside = 0;  // s: after which they have, by a thousandth of the bodies' sizes
  Doubt doubt;

  int degrees_of_freedom() const { return variables - rank; }
  bool singular_position() const { return rank_here < rank; }
  std::vector<int> dependent_rows() const;
};

// Whether `dependent` is worked out, which can take far longer than all else, or `aside` is all that is needed.
enum class RankNames { none, all };

RankAnalysis analyze_rank(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                          RankNames names);

}  // namespace poinsot
