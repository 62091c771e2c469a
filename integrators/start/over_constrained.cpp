#include "integrators/start/over_constrained.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kLookedAgain = 1;  // rad, at the latest
constexpr double kShrunk = 0.05;    // of the longest step since the last look: steps may creep up to worn rows

}  // namespace

OverConstrained::OverConstrained(std::unique_ptr<Problem> kept, const std::shared_ptr<const Model>& model,
                                 const RankAnalysis& rank, std::span<const BodyState> states, Steps steps)
    : choice_(std::make_shared<Choice>(Choice{RowChoice(model, rank.loops, rank.aside, steps),
                                              0,
                                              {states.begin(), states.end()},
                                              {.part = AsideWatch::kWorthTelling}})),
      kept_(std::move(kept)),
      to_tolerance_(steps == Steps::of_kinematics),
      now_(states.begin(), states.end()) {
  choice_->rows.look(0, states);
  // Where very many rows are redundant the analysis of rank leaves the others independent, but not as much as can be.
  // In a singular position it does so beside it, and here they are not.
  if (!rank.singular_position() && choice_->rows.worn() && choice_->rows.renew(0, states, HUGE_VAL, 0))
    kept_ = kept_->clone_without(choice_->rows.aside());
  bodies_ = kept_->bodies();
  nq_ = kept_->nq(), nv_ = kept_->nv(), nc_ = kept_->nc();
  no_accelerations_.resize(index(nv_));
  watch();
}

OverConstrained::OverConstrained(const OverConstrained& other)
    : Problem(other),
      choice_(other.choice_),
      kept_revision_(other.kept_revision_),
      kept_(other.kept_->clone()),
      to_tolerance_(other.to_tolerance_),
      t_(other.t_),
      accepted_at_(other.accepted_at_),
      way_(other.way_),
      ahead_(other.ahead_),
      now_(other.now_),
      no_accelerations_(other.no_accelerations_) {
  watch();
}

std::unique_ptr<Problem> OverConstrained::clone() const {
  return std::unique_ptr<Problem>(new OverConstrained(*this));
}

std::vector<Undetermined> OverConstrained::undetermined(double t, std::span<const BodyState> states) const {
  RowChoice& rows = choice_->rows;
  const std::vector<SparseEntries> null_vectors = rows.null_vectors(t, states);
  return undetermined_by(null_vectors, false, model(), rows.space(), states);
}

void OverConstrained::keep() {
  kept_ = kept_->clone_without(choice_->rows.aside());
  kept_revision_ = choice_->revision;
  watch();
}

void OverConstrained::watch() {
  watch_.emplace(*kept_, choice_->rows, to_tolerance_, choice_->apart);
}

LargestResidual OverConstrained::largest_residual() const {
  const LargestResidual kept = kept_->largest_residual(), aside = watch_->left_out(t_);
  return {std::max(kept.position, aside.position), std::max(kept.velocity, aside.velocity)};
}

void OverConstrained::set_position(double t, std::span<const double> q) {
  if (kept_revision_ != choice_->revision) keep();
  kept_->set_position(t, q);
  t_ = t;
  watch_->kept_has_moved();
}

// Since the choice was looked at, rad: by the body that has turned most.
double OverConstrained::turned() const {
  double most = 0;
  for (std::size_t b = 0; b < now_.size(); ++b) most = std::max(most, (now_[b].A - choice_->at[b].A).squaredNorm());
  return 2 * std::asin(std::min(std::sqrt(most / 8), 1.0));  // |A − B|² = 8 sin²(angle/2)
}

OverConstrained::Way OverConstrained::way_to(double t) const {
  const double h = std::max(t - accepted_at_, 0.0), ahead = h * kept_->fastest_turn();
  return {t, h, ahead, way_ + std::max(ahead, ahead_)};
}

// Whether the choice of rows is, at the end of it.
bool OverConstrained::is_looked_at(const Way& way) const {
  const bool creeps = way.h > 0 && way.h < kShrunk * longest_;
  return creeps || way.done + way.ahead >= std::min(choice_->rows.good_for(), kLookedAgain);
}

