#include "integrators/start/initial_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/index.h"
#include "core/input_error.h"
#include "core/model_faults.h"
#include "core/open_spins.h"
#include "core/scene_doubts.h"
#include "core/so3.h"
#include "formulations/registry.h"
#include "integrators/start/closure.h"
#include "integrators/start/far_bodies.h"
#include "integrators/start/free_of_inertia.h"
#include "integrators/start/rank.h"
#include "integrators/start/regular_beside.h"
#include "integrators/start/rough_pose.h"
#include "integrators/start/row_space.h"
#include "integrators/stepping/consistent.h"

namespace poinsot {
namespace {

constexpr const char* kDigits = "; where axes and points of few digits are why, write them with 12 or more";

// Positions off by more than this part of the mechanism's size are a mistake of the scene rather than its rounding.
constexpr double kNearlyRight = 1e-2;

constexpr double kQuarter = 0.5;  // rad: rows further off may lie on another branch than their residual shows
constexpr double kBranch = 1;     // rad: bodies that turn by more are told

double turn_between(const Matrix3& from, const Matrix3& to) {
  return 2 * std::asin(std::min(1.0, (to - from).norm() / std::sqrt(8.0)));
}

double size_of(const std::vector<BodyState>& states) {
  double size = 1;
  for (const BodyState& state : states) size = std::max(size, state.r.cwiseAbs().maxCoeff());
  return size;
}

class Assembler {
 public:
  Assembler(const std::shared_ptr<const Model>& model, const Settings& settings, const RankAnalysis* rank)
      : model_(model), settings_(settings), known_(rank), scene_(given_state(*model)), given_(scene_) {}

  InitialState run() {
    tell_far_joints(*model_, result_.notices);
    tell_far_bodies(*model_, result_.notices);
    before_ = violation(model_, given_);
    close_from_afar();
    refuse_any();
    close_from_nearby();
    result_.bodies = given_;
    result_.rank = known_ && !moved_ ? *known_ : analyze_rank(model_, given_, RankNames::none);
    refuse_conflicts();
    tell_rank();
    if (settings_.analysis == Analysis::kinematics && leaves_rates_open()) {
      result_.status = open_to_kinematics();
      return std::move(result_);
    }
    if (result_.rank.singular_position() && !result_.rank.moves_on) {
      result_.status = stuck();
      return std::move(result_);
    }
    if (settings_.analysis == Analysis::dynamics) {
      if (result_.status = refuse_motion_free_of_inertia(model_, given_); !result_.status.ok())
        return std::move(result_);
    }
    result_.status = project();
    if (result_.status.failure == Failure::inconsistent_state) {
      throw InputError(
          fmt::format("the constraints cannot be satisfied together near the given pose; the largest "
                      "violation is that of {}; `poinsot check` names conflicting constraints",
                      describe_row(*model_, before_.position_row)));
    }
    if (result_.status.ok()) tell_what_moved();
    return std::move(result_);
  }

 private:
  bool off_position() const { return before_.position > kSatisfied; }
  bool off_velocity() const { return before_.velocity > kSatisfied; }

  // Under Assembly::never.
  void refuse_any() const {
    if (settings_.assembly != Assembly::never || !(off_position() || off_velocity())) return;
    const bool position = off_position();
    const int row = position ? before_.position_row : before_.velocity_row;
    const double by = position ? before_.position : before_.velocity;
    throw InputError(fmt::format("the initial {} violates {} by {}; allowed with --no-assemble: {:.0e}",
                                 position ? "pose" : "velocity", describe_row(*model_, row),
                                 describe_residual(*model_, row, by, position ? 0 : 1), kSatisfied));
  }

  // A pose far from the constraints is closed first where the scene or the settings ask for it, or refused.
  void close_from_afar() {
    const std::vector<Gap> open = gaps(*model_, given_);
    const auto most = std::ranges::max_element(open, {}, &Gap::largest);
    const double limit = kNearlyRight * size_of(given_);
    if (open.empty() || (most->metres <= limit && most->radians <= std::min(limit, kQuarter))) return;
    const int group = static_cast<int>(most - open.begin());
    const bool rough = std::ranges::any_of(model_->groups, &Group::body_fixed);
    if (settings_.assembly == Assembly::never || (settings_.assembly == Assembly::small && !rough))
      throw InputError(far_message(group, *most, limit));
    const ClosedPose pose = close_mechanism(*model_, given_);
    if (!pose.closed) {
      result_.rank = analyze_rank(model_, given_, RankNames::none);
      refuse_conflicts();
      throw InputError(fmt::format(
          "no position near the given pose closes the mechanism: {} stays open by {}, at the given pose {} is by {}; "
          "correct it, or start from a pose nearer to the one meant; `poinsot check` names conflicting constraints",
          describe_group(*model_, pose.worst), describe(pose.gap), describe_group(*model_, group), describe(*most)));
    }
    closed_ = moved_ = true;
    tell_closed(pose, group, *most);
    given_ = pose.states;
    before_ = violation(model_, given_);
  }

