#include "integrators/start/touching_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/body_sizes.h"
#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/start/beside.h"
#include "integrators/start/regular_beside.h"
#include "integrators/start/row_choice.h"
#include "integrators/start/row_space.h"
#include "integrators/state.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

constexpr double kWay = 0.1;     // of the bodies' sizes, or rad
constexpr int kParts = 10;       // that it is done in
constexpr double kRests = 1e-6;  // likewise, over the run
constexpr double kHeld = 1e-12;  // of a body's size; what is forbidden to the fourth order is off by kWay⁴ and so

// The largest component, in sizes of bodies and rad. In the intrinsic formulation.
double extent(const Eigen::VectorXd& x, const std::vector<double>& sizes) {
  double most = 0;
  for (std::size_t k = 0; k < index(x.size()); ++k)
    most = std::max(most, std::abs(x[static_cast<Eigen::Index>(k)]) / (k % 6 < 3 ? sizes[k / 6] : 1.0));
  return most;
}

// By one step of second order: what is symmetric in the motion stays so.
Status go_on(Problem& problem, Consistent& consistent, State& at, double h) {
  const auto a = at.z.head(at.v.size());
  Eigen::VectorXd way = h * at.v + (0.5 * h * h) * a, q = at.q;
  problem.retract(span(at.q), span(way), span(q));
  at.t += h;
  at.q = q;
  at.v += h * a;
  if (Status status = consistent.project_position(at.t, span(at.q)); !status.ok()) return status;
  consistent.stand(at);
  if (Status status = consistent.project_velocity(at.t, span(at.v)); !status.ok()) return status;
  consistent.stand(at);
  return consistent.accelerations(at.t, span(at.z));
}

// Whether rows hold at a place beside the states.
bool hold(RowSpace space, std::span<const BodyState> states, double t, std::span<const double> q) {
  space.stand(0, states);
  space.move(t, q);
  std::vector<double> off(space.rows().size());
  space.distances(off);
  for (std::size_t k = 0; k < off.size(); ++k)
    if (!(std::abs(off[k]) <= kHeld * space.own_size_of_row(k))) return false;
  return true;
}

// Whether so many rows of loops follow from others there.
bool follow(RowSpace loops, std::span<const BodyState> states, double t, std::span<const double> q, std::size_t rows) {
  loops.stand(0, states);
  loops.stand_at(t, q);
  return dependent_columns(loops.columns(), kFreeBeside).size() >= rows;
}

}  // namespace

bool keeps_touching_rows(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                         const RankAnalysis& rank, const Settings& settings) {
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, rank.aside_here);
  State state(*problem);
  problem->from_bodies(states, span(state.q), span(state.v));
  Consistent consistent(*problem, settings.linear());
  consistent.stand(state);
  if (!consistent.accelerations(0, span(state.z)).ok()) return false;
  const std::vector<double> sizes = body_sizes(*model);
  const double speed = extent(state.v, sizes), change = extent(state.z.head(problem->nv()), sizes);
  const double end = settings.end;
  if (!(end * (speed + 0.5 * end * change) > kRests)) return !has_regular_positions_beside(model, states);
  const double h = std::min(kWay / speed, std::sqrt(2 * kWay / change)) / kParts;
  for (int k = 0; k < kParts; ++k)
    if (!go_on(*problem, consistent, state, h).ok()) return false;
  return hold(RowSpace(model, rank.aside_here), states, state.t, span(state.q)) &&
         follow(RowSpace(model, rank.loops), states, state.t, span(state.q), rank.aside_here.size());
}

void set_aside_touching(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                        RankAnalysis& rank) {
  rank.touching = std::exchange(rank.singular, {});
  rank.aside = rank.aside_here;
  rank.rank = rank.rank_here;
  rank.to_first_order = false;
  rank.time_beside = 0;
  RowChoice choice(model, rank.loops, rank.aside);
  const std::vector<SparseEntries> null_vectors = choice.null_vectors(0, states);
  rank.undetermined = undetermined_by(null_vectors, !choice.has_null_vectors(), *model, choice.space(), states);
}

}  // namespace poinsot
