// A state made consistent: accelerations and multipliers, mass-orthogonal projections onto the constraints.
//
//   [M Gᵀ; G 0] [a; λ] = [Q; γ]
//   positions: M δq + Gᵀμ = 0, G δq = −Φ, q ← q ⊞ δq, repeated;   velocities: M δv + Gᵀμ = 0, G δv = ν − G v
//
// From afar (project_position, project_velocity) every correction of the position has a matrix of its own. From nearby
// (project) all share one: a method that leaves the constraints by the size e of its local error is brought back by
// simplified Newton steps with the factorization that belongs to the accelerations; one correction leaves e². One step
// of iterative refinement makes a and λ belong to the projected state, again up to e². Neither costs a factorization or
// the order.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "integrators/stepping/parts.h"
#include "integrators/stepping/step_system.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

class PositionRows;

class Consistent {
 public:
  // Part of a run: counted and timed there.
  Consistent(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock);
  // Beside a run: with a linear system of its own, counted nowhere.
  Consistent(Problem& problem, const LinearChoice& choice);
  ~Consistent();

  // Analyses the pattern. Where steps must not allocate, call it before the clock starts; else the first factorization
  // does.
  Status prepare();
  // Factors [M Gᵀ; G 0] at the point where the problem stands, for b where solve(t, b) comes next.
  Status factor(double t, Ahead ahead = {});
  // b ← [M Gᵀ; G 0]⁻¹ b with the factorization at hand.
  Status solve(double t, std::span<double> b) { return system_.solve(t, b); }

  // The problem stands at (t, q, v); z = (a, λ) is written. The factorization belongs to this point.
  Status accelerations(double t, std::span<double> z);
  // Moves q onto Φ = 0 to rounding; the problem stands at the result. Fails with inconsistent_state where it cannot.
  // `moved`, where it is asked for, is what it adds up its corrections in.
  Status project_position(double t, std::span<double> q, std::span<double> moved = {});
  // The same from nearby the position whose factorization is at hand: that leads most of the way.
  Status project_nearby(double t, std::span<double> q) { return onto_positions(t, q, {}, draw_near(t, q)); }
  // The problem stands at (t, q) and (·, v); v and the problem are moved onto G v = ν.
  Status project_velocity(double t, std::span<double> v);
  // With the factorization at hand, of the same position but for a correction.
  Status correct_velocity(double t, std::span<double> v);

  // The same for a state, `at`.
  void stand(const State& at);
  Status accelerations(State& at);
  // M a + Gᵀλ − Q and G a − γ of a state the problem stands at.
  void residual(const State& at, std::span<double> out);
  // Moves q and v onto the constraints with the factorization at hand, which belongs to a state nearby, and says
  // whether they moved; the problem stands at the result. Fails with singular_position, without words, where rounding
  // would decide about velocities.
  Status project(State& at, bool& moved);
  // How far project() moved the last state, δq and then δv.
  std::span<const double> moved_by() const { return span(moved_by_); }
  // How far rows that are off by one move positions, with the factorization at hand: 1/σ next to a singular position, σ
  // being the distance. amplification(): how many times more than usually at the ends of steps, where that is so much
  // that a singular position is near, else 1; at the end of some steps, and by the steepness given to look().
  // beside_singular(): whether that was so ever since asked last.
  // Of one mechanism of the scene: how far its bodies.
  double steepness(double t);
  double steepness(double t, std::size_t part);
  void look(double steepness);  // as was just found
  double amplification() const { return amplification_; }
  // Of G, where that is square and was factored by itself at last; else 0 (linsolve/linear_solver.h).
  std::uint64_t orientation() { return system_.jacobian_orientation(); }
  // How many times as steep as usual, of the mechanism that is most so, as last looked at.
  double steeper() const { return steeper_; }
  double least_steepness() const { return least_steepness_; }  // at the ends of steps; infinite before
  std::span<const double> signs() const { return span(off_by_one_).subspan(nv_); }  // that steepness() is found with
  double amplification(std::size_t part) const { return branches_[part].amplification; }
  // What of `shift`, the norm of a state's move onto the constraints by δq and then δv, is an error of its own: next to
  // a singular position a part of it, and none of what rounding moves at the steepness looked at, ε/σ and ω ε/σ²;
  // some times as much in a limit, which takes out what the steps towards it have gathered.
  double error_in(const State& at, std::span<const double> moved_by, double shift, bool settled = false) const;
  bool beside_singular() { return std::exchange(beside_singular_, false); }
  void tell_singular() { beside_singular_ = true; }  // seen otherwise
  // Whether accelerations where the problem stands are far larger than they were, and than forces and γ account for, so
  // that [M Gᵀ; G 0]⁻¹ is what makes them, next to a singular position.
  bool made_of_rounding(const State& at);
  // Whether a state has gone another way than the motion led: such a one whose velocities differ by a hundredth from
  // what they were before, or one whose accelerations have turned round where velocities vanish. Rounding has then
  // chosen among branches.
  bool leaves_branch(const State& at);
  // Whether most of x, nv numbers, lies in the direction in which rows that are off by one move positions, in M, of one
  // mechanism; that is where beside a singular position the constraints leave free more than elsewhere. With the
  // factorization at hand.
  bool lies_free(double t, const Eigen::VectorXd& x, std::size_t part);
  // A step ends there that leaves none.
  void follow(const State& at);
  // Instead of what was followed: accelerations were a at a time t, bodies have turned since, and how steep the
  // constraints usually are another one knows.
  void expect(double t, std::span<const double> a, double turned, const Consistent& other);
  // Coordinates or the data are others: accelerations of before are not to be compared with.
  void forget_approach();
  int forgotten() const { return forgotten_; }  // times
  // x ← its part along the constraints, M-orthogonally, with the factorization at hand; nv numbers. The problem stands
  // at `at`, before and after.
  Status along_constraints(const State& at, std::span<double> x);
  // (a, λ) of the state the problem stands at, from those of a state nearby and its factorization.
  Status refine(State& at);
  // Accelerations, projection, refinement: the consistent state beside (q, v).
  Status complete(State& at);
  // Leads a state on to a time so near that accelerations stay what they are.
  void lead(State& at, double t);
  // Likewise to just past a switch of the data, consistent on the far side of it. Where the rate of a driver jumps, v
  // does, by the least change in M: the impulse of the constraints. Positions cannot; then it fails.
  Status cross(State& at, double t);

