#include "integrators/start/what_moved.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/index.h"
#include "core/input_error.h"
#include "core/so3.h"
#include "integrators/start/row_space.h"

namespace poinsot {
namespace {

// A change of points and of turns, m and rad, or of their rates.
struct Change {
  double way = 0, turn = 0;
  void reach(double w, double t) { way = std::max(way, w), turn = std::max(turn, t); }
};

// A row that was off by little asks for much where constraints all but depend on one another: what then satisfies all
// of them is not what was meant.
void refuse_amplified(const WhatMoved& moved, int order, Change by, Change of) {
  constexpr double kSmall = 1e-3;
  if ((by.way <= kSmall * of.way && by.turn <= kSmall * of.turn) || !std::isfinite(by.turn)) return;
  const int row = order == 0 ? moved.before.position_row : moved.before.velocity_row;
  const double off = order == 0 ? moved.before.position : moved.before.velocity;
  RowSpace space(moved.model, {row});
  space.stand(0, moved.from);
  const double metres = std::max(by.way, by.turn * space.own_size_of_row(0));
  if (metres * kIndependent <= off / space.norm_of_row(0)) return;
  const char* const rate = order == 1 ? "/s" : "";
  throw InputError(fmt::format(
      "the initial {} by {}, and to satisfy it takes a change by up to {:.3g} m{} and {:.3g} rad{}: "
      "constraints all but depend on one another there, as those of axes do that are parallel but for their last "
      "digits; write axes and points to more digits, or leave out what says the same twice",
      (order == 0 ? "pose violates " : "velocities violate ") + describe_row(*moved.model, row),
      describe_residual(*moved.model, row, off, order), by.way, rate, by.turn, rate));
}

}  // namespace

double size_of(std::span<const BodyState> states) {
  double size = 1;
  for (const BodyState& state : states) size = std::max(size, state.r.cwiseAbs().maxCoeff());
  return size;
}

std::string WhatMoved::told_of_pose() const {
  Change by;
  std::size_t body = 0;
  for (std::size_t b = 0; b < from.size(); ++b) {
    const double way = (to[b].r - from[b].r).norm(), turn = angle_between(from[b].A, to[b].A);
    if (std::max(way, turn) > std::max(by.way, by.turn)) body = b;
    by.reach(way, turn);
  }
  refuse_amplified(*this, 0, by, {size_of(from), 1});
  return fmt::format(
      "initial pose assembled: {} was violated by {}; the bodies moved by up to {:.3g} m and turned by up to {:.3g} "
      "rad, '{}' most",
      describe_row(*model, before.position_row), describe_residual(*model, before.position_row, before.position, 0),
      by.way, by.turn, model->bodies[body].name);
}

std::string WhatMoved::told_of_velocities() const {
  Change by, of;
  for (std::size_t b = 0; b < from.size(); ++b) {
    by.reach((to[b].rd - from[b].rd).norm(), (to[b].w - from[b].w).norm());
    of.reach(from[b].rd.norm(), from[b].w.norm());
  }
  refuse_amplified(*this, 1, by, of);
  return fmt::format(
      "initial velocities assembled: {} was violated by {}; the velocities changed by up to {:.3g} m/s and {:.3g} "
      "rad/s",
      describe_row(*model, before.velocity_row), describe_residual(*model, before.velocity_row, before.velocity, 1),
      by.way, by.turn);
}

}  // namespace poinsot
