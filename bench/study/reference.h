// A reference motion of a scene, and how far it can be trusted: several methods, unlike each other in the integrator or
// in the coordinates, each at two tolerances.
//
// How far a method's two tolerances are apart tells what its error control leaves; how far two methods are apart tells
// what neither can tell of itself. The motion given is the tighter one of the method whose tolerances are least apart.
// `agreement` is how far the nearest other method is from it: what the reference resolves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/study/cache.h"
#include "bench/study/motion.h"

namespace poinsot::study {

struct ReferenceSettings {
  double end = 1;    // s
  double every = 1;  // s between output times
  int digits = 12;   // asked for: the tighter tolerance is 10^−(digits + 1), the other one a hundred times that; a
                     // method that does not pass so is taken back to larger ones
};

struct Reference {
  struct Method {
    std::string integrator, formulation;
    double loose = 0, tight = 0;  // rtol
    std::string failure;          // of one of its runs; empty where both are good
    PerQuantity apart{};          // its two tolerances
    PerQuantity from_given{};     // its tighter motion from the one given
  };

  std::vector<Method> methods;
  int given = -1;           // the method of the motion; -1: there is none, each method's failure says why
  int nearest = -1;         // the other method that agrees best; -1: no other confirms it
  PerQuantity agreement{};  // with that one; where there is none, between the tolerances
  Motion motion;

  const Method& of() const { return methods[static_cast<std::size_t>(given)]; }
};

// What a reference is kept by: the program (program_identity()), what was asked for and the text of the scene.
std::string reference_key(const Scene& scene, const ReferenceSettings& settings, std::string_view program);

// From the cache where it is there; a scene that was read from no text is not kept. Notices are for the user.
Reference reference(const Scene& scene, const ReferenceSettings& settings, const Cache& cache,
                    std::vector<std::string>& notices);

// Decimal digits of a difference.
double digits(double difference);

// Sentence: why there is no reference.
std::string why_none(const Reference& reference);

}  // namespace poinsot::study
