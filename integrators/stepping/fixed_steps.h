// The frame of methods of fixed step: steps on the time grid, the discrete state brought up to date after each,
// samples, and what is left behind at the end or after a failure.
//
// A method derives from FixedSteps, says what its step is, and overrides what else it does differently. March calls
//   prepare, begin,   then for every t_n:   [leave_singular | resume] step [stand [accept] [complete, sample]]
// A step that fails numerically is done again, with other rows or in parts (fixed_step_redo.cpp): then resize and,
// after a failure, forget are called besides. A step that ends in a singular position, seen by what it makes of
// velocities or by the failure of the next one, ends in the limit of states beside it (singular_ends.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "integrators/stepping/branch.h"
#include "integrators/stepping/coarse_steps.h"
#include "integrators/stepping/driver_jumps.h"
#include "integrators/stepping/gap_watch.h"
#include "integrators/stepping/index1_output.h"
#include "integrators/stepping/law_jumps.h"
#include "integrators/stepping/numerical_damping.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/passed_in_steps.h"
#include "integrators/stepping/rest_watch.h"
#include "integrators/stepping/singular_ends.h"
#include "integrators/stepping/still_watch.h"
#include "integrators/stepping/struck_in_steps.h"
#include "integrators/stepping/switch_times.h"
#include "integrators/stepping/time_grid.h"
#include "integrators/stepping/turned_in_steps.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

class FixedSteps {
 public:
  explicit FixedSteps(const Run& run);
  virtual ~FixedSteps() = default;

  Status march();

 protected:
  using Vector = Eigen::VectorXd;

  // Analyses patterns; before the clock starts.
  virtual Status prepare() = 0;
  // The start, x_ at 0, is given out, and the clock starts.
  virtual Status begin();
  // From (q_n_, v_n_) at x_.t to x_ at t. Where it fails, q and v become what they were.
  virtual Status step(double t) = 0;
  // The step to t that was just done ends in a singular position: x_ at t anew, where it took what the constraints say
  // of velocities for better than it is there.
  virtual Status repeat_singular(double /*t*/) { return {}; }
  // The problem that stands at x_.
  virtual Problem& stand();
  // The problem that stands at the end of the step, or where Newton's method saw it last.
  virtual Problem& last_seen() { return problem_; }
  // Whether the step to t turned bodies no further than can be followed; `problem` as last seen.
  virtual Status check_turns(Problem& problem, double t);
  // Whether its velocity goes on from that before, as far as it turns bodies.
  virtual Status check_velocity(Problem& problem, double t);
  // Whether h times this, by which a step goes beyond what its beginning leads to, turns bodies too little for another
  // branch.
  Status check_moved(Problem& problem, const Vector& by, double t);
  // Brings the discrete state up to date; `problem` stands at x_ before and after.
  virtual Status accept(Problem& problem);
  // Before the step that follows an accept() which has rewritten coordinates or rows.
  virtual Status resume() { return {}; }
  // Before the step out of a singular position, in the place of resume(): in x_ stands the limit of the states beside
  // it, and λ and what a method carries along from steps before are nothing to go by.
  virtual Status leave_singular() { return {}; }
  // Finds the (a, λ) of a sample, where steps do not.
  virtual Status complete() { return {}; }
  // δq/δa of a step whose (a, λ) are solved from Φ = 0, by which rounding is magnified and better may be given out;
  // else 0.
  virtual double index3_scale() const { return 0; }
  // Whether its velocities are differences of positions: half a step behind, by more of a motion that turns. The step
  // that begins with others has an acceleration and multipliers that no step makes smaller.
  virtual bool backward_velocities() const { return false; }
  // Whether velocities go on from those of steps before, by which branches are told apart.
  virtual bool integrates() const { return true; }
  // Whether a step that fails may be done in parts, of other lengths than the rest.
  virtual bool divides() const { return true; }
  // Whether it takes from the motion what implicit Euler does (numerical_damping.h).
  virtual bool damps() const { return false; }
  // What it loses of phases, where it keeps amplitudes.
  virtual PhaseError phase_error() const { return {}; }
  // Whether a step depends on more of those before it than x_.
  virtual bool remembers() const { return false; }
  // The next step is one of h_, which has been `before`.
  virtual void resize(double /*before*/) {}
  // The step failed: x_ is what it was before, and so is to be all else.
  virtual Status forget() { return {}; }

  void place(Problem& problem) const {
    problem.set_position(x_.t, span(x_.q));
    problem.set_velocity(span(x_.v));
  }
  // In the middle of the step that x_ leads to, for a first step out of a singular position: there G has its rank. It
  // costs that one step an error of order h in the directions of the reactions.
  void place_beside(Problem& problem);
  // Completes and gives out x_, where the problem stands; the time it takes outside is left out.
  Status give_out(Problem& problem);