  // Off the constraints rows that follow from others look independent. Scenes too large for it are written by programs,
  // to all digits.
  void close_from_nearby() {
    if (closed_ || !off_position() || given_.size() > kMostClosed) return;
    ClosedPose pose = close_mechanism(*model_, given_);
    if (!pose.closed || pose.from_beside) return;
    moved_ = true;
    given_ = std::move(pose.states);
  }

  std::string far_message(int group, const Gap& gap, double limit) const {
    const Row& row = model_->rows[index(model_->groups[index(group)].first_row)];
    if (row.type == RowType::angle) {
      const std::vector<OpenPart> parts = open_parts(*model_, given_);
      const double asked = row.f.at(0.0).f, off = std::ranges::find(parts, group, &OpenPart::group)->value;
      return fmt::format(
          "{} asks for an angle of {:.6g} rad at t = 0, where the initial pose has {:.6g} rad; correct the scene, or "
          "have it turned there with `poinsot run --assemble`, whose --save-state keeps it",
          describe_group(*model_, group), asked, asked + off);
    }
    return fmt::format(
        "the initial pose violates {} by {}, more than the {:.3g} {} that is put right unasked; correct the scene, "
        "or have it projected onto the constraints with `poinsot run --assemble`, whose --save-state keeps it",
        describe_group(*model_, group), describe(gap), gap.metres > limit ? limit : std::min(limit, kQuarter),
        gap.metres > limit ? "m" : "rad");
  }

  // The way each body was moved.
  void tell_closed(const ClosedPose& pose, int group, const Gap& gap) {
    std::vector<Gap> ways(given_.size());
    for (std::size_t b = 0; b < given_.size(); ++b)
      ways[b] = {(pose.states[b].r - given_[b].r).norm(), turn_between(given_[b].A, pose.states[b].A)};
    std::vector<std::size_t> order(given_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t b) { return ways[b].largest(); });
    result_.notices.push_back(fmt::format(
        "initial pose assembled: {} was open by {}; {}", describe_group(*model_, group), describe(gap),
        listed(order, [&](std::size_t b) {
          return fmt::format("'{}' {}", model_->bodies[b].name, describe(ways[b], "moved by ", "turned by "));
        })));
    if (pose.from_beside)
      result_.notices.push_back(
          "the given pose is a singular one, from which the constraints can be closed in several ways, and one was "
          "taken; start nearer to the one that is meant");
    else if (const auto most = std::ranges::max_element(ways, {}, &Gap::radians); most->radians > kBranch)
      result_.notices.push_back(fmt::format(
          "body '{}' had to turn by {:.3g} rad: on so long a way there can be other positions that close the "
          "mechanism; if another is meant, start nearer to it",
          model_->bodies[index(most - ways.begin())].name, most->radians));
  }

  // Position and velocity where they are off. Beside a singular position rows that all but hold leave velocities far
  // off.
  Status project() {
    if (!off_position() && !off_velocity() && result_.rank.doubtful < 0) return {};
    const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model_, result_.rank.aside_here);
    std::vector<double> q(index(problem->nq())), v(index(problem->nv()));
    problem->from_bodies(given_, q, v);
    Consistent consistent(*problem, settings_.linear());
    if (off_position()) {
      if (Status status = consistent.project_position(0, q); !status.ok()) return status;
    }
    problem->set_position(0, q);
    problem->set_velocity(v);
    // a moved pose moves G, and the velocities with it
    if (Status status = consistent.project_velocity(0, v); !status.ok()) return status;
    problem->to_bodies(std::vector<double>(v.size(), 0.0), result_.bodies);
    return {};
  }

  // The first few rows, and what there is to say of each.
  template <class List, class Say>
  std::string listed(const List& all, Say&& say) const {
    constexpr std::size_t kMost = 6;
    std::string text;
    for (std::size_t k = 0; k < all.size() && k < kMost; ++k) text += (k ? ", " : "") + say(all[k]);
    return all.size() > kMost ? text + ", ..." : text;
  }
  std::string names(const std::vector<int>& rows) const {
    return listed(rows, [&](int row) { return describe_row(*model_, row); });
  }
  std::string names(const std::vector<Dependency>& rows) const {
    return listed(rows, [&](const Dependency& d) { return describe_row(*model_, d.row); });
  }

