#include "integrators/methods/kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/methods/prescribed_state.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/extrapolation.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/turning.h"

namespace poinsot {
namespace {

// A step is certain up to this ratio of the first two corrections and up to this turn of a body or a driven angle, rad.
constexpr double kContraction = 0.25;
constexpr double kFullTurn = 1;
// Where so small a part of a step is not certain the position is examined, and is singular where a row is independent
// of the others by no more than kSingular of its length: beside a singular position others are known to rounding's
// root.
constexpr double kSuspicious = 0x1p-10, kSingular = 1e-6, kBarredShare = 1e-2;
constexpr double kShortest = 0x1p-24;  // part of a step
constexpr int kMostParts = 1000;
constexpr double kSharp = 1e-12;      // tolerance of Newton's corrections in parts, at least
constexpr double kFarTurn = 0.1;      // rad, of a body in a part
constexpr double kBent = 1e-4;        // of velocities, over a step or part
constexpr double kCorner = 0.02;      // of velocities that bend too much to be certain of where they lead
constexpr double kFarBeside = 100;    // times what a part of a step can change of the share of a row
constexpr double kSameLength = 1e-6;  // relative: what rounding of times makes of the lengths of steps

// Numbers are those of the paper's equations.
class Kinematics final : public FixedSteps {
 public:
  explicit Kinematics(const Run& run)
      : FixedSteps(run),
        solver_(run, clock_),
        rows_change_(has_alternates(problem_.model())),
        dq_(nv_),
        q_from_(problem_.nq()),
        v_from_(nv_),
        a_from_(nv_),
        beyond_(Vector::Zero(nv_)),
        extrapolation_(beyond_) {
    if (settings_.reactions || settings_.signals) {
      inverse_dynamics_ = std::make_unique<Consistent>(problem_, settings_.linear());
    } else {
      x_.z.setZero(nv_);  // no multipliers
    }
  }

  Status prepare() override { return solver_.prepare(); }

  // The start as given is only where the iteration begins.
  Status begin() override {
    clock_.start();
    if (Status status = solver_.find(0, settings_.tolerance, careful_, x_, beyond_); !status.ok()) return status;
    orientation_ = solver_.orientation();
    rate_from_ = problem_.counted_turn().rate, turn_from_ = problem_.fastest_turn();
    if (problem_.has_discrete_state() || problem_.exchanges_rows()) {
      if (Status status = accept(problem_); !status.ok()) return status;
    }
    return give_out(problem_);
  }

  Status step(double t) override {
    q_from_ = q_n_, v_from_ = v_n_, a_from_ = x_.z.head(nv_);
    const double h = t - x_.t;
    if (!(std::abs(h - extrapolates_for_) <= kSameLength * h)) extrapolate_anew(h);
    const Status status = advance(x_.t, t, settings_.tolerance);
    if (status.ok() && certain(h, t) && sharpen(t, settings_.tolerance)) {
      extrapolation_.lead(beyond_);
      return status;
    }
    extrapolate_anew(0);
    return follow(t, status);
  }

  // Coordinates or rows are others: so is what the determinant's sign is compared with.
  Status resume() override {
    extrapolate_anew(0);
    if (Status status = solver_.refresh(x_.t); !status.ok()) return status;
    orientation_ = solver_.orientation();
    return {};
  }

  bool divides() const override { return false; }  // it does so itself, where it is not certain
  Problem& stand() override { return problem_; }   // it does after every step
  // What turns far is followed in shorter steps.
  Status check_turns(Problem&, double) override { return {}; }

  Status check_velocity(Problem&, double) override { return {}; }  // of certain steps
  bool integrates() const override { return false; }

  Status complete() override {
    if (!inverse_dynamics_) return {};
    clock_.pause();
    Status status = inverse_dynamics_->accelerations(x_.t, span(x_.z));
    clock_.resume();
    return status;
  }

