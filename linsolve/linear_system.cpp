#include "linsolve/linear_system.h"

#include <algorithm>
#include <utility>

namespace poinsot {
namespace {

void add(const LinearWork& one, std::vector<LinearWork>& work) {
  if (one.factorizations + one.refactorizations == 0) return;
  const auto same = std::ranges::find_if(work, [&](const LinearWork& w) {
    return w.solver == one.solver && w.system == one.system && w.handed_over_by == one.handed_over_by;
  });
  if (same == work.end()) {
    work.push_back(one);
    return;
  }
  LinearWork& sum = *same;
  sum.factorizations += one.factorizations;
  sum.refactorizations += one.refactorizations;
  sum.solves += one.solves;
  sum.refinements += one.refinements;
  if (one.reciprocal_condition > 0 &&
      (sum.reciprocal_condition == 0 || one.reciprocal_condition < sum.reciprocal_condition))
    sum.reciprocal_condition = one.reciprocal_condition;
}

LinearWork work_of(std::string_view solver, std::string_view system, std::string_view handed_over_by,
                   const LinearStatistics& did) {
  return {solver,     system,          handed_over_by,          did.factorizations, did.refactorizations,
          did.solves, did.refinements, did.reciprocal_condition};
}

void add(std::string_view name, const LinearSolver& solver, std::string_view system, std::vector<LinearWork>& work) {
  if (!solver.picked().empty()) name = solver.picked();
  LinearStatistics own = solver.statistics();
  if (const LinearSolver::Helper helper = solver.helper(); helper.solver) {
    own.solves -= helper.solver->statistics().solves;
    add(work_of(helper.name, system, name, helper.solver->statistics()), work);
  }
  add(work_of(name, system, {}, own), work);
}

}  // namespace

LinearSystem::LinearSystem(const LinearChoice& choice, Workload workload)
    : solver_(&linear_solvers().require(choice.solver)), workload_(workload) {
  may_reduce_ = linear_systems().require(choice.system).square_jacobian && solver_->takes_jacobian;
}

LinearStatus LinearSystem::analyze(Pattern pattern) {
  constexpr int kSmall = 20'000;  // unknowns
  const bool served = std::exchange(factored_, false) && !(whole_ && whole_->helper().solver);
  if (served && pattern == pattern_) return {};
  let_go();
  if (pattern.n <= kSmall) pattern_ = pattern;
  LinearStatus status = analyze_anew(std::move(pattern));
  if (!jacobian_ && !status.ok()) pattern_ = {};
  return status;
}

LinearStatus LinearSystem::analyze_anew(Pattern&& pattern) {
  if (may_reduce_ && SquareJacobian::fits(pattern)) {
    auto jacobian = std::make_unique<SquareJacobian>(solver_->make());
    if (jacobian->analyze(pattern)) {
      jacobian_ = std::move(jacobian);
      pattern_ = std::move(pattern);
      return {};
    }
  }
  whole_ = solver_->make();
  return whole_->analyze(std::move(pattern), workload_);
}

LinearStatus LinearSystem::factor(Ahead ahead) {
  LinearStatus status = factor_at_hand(ahead);
  factored_ = status.ok();
  return status;
}

LinearStatus LinearSystem::factor_at_hand(Ahead ahead) {
  if (!jacobian_) return whole_->factor(ahead);
  by_jacobian_ = jacobian_->take_values();
  return by_jacobian_ ? jacobian_->factor() : factor_whole_instead();
}

// For values that have not the form, though their places have.
LinearStatus LinearSystem::factor_whole_instead() {
  if (!whole_) {
    whole_ = solver_->make();
    if (LinearStatus status = whole_->analyze(pattern_, workload_); !status.ok()) return status;
  }
  std::ranges::fill(whole_->values(), 0.0);
  std::size_t column = 0;
  for (const Block& b : pattern_.blocks)
    for (int c = 0; c < b.cols; ++c, ++column)
      std::copy_n(jacobian_->values().data() + jacobian_->slots()[column], b.rows,
                  whole_->values().data() + whole_->slots()[column]);
  return whole_->factor();
}

void LinearSystem::add_work(std::vector<LinearWork>& work) const {
  for (const LinearWork& before : past_) add(before, work);
  if (jacobian_) add(solver_->name, jacobian_->solver(), "G", work);
  if (whole_) add(solver_->name, *whole_, "whole", work);
}

void LinearSystem::let_go() {
  std::vector<LinearWork> all;
  add_work(all);
  past_.swap(all);
  whole_.reset(), jacobian_.reset();
  pattern_ = {};
  by_jacobian_ = factored_ = false;
}

LinearSystem& LinearSystems::add(Workload workload) {
  return *systems_.emplace_back(std::make_unique<LinearSystem>(choice_, workload));
}

void LinearSystems::let_go() {
  for (const auto& system : systems_) system->let_go();
}

std::vector<LinearWork> LinearSystems::work() const {
  std::vector<LinearWork> work;
  for (const auto& system : systems_) system->add_work(work);
  std::ranges::stable_sort(work, std::ranges::greater(),
                           [](const LinearWork& w) { return w.factorizations + w.refactorizations; });
  return work;
}

}  // namespace poinsot
