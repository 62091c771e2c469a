#include "bench/study/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include "formulations/registry.h"
#include "linsolve/registry.h"

namespace poinsot::study {
namespace {

constexpr double kLongest = 2;       // s, of a run while nothing reaches the accuracy,
constexpr double kInVain = 0.1;      // s, where the reference cannot tell whether it does
constexpr double kHopeless = 10;     // times the best so far: not followed further,
constexpr double kNoise = 0.01;      // s, unless it is short
constexpr double kMuchFaster = 0.9;  // another linear solver has to be faster than the usual one by more than noise
constexpr int kFinalists = 8, kRepetitions = 7;

class Search {
 public:
  Search(const Sweep& sweep, const Reference& reference, const Asked& asked)
      : sweep_(sweep), reference_(reference), asked_(asked) {}

  void by_tolerance(const std::string& formulation, const IntegratorEntry& integrator) {
    const auto rtol = [](int k) { return (k % 2 ? 3 : 1) / std::pow(10, (k + 1) / 2); };  // 1e-2, 3e-3, 1e-3, ...
    constexpr int loosest = 4, tightest = 26;
    std::map<int, bool> tried;
    const auto reaches = [&](int k) { return tried[k] = run(sweep_.make_case(formulation, integrator, 0, rtol(k))); };
    int k = std::clamp(static_cast<int>(std::ceil(-2 * std::log10(asked_.accuracy))), loosest, tightest);
    for (int runs = 0; !reaches(k); ++runs) {
      if (k == tightest || runs == 8 || last_.seconds > limit()) return close();
      const double missing = std::log10(error_of(last_) / asked_.accuracy);
      k = std::min(k + (std::isfinite(missing) ? std::clamp(static_cast<int>(2 * missing), 1, 8) : 1), tightest);
    }
    while (k > loosest && !tried.contains(k - 1) && reaches(k - 1)) --k;
    close();
  }

  void by_step(const std::string& formulation, const IntegratorEntry& integrator) {
    const auto reaches = [&](int steps) { return run(sweep_.make_case(formulation, integrator, steps, 0)); };
    int steps = 5 * kOutputs;
    for (int runs = 0; !reaches(steps); ++runs) {
      const double missing = error_of(last_) / asked_.accuracy;
      double factor = std::isfinite(missing) ? 1.1 * std::pow(missing, 1.0 / std::max(integrator.order, 1)) : 3;
      // Far from the accuracy the order does not show yet.
      factor = std::clamp(factor, 1.2, runs == 0 ? 10.0 : 1e4);
      const double seconds = last_.ok() ? last_.seconds * factor : 0;
      if (runs == 8 || seconds > limit() || steps * factor > 1e8) return close();
      steps = kOutputs * static_cast<int>(std::ceil(steps * factor / kOutputs));
    }
    while (steps > kOutputs && steps <= 5 * kOutputs && reaches(steps / 2 / kOutputs * kOutputs))
      steps = steps / 2 / kOutputs * kOutputs;
    close();
  }

  Calibration result() {
    std::ranges::sort(found_.reaching, {}, seconds_of);
    std::ranges::sort(found_.others, {}, [&](const Candidate& c) { return error_of(c.measured); });
    if (found_.reaching.empty()) return found_;
    const auto finalists = std::min<std::size_t>(kFinalists, found_.reaching.size());
    time(found_.reaching, finalists);
    std::ranges::sort(std::span(found_.reaching).first(finalists), {}, seconds_of);
    choose_solver();
    return found_;
  }

 private:
  // Whether the case reaches the accuracy; kept as its method's best where it is.
  bool run(const Case& one) {
    last_ = sweep_.compare(one);
    const bool reached = reached_by(last_);
    if (reached && (!reaching_ || last_.seconds < reaching_->measured.seconds)) reaching_ = {one, last_};
    if (!nearest_ || error_of(last_) < error_of(nearest_->measured)) nearest_ = {one, last_};
    return reached;
  }

  // The method is done.
  void close() {
    if (reaching_) {
      best_ = std::min(best_, reaching_->measured.seconds);
      found_.reaching.push_back(*reaching_);
    } else if (nearest_) {
      found_.others.push_back(*nearest_);
    }
    reaching_.reset();
    nearest_.reset();
  }

  static double seconds_of(const Candidate& candidate) { return candidate.measured.seconds; }
  double error_of(const Measured& measured) const { return error(measured, reference_, asked_); }
  bool reached_by(const Measured& measured) const { return error_of(measured) <= asked_.accuracy; }

  double limit() const {
    const bool resolved = reached_by(Measured{});
    return std::min(resolved ? kLongest : kInVain, std::max(kNoise, kHopeless * best_));
  }

  void time(std::vector<Candidate>& candidates, std::size_t count) const {
    std::vector<Case> batch;
    for (std::size_t k = 0; k < count; ++k) batch.push_back(candidates[k].one);
    const std::vector<Measured> timed = sweep_.measure(batch, kRepetitions);
    for (std::size_t k = 0; k < count; ++k) candidates[k].measured = timed[k];
  }

  void choose_solver() {
    std::vector<Candidate> same{found_.reaching.front()};
    for (const LinearSolverEntry& entry : linear_solvers()) {
      Candidate other = same.front();
      if (entry.name == kUsualSolver) continue;
      other.one.settings.linear_solver = entry.name;
      other.measured = sweep_.compare(other.one);
      if (reached_by(other.measured)) same.push_back(other);
    }
    time(same, same.size());
    const Candidate& fastest = *std::ranges::min_element(same, {}, seconds_of);
    found_.reaching.front() = seconds_of(fastest) < kMuchFaster * seconds_of(same.front()) ? fastest : same.front();
  }

  const Sweep& sweep_;
  const Reference& reference_;
  const Asked& asked_;
  Calibration found_;
  Measured last_;
  std::optional<Candidate> reaching_, nearest_;  // of the method that is being tried
  double best_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double error(const Measured& measured, const Reference& reference, const Asked& asked) {
  if (!measured.ok()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (const std::size_t quantity : asked.quantities) {
    if (std::isnan(measured.error[quantity])) return std::numeric_limits<double>::infinity();
    largest = std::max({largest, measured.error[quantity], reference.agreement[quantity]});
  }
  return largest;
}

Calibration calibrate(const Sweep& sweep, const Reference& reference, const Asked& asked, bool kinematics) {
  Search search(sweep, reference, asked);
  for (const bool controls_error : {true, false})  // those that control their error set a time to compare with
    for (const IntegratorEntry& integrator : integrators())
      for (const FormulationEntry& entry : formulations()) {
        const std::string formulation(entry.name);
        if (integrator.picks || integrator.controls_error != controls_error || refusal_of(integrator, formulation))
          continue;
        if (integrator.analysis == Analysis::kinematics && !kinematics) continue;
        controls_error ? search.by_tolerance(formulation, integrator) : search.by_step(formulation, integrator);
      }
  return search.result();
}

}  // namespace poinsot::study
