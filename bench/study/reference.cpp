#include "bench/study/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace poinsot::study {
namespace {
using Json = nlohmann::json;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct MethodEntry {
  const char *integrator, *formulation;
  double smallest;  // rtol below which rounding rules
};
constexpr MethodEntry kMethods[] = {
    {"dop853", "rA", 1e-13}, {"dop853", "rp", 1e-13}, {"ida", "rp", 1e-12}, {"radau5", "rA", 1e-13}};
constexpr double kLongestRun = 30;   // s, of a run: an explicit method on a stiff scene is given up
constexpr double kApart = 100;       // ratio of a method's two tolerances
constexpr double kCreeping = 5;      // a tight run this many times as long as the loose one is lost in rounding
constexpr double kLeastLongest = 1;  // s, that a tight run is always given
constexpr int kRetreats = 2;         // times a method is taken back
constexpr double kRetreat = 30;  // times the tolerance: no whole decade, which charts would measure against themselves

Settings settings_of(const Reference::Method& method, double rtol, const ReferenceSettings& asked) {
  Settings settings;
  settings.formulation = method.formulation;
  settings.integrator = method.integrator;
  settings.rtol = rtol;
  settings.end = asked.end;
  settings.every = asked.every;
  return settings;
}

// A JSON file has no infinity: it is written as null.
PerQuantity unpacked(const Json& list) {
  PerQuantity difference;
  for (std::size_t k = 0; k < difference.size(); ++k)
    difference[k] = list.at(k).is_null() ? kUnlimited : list.at(k).get<double>();
  return difference;
}

// Applies `one` to every number of a body's state, in a fixed order.
template <class State, class One>
void each_number(State& body, const One& one) {
  for (auto* vector : {&body.r, &body.rd, &body.w, &body.rdd, &body.wd})
    for (auto& x : vector->reshaped()) one(x);
  for (auto& x : body.A.reshaped()) one(x);
}

std::string packed(const Reference& reference) {
  Json json;
  for (const Reference::Method& m : reference.methods)
    json["methods"].push_back({m.integrator, m.formulation, m.loose, m.tight, m.failure, m.apart, m.from_given});
  json["given"] = reference.given;
  json["nearest"] = reference.nearest;
  json["agreement"] = reference.agreement;
  json["t"] = reference.motion.t;
  json["lambda"] = reference.motion.lambda;
  std::vector<double> numbers;
  for (const auto& bodies : reference.motion.bodies)
    for (const BodyState& body : bodies) each_number(body, [&](double x) { numbers.push_back(x); });
  json["bodies"] = numbers;
  return json.dump();
}

// Whatever a file holds that has the right checksum: a motion of this scene, or an exception.
Reference unpacked(const std::string& data, const Scene& scene, const ReferenceSettings& asked) {
  const auto require = [](bool right) {
    if (!right) throw std::out_of_range("what is kept is not of this scene");
  };
  const Json json = Json::parse(data);
  Reference reference;
  for (const Json& m : json.at("methods"))
    reference.methods.push_back({m.at(0), m.at(1), m.at(2), m.at(3), m.at(4), unpacked(m.at(5)), unpacked(m.at(6))});
  reference.given = json.at("given");
  reference.nearest = json.at("nearest");
  const auto is_method = [&](int m) { return m >= -1 && m < static_cast<int>(reference.methods.size()); };
  require(is_method(reference.given) && is_method(reference.nearest));
  reference.agreement = unpacked(json.at("agreement"));
  reference.motion.t = json.at("t").get<std::vector<double>>();
  reference.motion.lambda = json.at("lambda").get<std::vector<std::vector<double>>>();
  const auto numbers = json.at("bodies").get<std::vector<double>>();
  const std::size_t times = reference.motion.t.size(), bodies = scene.bodies.size(), rows = compile(scene).rows.size();
  std::size_t of_body = 0;
  BodyState one;
  each_number(one, [&](double) { ++of_body; });
  require(reference.motion.lambda.size() == times && numbers.size() == times * bodies * of_body);
  for (const auto& lambda : reference.motion.lambda) require(lambda.size() == rows);
  require(reference.given < 0 ||
          (times > 0 && reference.motion.t.front() == 0 && reference.motion.t.back() == asked.end));
  auto next = numbers.begin();
  reference.motion.bodies.assign(times, std::vector<BodyState>(bodies));
  for (auto& states : reference.motion.bodies)
    for (BodyState& body : states) each_number(body, [&](double& x) { x = *next++; });
  return reference;
}

struct Timed {
  Motion motion;
  std::string failure;
  double seconds = 0;
};

Timed timed(const Scene& scene, const Settings& settings, double longest) {
  const auto start = std::chrono::steady_clock::now();
  MotionRun run = run_motion(scene, settings, longest);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  return {std::move(run.motion), std::move(run.outcome.status.message), passed.count()};
}

struct Pair {
  Reference::Method method;
  Motion loose, tight;
};

// The method at its two tolerances. Where the tight one asks for more than rounding leaves (stiff forces), both are
// taken back until the two runs pass.
Pair tightest_pair(const Scene& scene, const MethodEntry& entry, const ReferenceSettings& asked) {
  Pair pair{{entry.integrator, entry.formulation, 0, 0, {}, {}, {}}, {}, {}};
  Reference::Method& method = pair.method;
  method.apart.fill(kUnlimited);
  method.tight = std::max(std::pow(10.0, -asked.digits - 1), entry.smallest);
  for (int retreat = 0;; ++retreat, method.tight *= kRetreat) {
    method.loose = kApart * method.tight;
    Timed run = timed(scene, settings_of(method, method.loose, asked), kLongestRun);
    const bool hopeless = run.seconds >= kLongestRun;
    const double longest = std::clamp(kCreeping * run.seconds, kLeastLongest, kLongestRun);
    method.failure = run.failure;
    pair.loose = std::move(run.motion);
    if (method.failure.empty()) {
      run = timed(scene, settings_of(method, method.tight, asked), longest);
      method.failure = run.failure;
      pair.tight = std::move(run.motion);
    }
    if (method.failure.empty() || hopeless || retreat == kRetreats) return pair;
  }
}

Reference compute(const Scene& scene, const ReferenceSettings& asked) {
  const Model model = compile(scene);
  Reference reference;
  std::vector<Motion> tight;
  for (const MethodEntry& entry : kMethods) {
    Pair pair = tightest_pair(scene, entry, asked);
    if (pair.method.failure.empty())
      pair.method.apart = difference(pair.loose, pair.tight, sizes(pair.tight, model), model);
    reference.methods.push_back(pair.method);
    tight.push_back(std::move(pair.tight));
  }
  for (std::size_t m = 0; m < reference.methods.size(); ++m)
    if (reference.methods[m].failure.empty() &&
        (reference.given < 0 || std::ranges::max(reference.methods[m].apart) < std::ranges::max(reference.of().apart)))
      reference.given = static_cast<int>(m);
  if (reference.given < 0) return reference;

  const auto given = static_cast<std::size_t>(reference.given);
  reference.motion = tight[given];
  reference.agreement = reference.of().apart;
  const Sizes scale = sizes(reference.motion, model);
  for (std::size_t m = 0; m < reference.methods.size(); ++m) {
    Reference::Method& other = reference.methods[m];
    if (m == given || !other.failure.empty()) continue;
    other.from_given = difference(tight[m], reference.motion, scale, model);
    if (reference.nearest >= 0 && std::ranges::max(other.from_given) >= std::ranges::max(reference.agreement)) continue;
    reference.nearest = static_cast<int>(m);
    reference.agreement = other.from_given;
  }
  return reference;
}

}  // namespace