  void tell_rank() {
    const RankAnalysis& rank = result_.rank;
    if (!rank.aside.empty())
      result_.notices.push_back(
          fmt::format("{} of {} constraint rows are redundant, they follow from the others; set "
                      "aside, to begin with: {}",
                      rank.aside.size(), model_->rows.size(), names(rank.aside)));
    if (rank.singular_position() && rank.moves_on)
      result_.notices.push_back(
          fmt::format("the initial pose is a singular position of the mechanism: singular here: {}; the run follows "
                      "the branch that the initial velocities lead to, if there is one",
                      names(rank.singular)));
    if (rank.doubtful >= 0 && rank.few_digits)
      result_.notices.push_back(fmt::format(
          "{} is a combination of the other constraints but for less than {:.0e} of its length: it is kept as "
          "independent, and forbids a motion{}",
          describe_row(*model_, rank.doubtful), rank.doubt, kDigits));
    else if (rank.doubtful >= 0)
      result_.notices.push_back(fmt::format(
          "{} but for {:.0e} of its length; it is kept as independent, and reactions against it are large: the "
          "mechanism is that near to {}{}",
          rank.vanishing ? "the gradient of " + describe_row(*model_, rank.doubtful) + " has vanished"
                         : describe_row(*model_, rank.doubtful) + " is a combination of the other constraints",
          rank.doubt, rank.vanishing ? "a singular position" : "moving, or to being constrained once less",
          rank.vanishing ? "" : ", as axes and points of few digits leave it"));
    if (rank.degrees_of_freedom() == 0 && !rank.singular_position() && !model_->bodies.empty() &&
        std::ranges::all_of(model_->rows, [](const Row& row) { return row.f.is_constant(); }))
      result_.notices.push_back("the mechanism has no degree of freedom and no driver: it cannot move");
  }

  Status stuck() const {
    const RankAnalysis& rank = result_.rank;
    if (rank.to_first_order)
      return with_remedy(
          Failure::singular_position, 0,
          fmt::format(
              "the initial pose is a singular position of the mechanism, or near one: singular here: {}; to the "
              "first order of a motion it follows from the others, and to a higher one it does not, so that no "
              "velocities say how the motion goes on",
              names(rank.singular)),
          fmt::format("start beside it, by {:.0e} rad or of the bodies' sizes, or more", 1e-2));
    if (!has_regular_positions_beside(model_, given_))
      return with_remedy(
          Failure::singular_position, 0,
          fmt::format("the initial pose is a singular position of the mechanism, and so are all found beside it that "
                      "satisfy the constraints: singular here: {}; constraints meet there without crossing, as where a "
                      "length or a cosine is as large or as small as the others let it be, and forbid what no gradient "
                      "shows",
                      names(rank.singular)),
          "write what they amount to by other constraints");
    return with_remedy(
        Failure::singular_position, 0,
        fmt::format("the initial pose is a singular position of the mechanism, or within {:.0e} rad or of the bodies' "
                    "sizes of one, and the initial velocities do not lead away from it: singular here: {}; {}",
                    10 * kIndependent, names(rank.singular),
                    rank.singular.front().others.empty() && rank.singular.size() == 1
                        ? "its gradient vanishes, so that it constrains nothing here"
                        : "what the constraints leave free here and what they leave free beside it differ"),
        fmt::format("start beside it, by {:.0e} or more, or with a velocity along the branch that is meant",
                    100 * kIndependent));
  }

  // Rates are found from the constraints alone, and are rounding where a row is all but dependent on the others.
  bool leaves_rates_open() const {
    constexpr double kOpen = 1e-6;
    const RankAnalysis& rank = result_.rank;
    return rank.singular_position() ||
           (rank.doubtful >= 0 && rank.doubt <= kOpen &&
            !std::ranges::all_of(model_->rows, [](const Row& row) { return row.f.is_constant(); }));
  }
  Status open_to_kinematics() const {
    const RankAnalysis& rank = result_.rank;
    return with_settings(
        with_remedy(Failure::singular_position, 0,
                    fmt::format("the initial pose is a singular position of the mechanism, where its drivers alone do "
                                "not say how it moves on: singular here: {}",
                                rank.singular_position() ? names(rank.singular) : describe_row(*model_, rank.doubtful)),
                    "start beside it"),
        "with analysis dynamics, which follows the branch that the initial velocities lead to");
  }

  // Redundant rows must hold where the others do.
  void refuse_conflicts() const {
    if (result_.rank.conflicts.empty()) return;
    const Conflict& worst = *std::ranges::max_element(result_.rank.conflicts, {}, &Conflict::by);
    throw InputError(
        fmt::format("the constraints conflict: with the others satisfied, {} is still violated by {}; `poinsot check` "
                    "names what it depends on{}",
                    describe_row(*model_, worst.row), describe(worst), may_be_digits(worst) ? kDigits : ""));
  }
  // Whether a row is off by so little that the numbers of the scene may be rounded by as much.
  bool may_be_digits(const Conflict& conflict) const {
    constexpr double kLittle = 3e-4;  // of lengths and speeds
    const double arm = longest_arm(*model_);
    if (conflict.level == Conflict::Level::position || conflict.level == Conflict::Level::later)
      return conflict.by < kLittle * arm;
    double speed = 0;
    for (const BodyState& body : given_) speed = std::max(speed, body.rd.norm() + arm * body.w.norm());
    return conflict.by < kLittle * speed;
  }

