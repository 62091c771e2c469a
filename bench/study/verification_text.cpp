#include "bench/study/verification_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/printable.h"

namespace poinsot::study {

void print(std::FILE* out, const Verification& verification) {
  using Quantity = Verification::Quantity;
  const auto& all = verification.quantities;
  if (all.empty()) {
    fmt::print(out, "not verified: {}\n", printable(verification.failure));
    return;
  }
  fmt::print(out, "verified against {}: apart by at most, of {} times\n", verification.against, verification.times);
  const bool orders = std::ranges::any_of(all, [](const Quantity& q) { return q.order || q.order_unseen; });
  for (const Quantity& q : all) {
    fmt::print(out, "  {:<20} {:>8.2g} {:<7}", q.name, q.apart, q.unit);
    if (q.apart > 0) fmt::print(out, " {} at t = {:g} s", printable(q.where), q.t);
    if (q.order) fmt::print(out, ", order {:.2f}", *q.order);
    if (q.order_unseen) fmt::print(out, ", order not seen");
    if (q.error)
      fmt::print(out, ", so the error is about {:.2g}", *q.error);
    else if (q.order)
      fmt::print(out, ": the step is too long to tell the error");
    fmt::print(out, "\n");
  }
  if (!verification.failure.empty())
    fmt::print(out, "  the order is not known: {}\n", printable(verification.failure));
  else if (verification.steps && !orders)
    fmt::print(out, "  the differences are too small to show an order\n");
}

}  // namespace poinsot::study