void OverConstrained::go(const Way& way) {
  accepted_at_ = way.t;
  way_ = way.done;
  ahead_ = way.ahead;
  longest_ = std::max(longest_, way.h);
}

bool OverConstrained::accepts_as_is(double t, std::span<const double> a) {
  const Way way = way_to(t);
  if (watch_->measures_rates() || is_looked_at(way) || !kept_->accepts_as_is(t, a) || !watch_->hold(t)) return false;
  go(way);
  return true;
}

Status OverConstrained::accept(double t, std::span<double> q, std::span<double> v, std::span<double> a,
                               std::span<double> lambda, bool& rewritten) {
  if (Status status = kept_->accept(t, q, v, a, lambda, rewritten); !status.ok()) return status;
  if (rewritten) {
    kept_->set_position(t, q);
    kept_->set_velocity(v);
  }
  if (Status status = watch_->measure(t, a); !status.ok()) return status;
  Way way = way_to(t);
  go(way);
  if (!is_looked_at(way)) return {};
  kept_->to_bodies(a, now_);
  way_ = way.done = turned();
  if (!is_looked_at(way)) return {};
  longest_ = way.h;
  const bool others = choice_->rows.renew(t, now_, std::exchange(way_, 0.0), way.ahead);
  choice_->at = now_;
  if (!others) return {};
  rewritten = true;
  exchange(t, q, v, lambda);
  return {};
}

bool OverConstrained::choose_rows_here(double t, std::span<const double> q, std::span<const double> v,
                                       std::span<double> lambda) {
  kept_->to_bodies(no_accelerations_, now_);
  const bool others = choice_->rows.renew(t_, now_, HUGE_VAL, 0, true);
  choice_->at = now_;
  way_ = 0;
  set_position(t, q);
  set_velocity(v);
  if (others) exchange(t, q, v, lambda);
  return others;
}

// Other rows, and the multipliers that are the same forces.
void OverConstrained::exchange(double t, std::span<const double> q, std::span<const double> v,
                               std::span<double> lambda) {
  std::vector<double> forces(index(nv_)), by_row(model().rows.size(), 0.0);
  const bool wanted = !lambda.empty();  // kinematics may do without
  if (wanted) {
    kept_->constraint_forces(lambda, forces);
    const std::vector<int>& before = kept_->model_rows();
    for (std::size_t k = 0; k < before.size(); ++k) by_row[index(before[k])] = lambda[k];
  }
  ++choice_->revision;
  keep();
  kept_->set_position(t, q);
  kept_->set_velocity(v);
  if (!wanted) return;
  choice_->rows.carry_over(by_row);
  const std::vector<int>& after = kept_->model_rows();
  for (std::size_t k = 0; k < after.size(); ++k) lambda[k] = by_row[index(after[k])];
  normalize(forces, lambda);
}

// The multipliers of rp's normalization rows, one for each body: along them what the rows do is left open by the
// motions that the choice of rows is made for.
void OverConstrained::normalize(std::span<const double> forces, std::span<double> lambda) {
  const std::size_t rows = kept_->model_rows().size(), bodies = lambda.size() - rows;
  if (bodies == 0) return;
  const std::size_t per_body = forces.size() / bodies;
  std::vector<double> now(forces.size()), normal(forces.size()), ones(lambda.size(), 0.0);
  std::ranges::fill(std::span(ones).subspan(rows), 1.0);
  kept_->constraint_forces(lambda, now);
  kept_->constraint_forces(ones, normal);
  for (std::size_t b = 0; b < bodies; ++b) {
    double missing = 0, size = 0;
    for (std::size_t k = b * per_body; k < (b + 1) * per_body; ++k) {
      missing += (forces[k] - now[k]) * normal[k];
      size += normal[k] * normal[k];
    }
    lambda[rows + b] += missing / size;
  }
}

}  // namespace poinsot
