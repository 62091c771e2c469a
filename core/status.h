// What a numerical procedure answers: ok, or why it stopped. Never thrown, never printed from inside.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace poinsot {

enum class Failure {
  none,
  not_converged,        // Newton's method spent its iterations or diverged
  singular_matrix,      // the linear system has no trustworthy solution
  not_finite,           // a NaN or an infinity came up
  inconsistent_state,   // the state violates the constraints and may not or cannot be projected onto them
  constraint_lost,      // a row that followed from the others does not hold any more
  singular_position,    // the constraints depend on one another here, and no branch is chosen
  rotation_too_large,   // a step turns a body further than the method can follow, or an angle can be counted
  step_size_too_small,  // error control asks for steps that do not advance the time
  refused,              // the chosen linear solver does not take this system
  interrupted,          // from outside (core/interruption.h): nothing is wrong with what was computed
};

// The failure's name as it stands in the run record: "ok", "not_converged", ...
std::string_view name(Failure failure);

struct [[nodiscard]] Status {
  Failure failure = Failure::none;
  double time = 0;           // s, where it happened
  std::string message;       // what, which body or constraint, what to try; empty when ok
  std::size_t remedy = 0;    // where in it what to try begins; 0 where nothing is known to help
  std::size_t settings = 0;  // where in that begins what are other settings, up to the end; 0: none
  double step = 0;           // s, the longest of them that may serve, where it is known

  bool ok() const { return failure == Failure::none; }
  void withdraw_remedy() {
    if (remedy > 0) message.resize(std::exchange(remedy, 0));
    settings = 0;
  }
  // Why it came to that, before what to try.
  void explain(std::string_view why);
};

// A failure and what to try: "end before it".
Status with_remedy(Failure failure, double time, std::string message, std::string_view remedy);
// The same, where other settings may help: "try a smaller step". After a remedy of another kind: "..., or ...".
Status with_settings(Status status, std::string_view settings);

}  // namespace poinsot
