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
#include "integrators/start/rank_told.h"
#include "integrators/start/rough_pose.h"
#include "integrators/start/touching_rows.h"
#include "integrators/start/what_moved.h"
#include "integrators/stepping/consistent.h"

namespace poinsot {
namespace {

// Positions off by more than this part of the mechanism's size are a mistake of the scene rather than its rounding.
constexpr double kNearlyRight = 1e-2;

constexpr double kQuarter = 0.5;  // rad: rows further off may lie on another branch than their residual shows
constexpr double kBranch = 1;     // rad: bodies that turn by more are told

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
    refuse_conflicts(*model_, given_, result_.rank);
    leave_out_touching();
    tell_rank(*model_, result_.rank, result_.notices);
    if (result_.status = refuse_singular_position(model_, given_, result_.rank, settings_.analysis);
        !result_.status.ok())
      return std::move(result_);
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
    if (result_.status.ok()) {
      const WhatMoved moved{model_, scene_, result_.bodies, before_};
      if (off_position() && !closed_) result_.notices.push_back(moved.told_of_pose());
      if (off_velocity()) result_.notices.push_back(moved.told_of_velocities());
    }
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
      refuse_conflicts(*model_, given_, result_.rank);
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

  void leave_out_touching() {
    const bool stuck = result_.rank.singular_position() && !result_.rank.moves_on;
    if (stuck && settings_.analysis == Analysis::dynamics &&
        keeps_touching_rows(model_, given_, result_.rank, settings_))
      set_aside_touching(model_, given_, result_.rank);
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
      ways[b] = {(pose.states[b].r - given_[b].r).norm(), angle_between(given_[b].A, pose.states[b].A)};
    std::vector<std::size_t> order(given_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t b) { return ways[b].largest(); });
    result_.notices.push_back(fmt::format(
        "initial pose assembled: {} was open by {}; {}", describe_group(*model_, group), describe(gap),
        first_few(order, [&](std::size_t b) {
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
    if (!off_position() && !off_velocity() && result_.rank.doubt.row < 0) return {};
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
  if (const std::string length = overflowing_length(*model); !length.empty()) throw InputError(length);
  if (settings.analysis == Analysis::dynamics)
    if (const std::string spin = open_spin(*model); !spin.empty()) throw InputError(spin);
  return Assembler(model, settings, rank).run();
}

}  // namespace poinsot