 private:
  // What a run lends.
  struct Aside {
    LinearSystem linear;
    Statistics statistics;
    PhaseClock clock;
  };
  Consistent(Problem& problem, std::unique_ptr<Aside>&& aside);
  Consistent(Problem& problem, LinearSystem& linear, Statistics& statistics, PhaseClock& clock,
             std::unique_ptr<Aside>&& aside);

  // Of one mechanism.
  bool made_of_rounding(const State& at, std::size_t part);
  bool turns_back(const State& at, std::size_t part);
  bool jumps(const State& at, std::size_t part) const;
  void approach(const State& at, std::size_t part);

  // With the factorization at hand; the last correction. Where it does not lead onto Φ = 0, q stays and it is infinite.
  double draw_near(double t, std::span<double> q);
  // `before`: the size of the correction that led to q.
  Status onto_positions(double t, std::span<double> q, std::span<double> moved, double before);
  // The same by the rows of positions alone; nothing is factored.
  Status onto_position_rows(double t, std::span<double> q, std::span<double> moved);
  // δq and δv for the constraints' residuals at the problem's point, in moves().
  Status position_correction(double t);
  Status velocity_correction(double t);
  std::span<double> moves() { return std::span(rhs_.data(), nv_); }
  std::span<double> rows() { return std::span(rhs_.data() + nv_, nc_); }

  Problem& problem_;
  std::unique_ptr<Aside> aside_;
  StepSystem system_;
  bool prepared_ = false;
  const bool has_velocity_rows_;
  std::unique_ptr<PositionRows> position_rows_;  // once they are needed
  static constexpr int kSeldom = 4;              // steps, of which one is looked at where no singular position is near
  static constexpr double kSteep = 30;           // times the usual steepness: a singular position is near
  double steepness_ = 0, usual_steepness_ = 0, amplification_ = 1, steeper_ = 1;
  double least_steepness_ = HUGE_VAL;
  bool beside_singular_ = false;
  int not_looked_ = 0;  // steps
  int forgotten_ = 0;
  double turned_ = 0;  // rad, by those
  double followed_ = 0;
  // What is known of a mechanism's branch, each by itself; of vectors its components.
  struct Branch {
    double steepness = 0, usual_steepness = 0, amplification = 1;
    struct Calm {  // the last state whose accelerations were as usual
      double t = 0, usual = 0;
    } calm;
    struct Approach {  // the last state that had no singular position near, as was last seen
      bool known = false;
      double t = 0, turned = 0;
      double rate = -1;    // at which accelerations changed before it; below 0: not known
      bool steady = true;  // those since have hardly turned, each against the one before
    } approach;
  };
  const Parts parts_;
  std::vector<Branch> branches_;
  Eigen::VectorXd calm_v_, approach_a_, last_a_;  // velocities when calm; accelerations at the approach, and the last
  double off_ = 0;                                // largest |Φ| or |G v − ν| that the last correction was for
  const std::size_t nv_, nc_;
  Eigen::VectorXd rhs_, zeros_, rows_, q_moved_, moved_by_, off_by_one_;
};

// Whether accelerations of a mechanism are about the reverse of what they were.
bool turned_round(const Parts& parts, std::size_t part, const Eigen::VectorXd& before, const Eigen::VectorXd& now);

}  // namespace poinsot
