#include "integrators/methods/ida_system.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "integrators/stepping/step_control.h"
#include "integrators/stepping/turning.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// IDA takes a hundred steps where a method of high order takes one, with errors of one sign: it is asked for a tenth of
// the tolerance, so that errors at the end of a run are comparable. Where that is below the rounding of the velocities
// its steps shrink to nothing; then it goes on with the tolerance itself.
constexpr double kShare = 0.1;
// Newton's corrections end below this part of the tolerance. IDA's own third makes more steps fail than it saves.
constexpr double kNewton = 0.1;

void done(int flag) {
  check(flag == IDA_SUCCESS, "IDA accepts what it is given");
}

void keep_silent(int, const char*, const char*, char*, void*) {}

}  // namespace

IdaSystem::IdaSystem(const Run& run, PhaseClock& clock)
    : problem_(run.problem),
      settings_(run.settings),
      form_(std::in_place, problem_),
      system_(problem_, run.systems.add(Workload::solves), run.statistics, clock),
      sizes_(2 * static_cast<std::size_t>(problem_.nv())),
      sizes_now_(sizes_.size()),
      share_(kShare),
      objects_(form_->size(), this, solve) {}

Status IdaSystem::begin(const State& at) {
  if (Status status = system_.prepare(form_->pattern(), form_->unknowns()); !status.ok()) return status;
  form_->start(at, values(objects_.y.get()), values(objects_.y_dot.get()));
  void* ida = objects_.ida.get();
  done(IDAInit(ida, residual, at.t, objects_.y.get(), objects_.y_dot.get()));
  done(IDASetErrHandlerFn(ida, keep_silent, nullptr));
  done(IDASetUserData(ida, this));
  done(IDAWFtolerances(ida, weights));
  done(IDASetLinearSolver(ida, objects_.linear.get(), objects_.matrix.get()));
  done(IDASetJacFn(ida, jacobian));
  done(IDASetNonlinConvCoef(ida, kNewton));
  stop_at(settings_.end);
  return {};
}

void IdaSystem::begin_again(const State& at) {
  form_->start(at, values(objects_.y.get()), values(objects_.y_dot.get()));
  done(IDAReInit(objects_.ida.get(), at.t, objects_.y.get(), objects_.y_dot.get()));
}

Status IdaSystem::renew() {
  form_.emplace(problem_);
  return system_.prepare(form_->pattern(), form_->unknowns());
}

bool IdaSystem::relax() {
  return std::exchange(share_, 1) == 1;
}

bool IdaSystem::step(double& t) {
  return IDASolve(objects_.ida.get(), settings_.end, &t, objects_.y.get(), objects_.y_dot.get(), IDA_ONE_STEP) >= 0;
}

void IdaSystem::stop_at(double t) {
  done(IDASetStopTime(objects_.ida.get(), t));
}

void IdaSystem::turn_at_most(double rate) {
  if (rate > 0) done(IDASetMaxStep(objects_.ida.get(), 0.5 * kMostCounted / rate));
}

double IdaSystem::last_step() const {
  double h = 0;
  IDAGetLastStep(objects_.ida.get(), &h);
  return h;
}

double IdaSystem::next_step() const {
  long steps = 0;
  double h = 0;
  IDAGetNumSteps(objects_.ida.get(), &steps);
  if (steps == 0) return 0;  // begun anew, IDA keeps the one of before
  IDAGetCurrentStep(objects_.ida.get(), &h);
  return h;
}

double IdaSystem::time() const {
  double t = 0;
  IDAGetCurrentTime(objects_.ida.get(), &t);
  return t;
}

void IdaSystem::read(double t, State& at) {
  check(IDAGetDky(objects_.ida.get(), t, 0, objects_.inner.get()) == IDA_SUCCESS,
        "the time lies within IDA's last step");
  copy(objects_.inner.get(), t, at);
}

void IdaSystem::read_end(double t, State& at) {
  copy(objects_.y.get(), t, at);
  std::ranges::copy(form_->v(values(objects_.y_dot.get())), at.a().begin());
}

void IdaSystem::copy(N_Vector y, double t, State& at) const {
  at.t = t;
  std::ranges::copy(form_->q(values(y)), at.q.begin());
  std::ranges::copy(form_->v(values(y)), at.v.begin());
}

void IdaSystem::count(Statistics& statistics) const {
  long newton = 0, error_tests = 0, failures = 0;
  IDAGetNumNonlinSolvIters(objects_.ida.get(), &newton);
  IDAGetNumErrTestFails(objects_.ida.get(), &error_tests);
  IDAGetNumStepSolveFails(objects_.ida.get(), &failures);
  statistics.newton_iterations += newton;
  statistics.rejected_steps += error_tests + failures;
}

// IDA's callbacks: 0 done, 1 not possible here, try a smaller step.
int IdaSystem::residual(double t, N_Vector y, N_Vector y_dot, N_Vector F, void* user) {
  const std::span<double> out = values(F);
  of(user).form_->residual(t, values(y), values(y_dot), out);
  return std::ranges::all_of(out, [](double x) { return std::isfinite(x); }) ? 0 : 1;
}

int IdaSystem::jacobian(double t, double alpha, N_Vector y, N_Vector y_dot, N_Vector, SUNMatrix, void* user, N_Vector,
                        N_Vector, N_Vector) {
  IdaSystem& ida = of(user);
  ida.linear_status_ = ida.system_.refresh(t, [&](std::span<const int> slots, std::span<double> matrix) {
    ida.form_->assemble(t, alpha, values(y), values(y_dot), slots, matrix);
  });
  return ida.linear_status_.ok() ? 0 : 1;
}

int IdaSystem::solve(SUNLinearSolver shell, SUNMatrix, N_Vector x, N_Vector b, double) {
  IdaSystem& ida = of(shell->content);
  std::ranges::copy(values(b), values(x).begin());
  if (!ida.system_.ready()) return SUNLS_LUFACT_FAIL;  // of other rows: asks for the matrix
  ida.linear_status_ = ida.system_.solve(ida.time(), values(x));
  return ida.linear_status_.ok() ? SUNLS_SUCCESS : SUNLS_PACKAGE_FAIL_REC;
}

int IdaSystem::weights(N_Vector y, N_Vector w, void* user) {
  IdaSystem& ida = of(user);
  const std::span<double> out = values(w);
  component_sizes(ida.problem_, ida.form_->q(values(y)), ida.form_->v(values(y)), ida.sizes_now_);
  const double mean = std::sqrt(static_cast<double>(out.size()) / static_cast<double>(ida.sizes_.size()));
  std::ranges::fill(out, 0.0);
  for (std::size_t k = 0; k < ida.sizes_.size(); ++k) {
    ida.sizes_[k] = std::max(ida.sizes_[k], ida.sizes_now_[k]);
    out[k] = mean / (ida.share_ * (ida.settings_.absolute_tolerance() + ida.settings_.rtol * ida.sizes_[k]));
  }
  return 0;
}

}  // namespace poinsot
