#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bench/stability/family.h"
#include "bench/stability/verdict.h"
#include "integrators/integrator.h"

namespace poinsot::stability {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kCoarse = 0.01;                  // relative to the motion
constexpr double kSlack = 10;                     // a digit
constexpr double kRounding = 1e-7, kShows = 0.1;  // between them an error shows its order
constexpr double kNewton = 1e-9;                  // integrators/README.md
constexpr double kLeastSensitivity = 0.1;         // of driven motions, which have none
constexpr double kNudge = 1e-6;                   // relative
constexpr double kAtol = 0.01;                    // over rtol: the default
constexpr double kPerBody = 12;                   // numbers of a state
constexpr double kHuge = 1e300;                   // an error without a number
constexpr double kLinear = 0.1, kApart = 2;       // of the motion: a promise above the one says the other at most
constexpr std::size_t kBetween = 8;               // times the sensitivity is asked for to each that is compared

bool benign(const Family& family, const Cell& cell) {
  return (family.x.of_settings() || cell.x == family.x.benign) && (family.y.of_settings() || cell.y == family.y.benign);
}

Place place_of(const Family& family, const Cell& cell) {
  return {family.x.along == Axis::accuracy ? 0 : cell.x, family.y.along == Axis::accuracy ? 0 : cell.y, cell.end, 0};
}

// The truth of the family's motions, each computed once.
class Truths {
 public:
  explicit Truths(const Family& family) : family_(family) {}

  struct Motion {
    std::vector<std::vector<double>> values;  // of each that may be, by column and time as those of a cell
    double sensitivity = 0;
  };
  const Motion& at(const Place& place, std::size_t times) {
    const auto [found, fresh] = known_.try_emplace(std::tuple(place.x, place.y, place.end));
    if (fresh) found->second = compute(place, times);
    return found->second;
  }

 private:
  std::vector<std::vector<double>> motions(const Place& place, std::size_t times) const {
    std::vector<std::vector<double>> all;
    for (std::size_t n = 1; n <= times; ++n) {
      const auto at = family_.truth(place, place.end * static_cast<double>(n) / static_cast<double>(times));
      all.resize(at.size());
      for (std::size_t m = 0; m < at.size(); ++m) {
        all[m].resize(at[m].size() * times);
        for (std::size_t c = 0; c < at[m].size(); ++c) all[m][c * times + n - 1] = at[m][c];
      }
    }
    return all;
  }
  Motion compute(Place place, std::size_t times) const {
    Motion motion{motions(place, times), 0};
    const double scale = family_.size(place);
    const std::vector<double> along = motions(place, kBetween * times).front();
    place.nudge = kNudge;
    const std::vector<double> nudged = motions(place, kBetween * times).front();
    for (std::size_t k = 0; k < nudged.size(); ++k)
      motion.sensitivity = std::max(motion.sensitivity, std::abs(nudged[k] - along[k]) / (kNudge * scale));
    return motion;
  }

  const Family& family_;
  std::map<std::tuple<double, double, double>, Motion> known_;
};

double error(const std::vector<double>& values, const Truths::Motion& truth, double size) {
  double least = kHuge;
  for (const std::vector<double>& motion : truth.values) {
    double largest = 0;
    for (std::size_t k = 0; k < motion.size(); ++k) {
      const double apart = std::abs(values[k] - motion[k]) / size;
      largest = std::max(largest, std::isnan(apart) ? kHuge : apart);
    }
    least = std::min(least, largest);
  }
  return least;
}

// What a run said, but for its numbers.
std::string without_numbers(std::string message) {
  std::erase_if(message, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e'; });
  return message;
}

// What the benign cells of a method show of it.
struct Method {
  double constant = 0;           // C
  const Cell* finest = nullptr;  // of those that do not show it
  std::set<std::string> said;    // without numbers
};

}  // namespace

std::string_view name(Verdict verdict) {
  constexpr std::string_view names[kVerdicts] = {"accurate", "coarse", "told", "stop", "wrong"};
  return names[static_cast<std::size_t>(verdict)];
}

void judge(const Family& family, std::vector<Cell>& cells) {
  const std::size_t columns = family.columns.size();
  Truths truths(family);
  const auto truth_of = [&](const Cell& cell) -> const Truths::Motion& {
    return truths.at(place_of(family, cell), cell.values.size() / columns);
  };
  // S r T (h r)^p
  const auto order_bound = [&](const Cell& cell) {
    const double rate = family.rate(place_of(family, cell));
    return std::max(truth_of(cell).sensitivity, kLeastSensitivity) * rate * cell.end *
           std::pow(cell.step * rate, integrators().require(cell.integrator).order);
  };
  for (Cell& cell : cells)
    cell.error = cell.ended() ? error(cell.values, truth_of(cell), family.size(place_of(family, cell))) : kNone;

  std::map<std::string, Method> methods;
  for (const Cell& cell : cells) {
    Method& method = methods[cell.method()];
    if (!cell.ended() || !benign(family, cell)) continue;
    method.said.insert(without_numbers(cell.message));
    if (cell.error > kRounding && cell.error < kShows) {
      method.constant = std::max(method.constant, cell.error / order_bound(cell));
    } else if (!method.finest || cell.step < method.finest->step) {
      method.finest = &cell;
    }
  }
  for (auto& [_, method] : methods)
    if (method.constant == 0 && method.finest) method.constant = method.finest->error / order_bound(*method.finest);

  for (Cell& cell : cells) {
    cell.promised = kNone;
    if (!cell.ended()) continue;  // a stop
    const IntegratorEntry& integrator = integrators().require(cell.integrator);
    const Method& method = methods[cell.method()];
    const double sensitivity = std::max(truth_of(cell).sensitivity, 1.0);
    const Place place = place_of(family, cell);
    const double reach = std::max(1.0, family.reach(place));
    const double tolerance = cell.rtol * (reach + kAtol / family.size(place));
    cell.promised = integrator.controls_error
                        ? std::sqrt(kPerBody * static_cast<double>(cell.bodies)) * cell.steps * tolerance * sensitivity
                    : method.constant == 0 && !method.finest
                        ? kCoarse
                        : kSlack * (method.constant * order_bound(cell) + sensitivity * kNewton);
    cell.promised += kSlack * sensitivity * (std::numeric_limits<double>::epsilon() * reach + family.floor(place));
    if (cell.promised > kLinear) cell.promised = std::max(cell.promised, kApart);
    const bool warned = !family.warning.empty() && cell.message.find(family.warning) != std::string::npos;
    const bool said = !cell.message.empty() && !method.said.contains(without_numbers(cell.message));
    if (cell.error <= cell.promised)
      cell.verdict = cell.error <= kCoarse ? Verdict::accurate : Verdict::coarse;
    else
      cell.verdict = warned || said ? Verdict::told : Verdict::wrong;
  }
}

}  // namespace poinsot::stability
