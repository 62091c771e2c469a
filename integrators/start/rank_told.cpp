#include "integrators/start/rank_told.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/index.h"
#include "core/input_error.h"
#include "core/scene_doubts.h"
#include "integrators/start/regular_beside.h"
#include "integrators/start/row_space.h"

namespace poinsot {
namespace {

constexpr const char* kFewDigits = "; where axes and points of few digits are why, write them with 12 or more";

std::string names(const Model& model, const std::vector<int>& rows) {
  return first_few(rows, [&](int row) { return describe_row(model, row); });
}
std::string names(const Model& model, const std::vector<Dependency>& rows) {
  return first_few(rows, [&](const Dependency& d) { return describe_row(model, d.row); });
}

Status stuck(const std::shared_ptr<const Model>& model, std::span<const BodyState> states, const RankAnalysis& rank) {
  if (rank.to_first_order)
    return with_remedy(
        Failure::singular_position, 0,
        fmt::format("the initial pose is a singular position of the mechanism, or near one: singular here: {}; to the "
                    "first order of a motion it follows from the others, and to a higher one it does not, so that no "
                    "velocities say how the motion goes on",
                    names(*model, rank.singular)),
        fmt::format("start beside it, by {:.0e} rad or of the bodies' sizes, or more", 1e-2));
  if (!has_regular_positions_beside(model, states))
    return with_remedy(
        Failure::singular_position, 0,
        fmt::format("the initial pose is a singular position of the mechanism, and so are all found beside it that "
                    "satisfy the constraints: singular here: {}; constraints meet there without crossing, as where a "
                    "length or a cosine is as large or as small as the others let it be, and forbid what no gradient "
                    "shows",
                    names(*model, rank.singular)),
        "write what they amount to by other constraints");
  return with_remedy(
      Failure::singular_position, 0,
      fmt::format("the initial pose is a singular position of the mechanism, or within {:.0e} rad or of the bodies' "
                  "sizes of one, and the initial velocities do not lead away from it: singular here: {}; {}",
                  10 * kIndependent, names(*model, rank.singular),
                  rank.singular.front().others.empty() && rank.singular.size() == 1
                      ? "its gradient vanishes, so that it constrains nothing here"
                      : "what the constraints leave free here and what they leave free beside it differ"),
      fmt::format("start beside it, by {:.0e} or more, or with a velocity along the branch that is meant",
                  100 * kIndependent));
}

// Rates are found from the constraints alone, and are rounding where a row is all but dependent on the others.
bool leaves_rates_open(const Model& model, const RankAnalysis& rank) {
  constexpr double kOpen = 1e-6;
  return rank.singular_position() ||
         (rank.doubt.row >= 0 && rank.doubt.part <= kOpen &&
          !std::ranges::all_of(model.rows, [](const Row& row) { return row.f.is_constant(); }));
}

Status open_to_kinematics(const Model& model, const RankAnalysis& rank) {
  return with_settings(
      with_remedy(
          Failure::singular_position, 0,
          fmt::format("the initial pose is a singular position of the mechanism, where its drivers alone do "
                      "not say how it moves on: singular here: {}",
                      rank.singular_position() ? names(model, rank.singular) : describe_row(model, rank.doubt.row)),
          "start beside it"),
      "with analysis dynamics, which follows the branch that the initial velocities lead to");
}

// Whether a row is off by so little that the numbers of the scene may be rounded by as much.
bool may_be_digits(const Model& model, std::span<const BodyState> states, const Conflict& conflict) {
  constexpr double kLittle = 3e-4;  // of lengths and speeds
  const double arm = longest_arm(model);
  if (conflict.level == Conflict::Level::position || conflict.level == Conflict::Level::later)
    return conflict.by < kLittle * arm;
  double speed = 0;
  for (const BodyState& body : states) speed = std::max(speed, body.rd.norm() + arm * body.w.norm());
  return conflict.by < kLittle * speed;
}

}  // namespace

void tell_rank(const Model& model, const RankAnalysis& rank, std::vector<std::string>& notices) {
  if (!rank.aside.empty())
    notices.push_back(
        fmt::format("{} of {} constraint rows are redundant, they follow from the others; set "
                    "aside, to begin with: {}",
                    rank.aside.size(), model.rows.size(), names(model, rank.aside)));
  if (!rank.touching.empty())
    notices.push_back(fmt::format(
        "along the motion that begins here {} from others to the first order only, and what is forbidden beyond that "
        "shows in no gradient: the run goes on while the motion keeps to it by itself, and stops where it does not",
        names(model, rank.touching) + (rank.touching.size() == 1 ? " follows" : " follow")));
  if (rank.singular_position() && rank.moves_on)
    notices.push_back(
        fmt::format("the initial pose is a singular position of the mechanism: singular here: {}; the run follows "
                    "the branch that the initial velocities lead to, if there is one",
                    names(model, rank.singular)));
  if (rank.doubt.row >= 0 && rank.doubt.few_digits)
    notices.push_back(fmt::format(
        "{} is a combination of the other constraints but for less than {:.0e} of its length: it is kept as "
        "independent, and forbids a motion{}",
        describe_row(model, rank.doubt.row), rank.doubt.part, kFewDigits));
  else if (rank.doubt.row >= 0)
    notices.push_back(fmt::format(
        "{} but for {:.0e} of its length; it is kept as independent, and reactions against it are large: the "
        "mechanism is that near to {}{}",
        rank.doubt.vanishing ? "the gradient of " + describe_row(model, rank.doubt.row) + " has vanished"
                             : describe_row(model, rank.doubt.row) + " is a combination of the other constraints",
        rank.doubt.part, rank.doubt.vanishing ? "a singular position" : "moving, or to being constrained once less",
        rank.doubt.vanishing ? "" : ", as axes and points of few digits leave it"));
  if (rank.degrees_of_freedom() == 0 && !rank.singular_position() && !model.bodies.empty() &&
      std::ranges::all_of(model.rows, [](const Row& row) { return row.f.is_constant(); }))
    notices.push_back("the mechanism has no degree of freedom and no driver: it cannot move");
}

void refuse_conflicts(const Model& model, std::span<const BodyState> states, const RankAnalysis& rank) {
  if (rank.conflicts.empty()) return;
  const Conflict& worst = *std::ranges::max_element(rank.conflicts, {}, &Conflict::by);
  throw InputError(fmt::format(
      "the constraints conflict: with the others satisfied, {} is still violated by {}; `poinsot check` "
      "names what it depends on{}",
      describe_row(model, worst.row), describe(worst), may_be_digits(model, states, worst) ? kFewDigits : ""));
}

Status refuse_singular_position(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                                const RankAnalysis& rank, Analysis analysis) {
  if (analysis == Analysis::kinematics && leaves_rates_open(*model, rank)) return open_to_kinematics(*model, rank);
  return rank.singular_position() && !rank.moves_on ? stuck(model, states, rank) : Status{};
}

}  // namespace poinsot
