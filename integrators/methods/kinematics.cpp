#include "integrators/methods/kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/methods/kinematic_certainty.h"
#include "integrators/methods/prescribed_state.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/extrapolation.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/turning.h"

namespace poinsot {
namespace {

constexpr double kBarredShare = 1e-2;  // of a row's length that is independent of the others
constexpr double kShortest = 0x1p-24;  // part of a step
constexpr int kMostParts = 10'000;
constexpr double kSharp = 1e-12;      // tolerance of Newton's corrections in parts, at least
constexpr double kFarTurn = 0.1;      // rad, of a body in a part
constexpr double kFollowed = 0.5;     // rad, of a body in a step
constexpr double kSameLength = 1e-6;  // relative: what rounding of times makes of the lengths of steps

// Numbers are those of the paper's equations.
class Kinematics final : public FixedSteps {
 public:
  explicit Kinematics(const Run& run)
      : FixedSteps(run),
        solver_(run, clock_),
        certainty_(problem_, solver_),
        dq_(nv_),
        from_{Vector(problem_.nq()), Vector(nv_), Vector(nv_)},
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
    certainty_.begin();
    if (problem_.has_discrete_state() || problem_.exchanges_rows()) {
      if (Status status = accept(problem_); !status.ok()) return status;
    }
    return give_out(problem_);
  }