 private:
  // From (q_from_, v_from_) at `from` to x_ at t.
  Status advance(double from, double t, double tolerance) {
    if (!solver_.predicts()) {
      x_.q = q_from_;
    } else {
      const double h = t - from;
      dq_.noalias() = h * v_from_;
      // Where velocities turn round within the step, as beside a singular position, they alone say where it leads.
      if (!careful_ && 0.25 * h * h * a_from_.squaredNorm() < v_from_.squaredNorm())
        dq_ += (0.5 * h * h) * a_from_ + beyond_;
      else
        extrapolate_anew(0);
      problem_.retract(span(q_from_), span(dq_), span(x_.q));  // (11)
    }
    return solver_.find(t, tolerance, careful_, x_, beyond_);
  }

  // Steps of this length begin, of which nothing is known.
  void extrapolate_anew(double h) {
    extrapolates_for_ = h;
    beyond_.setZero();
    extrapolation_.restart(beyond_);
  }

  // Whether x_ is where the motion from q_from_ leads, over a time h to t; if so it is what the next is compared with.
  bool certain(double h, double t) {
    if (solver_.contraction() > kContraction) return false;
    const double rate = problem_.counted_turn().rate, turn = problem_.fastest_turn();
    if (h * std::max({rate, rate_from_, turn, turn_from_}) > kFullTurn) return false;
    if (comes_to_singular_position(h, t)) return false;
    const std::uint64_t here = solver_.orientation();
    if (here != orientation_ && !(rows_change_ && here == orientation_before(t))) return false;
    bent_ = (x_.v - v_from_ - (0.5 * h) * (a_from_ + x_.z.head(nv_))).squaredNorm();
    if (turns_corner(h, t)) return false;
    orientation_ = here;
    rate_from_ = rate, turn_from_ = turn;
    return true;
  }

  // Of a step that is certain. Where velocities bend sharply, as beside a singular position, those of positions beside
  // x_, too, are others.
  bool sharpen(double t, double tolerance) {
    return !(bent_ > kBent * kBent * x_.v.squaredNorm()) || solver_.sharpen(t, tolerance, x_, beyond_);
  }

  // Beyond a singular position one of the branches has a determinant of the same sign as before, the one on which
  // velocities have jumped. Drivers' kinks, at which they jump as well, are where the mechanism is regular.
  bool turns_corner(double h, double t) {
    if (!(bent_ > kCorner * kCorner * x_.v.squaredNorm())) return false;
    if (!careful_ || h > kSuspicious * step_) return true;
    return !(most_dependent_share(t) > kFarBeside * h / step_);
  }

  // At a singular position itself rates are rounding over rounding, and the determinant has no sign to compare: there
  // accelerations are out of all proportion to velocities, and those jump.
  bool comes_to_singular_position(double h, double t) {
    constexpr double kSudden = 100, kJump = 0.5;
    const double speed = x_.v.norm() + v_from_.norm();
    const bool jumps = careful_ && (x_.v - v_from_).norm() > kJump * speed;
    if (!jumps && !(h * x_.z.head(nv_).norm() > kSudden * speed)) return false;
    return most_dependent_share(t) < kSingular;
  }

  double most_dependent_share(double t) {
    const int rows = static_cast<int>(problem_.model_rows().size());
    const double share = most_dependent_row(problem_, rows, t, span(x_.q)).share;
    problem_.set_velocity(span(x_.v));
    return share;
  }

  // Where rows stand in for others at t: the orientation of the position before with the rows of now.
  std::uint64_t orientation_before(double t) {
    problem_.set_position(t, span(q_from_));
    const bool regular = solver_.refresh(t).ok();
    const std::uint64_t before = regular ? solver_.orientation() : 0;
    problem_.set_position(t, span(x_.q));
    problem_.set_velocity(span(x_.v));
    return before;
  }

