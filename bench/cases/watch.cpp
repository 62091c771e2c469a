#include "bench/cases/watch.h"

#include <algorithm>
#include <cmath>

#include "core/conserved_energy.h"

namespace poinsot::cases {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kSameTime = 1e-9;  // relative

}  // namespace

Watch::Watch(const Kept& kept, const std::vector<Column>& columns)
    : kept_(kept), columns_(columns), samples_(columns), seen_(columns.size()) {
  for (std::size_t k = 0; k < columns.size(); ++k) seen_[k].at.reserve(kept.quantities[k].at.size());
  if (kept.errors) recorder_.emplace(motion_);
}

void Watch::observe(const Sample& sample) {
  if (kept_.errors && !model_) model_ = std::make_shared<const Model>(sample.problem.model());
  if (!columns_.empty()) samples_.update(sample);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    Seen& seen = seen_[k];
    seen.last = samples_.value(columns_[k]);
    seen.range.add(seen.last);
    const std::vector<double>& at = kept_.quantities[k].at;
    if (seen.at.size() < at.size() && sample.t >= at[seen.at.size()] * (1 - kSameTime)) seen.at.push_back(seen.last);
  }
  if (kept_.energy_drift) observe_energy(sample);
  if (recorder_) recorder_->add(sample);
  began_ = true;
}

void Watch::observe_energy(const Sample& sample) {
  const Model& model = sample.problem.model();
  const double energy = sample.problem.energy();
  if (!began_) {
    conservative_ = conserves_energy(model);
    energy_ = energy;
    bodies_.resize(model.bodies.size());
  }
  if (!conservative_) return;
  drift_ = std::max(drift_, std::abs(energy - energy_));
  sample.problem.to_bodies(sample.a, bodies_);
  double kinetic = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    kinetic += model.bodies[b].mass * bodies_[b].rd.squaredNorm() / 2 +
               bodies_[b].w.dot(model.bodies[b].inertia * bodies_[b].w) / 2;
  kinetic_ = std::max(kinetic_, kinetic);
}

std::vector<double> Watch::values(const Statistics& s, const study::Reference* reference) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    const Quantity& quantity = kept_.quantities[k];
    const Seen& seen = seen_[k];
    if (quantity.final) values.push_back(seen.last);
    if (quantity.least) values.push_back(seen.range.low);
    if (quantity.greatest) values.push_back(seen.range.high);
    if (quantity.range) values.push_back(seen.range.high - seen.range.low);
    for (std::size_t n = 0; n < quantity.at.size(); ++n) values.push_back(n < seen.at.size() ? seen.at[n] : kMissing);
  }
  if (kept_.errors) {
    study::PerQuantity error;
    error.fill(kMissing);
    if (reference)
      error = study::difference(motion_, reference->motion, study::sizes(reference->motion, *model_), *model_);
    if (reference && model_->rows.empty()) error.back() = kMissing;
    values.insert(values.end(), error.begin(), error.end());
  }
  if (kept_.violation) values.insert(values.end(), {s.violation.position, s.violation.velocity});
  if (kept_.energy_drift)
    values.push_back(conservative_ && s.energy_change ? drift_ / kinetic_ : kMissing);  // none at rest
  if (kept_.counts)
    for (const std::int64_t n : {s.steps, s.newton_iterations, s.factorizations})
      values.push_back(static_cast<double>(n));
  return values;
}

}  // namespace poinsot::cases