std::string reference_key(const Scene& scene, const ReferenceSettings& settings, std::string_view program) {
  return fmt::format("{}\nreference: end {:.17g}, every {:.17g}, {} digits\n{}", program, settings.end, settings.every,
                     settings.digits, scene.source);
}

Reference reference(const Scene& scene, const ReferenceSettings& settings, const Cache& cache,
                    std::vector<std::string>& notices) {
  if (scene.source.empty()) return compute(scene, settings);
  const std::string key = reference_key(scene, settings, program_identity());
  if (const auto kept = cache.find(key, notices)) {
    try {
      return unpacked(*kept, scene, settings);
    } catch (const std::exception&) {
      notices.push_back(
          fmt::format("{} does not hold this reference, which is computed again", cache.file(key).string()));
    }
  }
  const Reference computed = compute(scene, settings);
  cache.keep(key, packed(computed), notices);
  return computed;
}

double digits(double difference) {
  return std::max(0.0, -std::log10(std::max(difference, std::numeric_limits<double>::epsilon())));
}

std::string why_none(const Reference& reference) {
  std::string sentence = "no reference could be computed";
  for (const Reference::Method& method : reference.methods)
    sentence += fmt::format("; {} in {}, rtol {:.0e}: {}", method.integrator, method.formulation, method.tight,
                            method.failure.substr(0, method.failure.find_first_of(":;")));
  return sentence + "; a run with one of these settings says more";
}

}  // namespace poinsot::study