  // The step to t, which as one ended as it did, in as many shorter ones as it takes to be certain of each.
  Status follow(double t, const Status& as_one) {
    const double whole = step_ = t - x_.t;
    double at = x_.t, h = 0.5 * whole;
    bool examined = false;
    careful_ = true;
    sharpen_beginning(at);
    Status status;
    for (int parts = 0; at < t; ++parts) {
      if (parts == kMostParts) {
        problem_.set_position(at, span(q_from_));
        problem_.set_velocity(span(v_from_));
        const bool far = h * problem_.fastest_turn() > kFarTurn;  // else something else keeps parts as short
        status = far || as_one.ok() ? leads_too_far(problem_, x_.a(), at, kMostParts, h) : as_one;
        break;
      }
      const double to = at + 1.01 * h >= t ? t : at + h;
      h = to - at;
      const double tolerance = std::min(settings_.tolerance, std::max(1e-3 * h * v_from_.norm(), kSharp));
      status = advance(at, to, tolerance);
      if (status.ok() && certain(h, to) && sharpen(to, tolerance)) {
        at = x_.t = to;
        h *= 2;
        examined = false;
        if (status = bring_up_to_date(); !status.ok()) break;
        q_from_ = x_.q, v_from_ = x_.v, a_from_ = x_.z.head(nv_);
        continue;
      }
      h *= 0.5;
      const bool ends = !(h >= kShortest * whole && at + h > at);
      if (ends || (h < kSuspicious * whole && !std::exchange(examined, true))) {
        const DependentRow found =
            most_dependent_row(problem_, static_cast<int>(problem_.model_rows().size()), at, span(q_from_));
        if (found.share < kSingular && std::exchange(chose_at_, at) != at && choose_others(at)) {
          h = 0.5 * (t - at);
          continue;
        }
        // Towards a barred position shares go with the root of the time that is left.
        const bool barred = ends && found.barred && found.share < kBarredShare;
        if (found.share < kSingular || barred || (ends && status.ok())) status = branching(at, found);
        if (status.failure == Failure::not_converged && !as_one.ok()) status = as_one;
        if (ends || found.share < kSingular) break;
      }
    }
    careful_ = false;
    if (status.failure == Failure::not_finite) problem_.set_position(status.time, span(q_from_));  // where to look why
    return status;
  }

  // A step ends on its position up to the tolerance, which is more than short parts move: from there corrections would
  // not say how sure one may be of them.
  void sharpen_beginning(double at) {
    x_.q = q_from_;
    if (!solver_.find(at, kSharp, true, x_, dq_).ok() || solver_.orientation() != orientation_) return;
    q_from_ = x_.q, v_from_ = x_.v, a_from_ = x_.z.head(nv_);
  }

  // Charts and rows, in the parts of a step that may turn bodies by far more than serves them.
  Status bring_up_to_date() {
    if (!problem_.has_discrete_state()) return {};
    bool rewritten = false;
    if (Status status = poinsot::accept(problem_, x_, rewritten); !status.ok()) return status;
    return rewritten ? resume() : Status{};
  }

  // Of the rows at (q_from_, v_from_), which all but depend on one another.
  bool choose_others(double at) {
    if (!problem_.choose_rows_here(at, span(q_from_), span(v_from_), {})) return false;
    x_.t = at, x_.q = q_from_, x_.v = v_from_;
    return resume().ok();
  }

  Status branching(double t, const DependentRow& found) const {
    const std::string which = found.row < 0 ? ""
                                            : fmt::format(", where {} depends on the other constraints",
                                                          problem_.describe_unknown(problem_.nv() + found.row));
    return {Failure::singular_position, t,
            fmt::format("at t = {:.9g} s the mechanism comes to a singular position{}: {}", t, which,
                        found.barred ? kBarred
                                     : "its motion can go on in more than one way, or not at all; end before it, or "
                                       "start beyond it on the branch that is meant, or let analysis dynamics pass it "
                                       "by integrator dop853")};
  }

  PrescribedState solver_;
  const bool rows_change_;
  std::unique_ptr<Consistent> inverse_dynamics_;
  Vector dq_;
  Vector q_from_, v_from_, a_from_;  // where a step, or a part of it, begins
  Vector beyond_;  // what lies beyond h v + h²/2 a: as steps before have it, then as this one finds it
  Extrapolation extrapolation_;
  double extrapolates_for_ = 0;  // length of these steps
  double chose_at_ = -1;         // time of the part for which other rows were asked for
  bool careful_ = false;         // in parts of a step,
  double step_ = 0;              // of this length
  // By how much velocities changed in the last one beside what the accelerations at both ends tell; squared.
  double bent_ = 0;
  std::uint64_t orientation_ = 0;
  double rate_from_ = 0, turn_from_ = 0;  // rad/s, of counted turns and of bodies, where a step begins
};

}  // namespace

std::unique_ptr<Integrator> make_kinematics() {
  return std::make_unique<FixedStepIntegrator<Kinematics>>();
}

}  // namespace poinsot