  Status step(double t) override {
    from_.q = q_n_, from_.v = v_n_, from_.a = x_.z.head(nv_);
    const double h = t - x_.t;
    if (!(std::abs(h - extrapolates_for_) <= kSameLength * h)) extrapolate_anew(h);
    const Status status = advance(x_.t, t, settings_.tolerance);
    if (status.ok() && certain(h, t, settings_.tolerance)) {
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
    certainty_.take_orientation();
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
  // From (from_.q, from_.v) at `from` to x_ at t.
  Status advance(double from, double t, double tolerance) {
    if (!solver_.predicts()) {
      x_.q = from_.q;
    } else {
      const double h = t - from;
      dq_.noalias() = h * from_.v;
      // Where velocities turn round within the step, as beside a singular position, they alone say where it leads.
      if (!careful_ && 0.25 * h * h * from_.a.squaredNorm() < from_.v.squaredNorm())
        dq_ += (0.5 * h * h) * from_.a + beyond_;
      else
        extrapolate_anew(0);
      problem_.retract(span(from_.q), span(dq_), span(x_.q));  // (11)
    }
    return solver_.find(t, tolerance, careful_, x_, beyond_);
  }

  // Steps of this length begin, of which nothing is known.
  void extrapolate_anew(double h) {
    extrapolates_for_ = h;
    beyond_.setZero();
    extrapolation_.restart(beyond_);
  }

  // Whether x_ at t, over a time h, is where the motion leads, and found as sharply as velocities ask for.
  bool certain(double h, double t, double tolerance, double part = 0) {
    return certainty_.holds(from_, x_, h, t, part) &&
           (!certainty_.bends() || solver_.sharpen(t, tolerance, x_, beyond_));
  }

  // The step to t, which as one ended as it did, in as many shorter ones as it takes to be certain of each.
  Status follow(double t, const Status& as_one) {
    const double whole = t - x_.t;
    double at = x_.t, h = 0.5 * whole;
    bool examined = false;
    careful_ = true;
    sharpen_beginning(at);
    Status status;
    for (int parts = 0; at < t; ++parts) {
      if (parts == kMostParts) {
        const bool far = h * turn_at(at) > kFarTurn;  // else something else keeps parts as short
        status = far || as_one.ok() ? leads_too_far(problem_, x_.a(), at, kMostParts, h) : as_one;
        break;
      }
      const double to = at + 1.01 * h >= t ? t : at + h;
      h = to - at;
      const double tolerance = std::min(settings_.tolerance, std::max(1e-3 * h * from_.v.norm(), kSharp));
      status = advance(at, to, tolerance);
      if (status.ok() && certain(h, to, tolerance, h / whole)) {
        at = x_.t = to;
        h *= 2;
        examined = false;
        if (status = bring_up_to_date(); !status.ok()) break;
        from_.take(x_);
        continue;
      }
      h *= 0.5;
      const bool ends = !(h >= kShortest * whole && at + h > at);
      if (const double turn = ends ? turn_at(at) : 0; h * turn > kFarTurn) {  // the shortest are too long
        status = leads_too_far(problem_, x_.a(), at, kMostParts, kFollowed / turn);
        break;
      }
      if (ends || (h < kSuspicious * whole && !std::exchange(examined, true))) {
        const DependentRow found =
            most_dependent_row(problem_, static_cast<int>(problem_.model_rows().size()), at, span(from_.q));
        if (found.share < kSingularShare && std::exchange(chose_at_, at) != at && choose_others(at)) {
          h = 0.5 * (t - at);
          continue;
        }
        // Towards a barred position shares go with the root of the time that is left.
        const bool barred = ends && found.barred && found.share < kBarredShare;
        // Where velocities grow without bound by themselves parts are never short enough.
        const bool grows = ends && status.ok() && found.share > kBarredShare && !as_one.ok();
        if (found.share < kSingularShare || barred || (ends && status.ok() && !grows)) status = branching(at, found);
        if (grows || (status.failure == Failure::not_converged && !as_one.ok())) status = as_one;
        if (ends || found.share < kSingularShare) break;
      }
    }
    careful_ = false;
    if (status.failure == Failure::not_finite) problem_.set_position(status.time, span(from_.q));  // where to look why
    return status;
  }

  // rad/s, of the body that turns fastest where a part begins; the problem stands there.
  double turn_at(double t) {
    problem_.set_position(t, span(from_.q));
    problem_.set_velocity(span(from_.v));
    return problem_.fastest_turn();
  }

  // A step ends on its position up to the tolerance, which is more than short parts move: from there corrections would
  // not say how sure one may be of them.
  void sharpen_beginning(double at) {
    x_.q = from_.q;
    if (!solver_.find(at, kSharp, true, x_, dq_).ok() || certainty_.has_turned_over()) return;
    from_.take(x_);
  }

  // Charts and rows, in the parts of a step that may turn bodies by far more than serves them.
  Status bring_up_to_date() {
    if (!problem_.has_discrete_state()) return {};
    bool rewritten = false;
    if (Status status = poinsot::accept(problem_, x_, rewritten); !status.ok()) return status;
    return rewritten ? resume() : Status{};
  }

  // Of the rows at (from_.q, from_.v), which all but depend on one another.
  bool choose_others(double at) {
    if (!problem_.choose_rows_here(at, span(from_.q), span(from_.v), {})) return false;
    x_.t = at, x_.q = from_.q, x_.v = from_.v;
    return resume().ok();
  }

  Status branching(double t, const DependentRow& found) const {
    const std::string which = found.row < 0 ? ""
                                            : fmt::format(", where {} depends on the other constraints",
                                                          problem_.describe_unknown(problem_.nv() + found.row));
    const std::string where = fmt::format("at t = {:.9g} s the mechanism comes to a singular position{}", t, which);
    if (found.barred) return {Failure::singular_position, t, fmt::format("{}: {}", where, kBarred)};
    return with_settings(
        with_remedy(Failure::singular_position, t, where + ": its motion can go on in more than one way, or not at all",
                    "end before it, or start beyond it on the branch that is meant"),
        "let analysis dynamics pass it by integrator dop853");
  }

  PrescribedState solver_;
  KinematicCertainty certainty_;
  std::unique_ptr<Consistent> inverse_dynamics_;
  Vector dq_;
  KinematicCertainty::Beginning from_;
  Vector beyond_;  // what lies beyond h v + h²/2 a: as steps before have it, then as this one finds it
  Extrapolation extrapolation_;
  double extrapolates_for_ = 0;  // length of these steps
  double chose_at_ = -1;         // time of the part for which other rows were asked for
  bool careful_ = false;         // in parts of a step
};

}  // namespace

std::unique_ptr<Integrator> make_kinematics() {
  return std::make_unique<FixedStepIntegrator<Kinematics>>();
}

}  // namespace poinsot