  void tell_what_moved() {
    double moved = 0, turned = 0, velocity = 0, spin = 0, speed = 0, rate = 0;
    std::size_t body = 0;
    for (std::size_t b = 0; b < given_.size(); ++b) {
      const BodyState &x = scene_[b], &y = result_.bodies[b];
      const double dr = (y.r - x.r).norm();
      const double turn = turn_between(x.A, y.A);
      if (std::max(dr, turn) > std::max(moved, turned)) body = b;
      moved = std::max(moved, dr);
      turned = std::max(turned, turn);
      velocity = std::max(velocity, (y.rd - x.rd).norm());
      spin = std::max(spin, (y.w - x.w).norm());
      speed = std::max(speed, x.rd.norm());
      rate = std::max(rate, x.w.norm());
    }
    if (off_position() && !closed_) {
      refuse_amplified("pose", before_.position_row, before_.position, 0, {moved, turned}, {size_of(scene_), 1});
      result_.notices.push_back(
          fmt::format("initial pose assembled: {} was violated by {}; the bodies moved by up to {:.3g} m and turned "
                      "by up to {:.3g} rad, '{}' most",
                      describe_row(*model_, before_.position_row),
                      describe_residual(*model_, before_.position_row, before_.position, 0), moved, turned,
                      model_->bodies[body].name));
    }
    if (off_velocity()) {
      refuse_amplified("velocities", before_.velocity_row, before_.velocity, 1, {velocity, spin}, {speed, rate});
      result_.notices.push_back(
          fmt::format("initial velocities assembled: {} was violated by {}; the velocities "
                      "changed by up to {:.3g} m/s and {:.3g} rad/s",
                      describe_row(*model_, before_.velocity_row),
                      describe_residual(*model_, before_.velocity_row, before_.velocity, 1), velocity, spin));
    }
  }

  // A change of points and of turns.
  struct Change {
    double way, turn;
  };
  // Where constraints all but depend on one another the least that a row is off asks for much: what then satisfies all
  // of them is not what was meant.
  void refuse_amplified(const char* what, int row, double off, int order, Change by, Change of) const {
    constexpr double kSmall = 1e-3;
    if ((by.way <= kSmall * of.way && by.turn <= kSmall * of.turn) || !std::isfinite(by.turn)) return;
    RowSpace space(model_, {row});
    space.stand(0, scene_);
    const double metres = std::max(by.way, by.turn * space.own_size_of_row(0));
    if (metres * kIndependent <= off / space.norm_of_row(0)) return;
    const char* const rate = order == 1 ? "/s" : "";
    throw InputError(fmt::format(
        "the initial {} violate{} {} by {}, and to satisfy it takes a change by up to {:.3g} m{} and {:.3g} rad{}: "
        "constraints all but depend on one another there, as those of axes do that are parallel but for their last "
        "digits; write axes and points to more digits, or leave out what says the same twice",
        what, order == 1 ? "" : "s", describe_row(*model_, row), describe_residual(*model_, row, off, order), by.way,
        rate, by.turn, rate));
  }

  std::shared_ptr<const Model> model_;
  const Settings& settings_;
  const RankAnalysis* known_;           // null where it is not; of the given state
  const std::vector<BodyState> scene_;  // the given state
  std::vector<BodyState> given_;        // or what that was closed to
  bool closed_ = false;                 // from afar
  bool moved_ = false;                  // from wherever
  Violation before_;
  InitialState result_;
};

}  // namespace

InitialState find_initial_state(const std::shared_ptr<const Model>& model, const Settings& settings,
                                const RankAnalysis* rank) {
  if (const std::string fault = fault_of_functions(*model, 0); !fault.empty()) return {no_value(0, fault), {}, {}, {}};
  if (const std::string beyond = beyond_any_position(*model, 0, 0); !beyond.empty())
    throw InputError(beyond + ", which no position has");
  if (const std::string length = overflowing_length(*model); !length.empty())
    throw InputError(length + "; give it in units in which it is smaller");
  if (settings.analysis == Analysis::dynamics)
    if (const std::string spin = open_spin(*model); !spin.empty()) throw InputError(spin);
  return Assembler(model, settings, rank).run();
}

}  // namespace poinsot
