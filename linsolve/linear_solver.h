// Solves A x = b for a sparse, square, in general unsymmetric A whose structure is known before its values.
//
// 1. analyze(pattern) is called once: it fixes the layout and does all symbolic work. state() becomes analyzed.
// 2. The caller writes the values of A: every block at the slots() (see linsolve/pattern.h). What no block covers is
// zero from the start, and stays so.
// 3. factor() factorizes what values() holds, and values() holds it afterwards, though slots() may be others then.
// state() becomes factored when it answers ok.
// factor({b}) is for a right-hand side that is known by then: a solver may begin with it on the way. Its next call is
// solve(b), with the same numbers at the same place. factor({b, true}) says that this solve will be the only one, and a
// solver need not keep what others would need: each costs another factorization, as long as values() are still the
// same.
// 4. solve(b) replaces b by A⁻¹ b, solve_transposed(b) by A⁻ᵀ b, as often as wanted, for the values of the last
// factor(). Not every solver knows the second (linsolve/registry.h).
// 5. 2 to 4 repeat; nothing is allocated in them after the first round.
// 6. A matrix that is singular to working precision is never answered with ok: neither by factor() nor by solve().
// 7. Calls out of order and wrong sizes are bugs of the caller: they throw std::logic_error.
// 8. After an answer other than ok, b holds garbage and state() is analyzed again.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "linsolve/pattern.h"

namespace poinsot {

enum class LinearFailure { none, structurally_singular, singular, not_finite, out_of_memory, refused };

struct [[nodiscard]] LinearStatus {
  LinearFailure failure = LinearFailure::none;
  int unknown = -1;     // the row or column that has no pivot, where the solver knows it
  std::string message;  // empty when ok

  bool ok() const { return failure == LinearFailure::none; }
};

struct LinearStatistics {
  std::int64_t analyses = 0, factorizations = 0, refactorizations = 0,
               solves = 0;       // refactorizations: with kept pivots
  std::int64_t handed_over = 0;  // calls of factor() left to another solver, counted here only
  std::int64_t refinements = 0;  // corrections of solutions by their residual
  std::int64_t nonzeros = 0, factor_nonzeros = 0;
  double reciprocal_condition = 0;  // whatever the scaling (linsolve/condition.h), when last examined; 0 where unknown
};

// What will be solved for after a factorization.
struct Ahead {
  std::span<const double> b = {};  // first; empty: not known
  bool only = false;               // and nothing else
};

// What there will be most of, a hint for solvers that have a choice; or that the transposed matrix will be asked for.
enum class Workload { factorizations, solves, transposed };

class LinearSolver {
 public:
  enum class State { empty, analyzed, factored };
  // Another solver that this one hands over to what it does not master, once it has.
  struct Helper {
    std::string_view name;
    const LinearSolver* solver = nullptr;
  };

  virtual ~LinearSolver() = default;

  LinearStatus analyze(Pattern pattern, Workload workload = Workload::factorizations);
  LinearStatus factor(Ahead ahead = {});
  LinearStatus solve(std::span<double> b);
  LinearStatus solve_transposed(std::span<double> b);

  virtual std::span<const int> slots() const { return slots_; }  // one per block column, blocks in pattern order
  virtual std::span<double> values() { return values_; }
  // Of a solver that chooses another one to do its work: that one's name, from analyze() on.
  virtual std::string_view picked() const { return {}; }
  virtual Helper helper() const { return {}; }
  // Of the factored matrix: stays the same, from one factorization to another after one analyze(), as long as the
  // determinant of no diagonal block that the solver works on by itself (at least: of the whole) changes its sign.
  // 0 where the solver does not know.
  virtual std::uint64_t orientation() { return 0; }
  State state() const { return state_; }
  int size() const { return n_; }
  virtual const LinearStatistics& statistics() const { return statistics_; }

 protected:
  // Sets up slots_ and values_ (usually by CscLayout) and everything symbolic. The pattern's room may be given back
  // before: of large systems it is a twentieth of all that lives.
  virtual LinearStatus do_analyze(Pattern&& pattern) = 0;
  virtual LinearStatus do_factor() = 0;
  virtual LinearStatus do_factor_for(Ahead /*ahead*/) { return do_factor(); }
  virtual LinearStatus do_solve(std::span<double> b) = 0;
  virtual LinearStatus do_solve_transposed(std::span<double> b);
  Workload workload() const { return workload_; }

  std::vector<int> slots_;
  std::vector<double> values_;
  LinearStatistics statistics_;

 private:
  template <class Work>
  LinearStatus solved(std::span<double> b, Work&& work);

  int n_ = 0;
  Workload workload_ = Workload::factorizations;
  State state_ = State::empty;
  const double* next_ = nullptr;  // the right-hand side that is to be solved for next
};

}  // namespace poinsot
