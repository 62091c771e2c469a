#include "integrators/start/initial_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/input_error.h"
#include "core/model_faults.h"
#include "core/so3.h"
#include "formulations/registry.h"
#include "integrators/start/rank.h"
#include "integrators/stepping/consistent.h"

namespace poinsot {
namespace {

// Positions off by more than this part of the mechanism's size are a mistake of the scene rather than its rounding.
constexpr double kNearlyRight = 1e-2;

double size_of(const std::vector<BodyState>& states) {
  double size = 1;
  for (const BodyState& state : states) size = std::max(size, state.r.cwiseAbs().maxCoeff());
  return size;
}

class Assembler {
 public:
  Assembler(const std::shared_ptr<const Model>& model, const Settings& settings)
      : model_(model), settings_(settings), given_(given_state(*model)) {}

  InitialState run() {
    result_.bodies = given_;
    before_ = violation(model_, given_);
    refuse_if_far();
    result_.rank = analyze_rank(model_, given_, RankNames::none);
    refuse_conflicts();
    tell_rank();
    if (result_.rank.singular_position() && !result_.rank.moves_on) {
      result_.status = stuck();
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
  const std::vector<int>& kept_out() const { return result_.rank.aside_here; }
  bool off_position() const { return before_.position > kSatisfied; }
  bool off_velocity() const { return before_.velocity > kSatisfied; }

  void refuse_if_far() const {
    if (settings_.assembly == Assembly::never && (off_position() || off_velocity())) {
      const bool position = off_position();
      throw InputError(fmt::format("the initial {} violates {} by {:.3g}; allowed with --no-assemble: {:.0e}",
                                   position ? "pose" : "velocity",
                                   describe_row(*model_, position ? before_.position_row : before_.velocity_row),
                                   position ? before_.position : before_.velocity, kSatisfied));
    }
    const double limit = kNearlyRight * size_of(given_);
    if (settings_.assembly == Assembly::small && before_.position > limit) {
      throw InputError(
          fmt::format("the initial pose violates {} by {:.3g}, more than the {:.3g} that is put right "
                      "unasked; correct the scene, or have it projected onto the constraints with --assemble",
                      describe_row(*model_, before_.position_row), before_.position, limit));
    }
  }

  // Position and velocity where they are off.
  Status project() {
    if (!off_position() && !off_velocity()) return {};
    const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model_, kept_out());
    std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
    check(problem->from_bodies(given_, q, v).ok(), "rA represents every orientation");
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
                      "the branch that the initial velocities lead to",
                      names(rank.singular)));
    if (rank.doubtful >= 0)
      result_.notices.push_back(fmt::format(
          "{} is a combination of the other constraints but for {:.0e} of its length; it is kept as independent, and "
          "reactions against it are large: the mechanism is that near to moving, or to being constrained once less",
          describe_row(*model_, rank.doubtful), rank.doubt));
    if (rank.degrees_of_freedom() == 0 && !model_->bodies.empty() &&
        std::ranges::all_of(model_->rows, [](const Row& row) { return row.f.is_constant(); }))
      result_.notices.push_back("the mechanism has no degree of freedom and no driver: it cannot move");
  }

  Status stuck() const {
    const RankAnalysis& rank = result_.rank;
    return {Failure::singular_position, 0,
            fmt::format("the initial pose is a singular position of the mechanism, and the initial velocities do not "
                        "lead away from it: singular here: {}; {}; start beside it, or with a velocity along the "
                        "branch that is meant",
                        names(rank.singular),
                        rank.singular.front().others.empty() && rank.singular.size() == 1
                            ? "its gradient vanishes, so that it constrains nothing here"
                            : "what the constraints leave free here and what they leave free beside it differ")};
  }

  // Redundant rows must hold where the others do.
  void refuse_conflicts() const {
    if (result_.rank.conflicts.empty()) return;
    const auto size = [](const Conflict& c) { return c.by; };
    const Conflict& worst = *std::ranges::max_element(result_.rank.conflicts, {}, size);
    throw InputError(
        fmt::format("the constraints conflict: with the others satisfied, {} is still violated by {}; `poinsot check` "
                    "names what it depends on",
                    describe_row(*model_, worst.row), describe(worst)));
  }

  void tell_what_moved() {
    double moved = 0, turned = 0, velocity = 0, spin = 0;
    std::size_t body = 0;
    for (std::size_t b = 0; b < given_.size(); ++b) {
      const BodyState &x = given_[b], &y = result_.bodies[b];
      const double dr = (y.r - x.r).norm();
      const double turn = 2 * std::asin(std::min(1.0, (y.A - x.A).norm() / std::sqrt(8.0)));
      if (std::max(dr, turn) > std::max(moved, turned)) body = b;
      moved = std::max(moved, dr);
      turned = std::max(turned, turn);
      velocity = std::max(velocity, (y.rd - x.rd).norm());
      spin = std::max(spin, (y.w - x.w).norm());
    }
    if (off_position()) {
      result_.notices.push_back(fmt::format(
          "initial pose assembled: {} was violated by {:.3g}; the bodies moved by up to {:.3g} m and turned "
          "by up to {:.3g} rad, '{}' most",
          describe_row(*model_, before_.position_row), before_.position, moved, turned, model_->bodies[body].name));
    }
    if (off_velocity()) {
      result_.notices.push_back(
          fmt::format("initial velocities assembled: {} was violated by {:.3g}; the velocities "
                      "changed by up to {:.3g} m/s and {:.3g} rad/s",
                      describe_row(*model_, before_.velocity_row), before_.velocity, velocity, spin));
    }
  }

  std::shared_ptr<const Model> model_;
  const Settings& settings_;
  std::vector<BodyState> given_;
  Violation before_;
  InitialState result_;
};

}  // namespace

std::vector<BodyState> given_state(const Model& model) {
  std::vector<BodyState> states;
  for (const Body& body : model.bodies) {
    BodyState state;
    state.r = body.position;
    state.A = body.orientation;
    state.rd = body.velocity;
    state.w = body.angular_velocity;
    states.push_back(state);
  }
  return states;
}

Violation violation(const std::shared_ptr<const Model>& model, const std::vector<BodyState>& states) {
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, {});
  std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
  check(problem->from_bodies(states, q, v).ok(), "rA represents every orientation");
  problem->set_position(0, q);
  problem->set_velocity(v);
  std::vector<double> r(static_cast<std::size_t>(problem->nc()));
  Violation largest;
  problem->position_residual(r);
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (!(std::abs(r[k]) <= largest.position)) {
      largest.position = std::abs(r[k]);
      largest.position_row = static_cast<int>(k);
    }
  }
  problem->velocity_residual(r);
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (!(std::abs(r[k]) <= largest.velocity)) {
      largest.velocity = std::abs(r[k]);
      largest.velocity_row = static_cast<int>(k);
    }
  }
  return largest;
}

InitialState find_initial_state(const std::shared_ptr<const Model>& model, const Settings& settings) {
  if (const std::string fault = fault_of_functions(*model, 0); !fault.empty()) {
    InitialState none;
    none.status = no_value(0, fault);
    return none;
  }
  return Assembler(model, settings).run();
}

}  // namespace poinsot