  const Run& run_;
  Problem& problem_;
  const Settings& settings_;
  PhaseClock clock_;
  const TimeGrid grid_;
  double h_;  // of the step under way
  const Eigen::Index nv_, nc_;
  State x_;
  Vector q_n_, v_n_;  // where the step began

 private:
  // How x_ stands where the next step begins, and what that step begins with.
  enum class Start {
    usual,      // as the one before left it
    rewritten,  // in other coordinates or with other rows: resume
    limit,      // of the states beside a singular position: leave_singular
  };
  // What is asked of the step under way about its branch.
  enum class OnBranch {
    asked,
    doubted,  // it failed because it may have left it
    granted,  // nothing: in parts it did no better
  };
  struct Beginning {
    State x;
    Start start;
    bool rows_asked;
    double shortest;
    std::int64_t steps;
  };

  // The step of the grid to t, by whatever it takes: fixed_step_redo.cpp.
  Status advance(double t, bool sampled);
  Status reach_or_redo(double t, bool sampled, int halvings);
  Status redo_whole(double t, double half, bool sampled, Status as_one);
  Status reach_in_halves(double t, double half, bool sampled, int halvings);
  void tell_parts_beside_singular(const State& from, double t);
  void begin_from(const Beginning& beginning);
  Status take_back();
  bool goes_over_jump(const Status& failed, double t);
  Status reach_over_jump(double t, bool sampled, Status failed);
  LawJumps::Sides sides_of_jumps();
  void go_to(const State& led);
  bool choose_rows();
  void rewrite();
  bool settles_beginning();
  std::vector<BodyState> bodies();  // where x_ is
  void set_step(double h);

  Status reach(double t, bool sampled);
  // Whether x_ is to stand as the end of its step; as the limit of states beside it where it was `settled`.
  Status examine_end(bool& settled);
  Status settle_end(bool& settled);
  bool settle_step(State& at);
  bool settle(SingularEnds& ends, Problem& problem, const Vector& v_n, State& at);
  void look_for_jumps();
  Status measure_rotation(Problem& problem, double t);
  // Whether the step ends on the branch that its velocities lead to.
  Status check_branch(Problem& problem);

  const bool discrete_;        // something is to be brought up to date after every step
  const bool has_alternates_;  // or where rows stand in for others
  const bool has_velocity_rows_;
  const bool chooses_;  // rows among those that are redundant
  Start start_ = Start::usual;
  OnBranch on_branch_ = OnBranch::asked;
  bool anew_ = true;             // the step under way begins with a velocity that is none of its scheme's
  bool began_anew_ = false;      // so did the last
  bool rows_asked_ = false;      // other rows were asked for where the step under way begins
  Problem* standing_ = nullptr;  // the problem that stands at x_
  Vector z_began_;               // of a step that may be done again or begins anew, where it began
  double shortest_ = 0;          // of the steps done
  double rotation_ = 0;          // of the last step, the largest of a body
  double rotation_began_ = 0;    // at the start
  Vector change_;
  BranchWatch branch_;
  const PositionJump jump_;  // up to which steps go
  DriverJumps driver_jumps_;
  RestWatch rests_;
  GapWatch gaps_;
  StillWatch still_;
  NumericalDamping damping_;
  std::optional<CoarseSteps> coarse_;
  SingularEnds singular_ends_;
  PassedInSteps passed_;
  TurnedInSteps turned_;
  StruckInSteps struck_;
  LawJumps jumps_;
  LawJumps::Sides sides_, sides_before_;  // of jumps, at the last look and the one before
  bool over_jumps_ = false;               // the step under way was led over some
  bool thrown_ = false;                   // the step that was tried last put a spring on its other side
  bool jump_told_ = false;
  std::optional<State> led_;    // where the step under way leads, by accelerations as they are
  std::optional<State> given_;  // a sample in a singular position
  OpenMultipliers open_multipliers_;
  bool settles_ = false;      // ends in singular positions are
  bool divides_ = false;      // steps that fail are done in parts
  bool repeats_ = false;      // and may be done as they were after that
  bool doubted_ = false;      // of a branch, and told
  bool told_ = false;         // of a singular end
  bool branch_told_ = false;  // of a step in parts beside one
  Index1Output output_;
};

// An integrator each of whose runs is an object of type Method, made from the run.
template <class Method>
class FixedStepIntegrator final : public Integrator {
 public:
  Status run(const Run& run) override { return Method(run).march(); }
};

}  // namespace poinsot
