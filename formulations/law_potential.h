// The energy that a spring's law F(x, v, t) stores, J: V(x) = ∫ F(s, 0, t) ds from 0; of a law without bounds at 0, as
// c/x², from 1 or −1 on the side of x.
//
// Signals ask for it at every output, and after a hundred turns it is made of all that lies between. So of a law
// without t it is put together of parts whose ends are numbers of few bits: these are known from before, and x itself
// is near the last of them. Which x were asked for before changes no value.
#pragma once

#include <optional>
#include <unordered_map>

#include "core/expression.h"

namespace poinsot {

// ∫ F(s, 0, t) ds between two x, to rounding or to a part of ∫ |F| ds.
double law_work(const Expression& law, double from, double to, double t, double part = 0);

class LawPotential {
 public:
  // Of a law that lives as long; of none it is not to be asked for.
  explicit LawPotential(const Expression* law) : law_(law) {}

  const Expression& law() const { return *law_; }
  double at(double x, double t);

 private:
  double origin(double x, double t);
  double up_to(double x, int level);

  const Expression* law_;
  std::optional<bool> bounded_[2];  // at 0, of x above and below; where it does not depend on t
  std::unordered_map<double, double> known_;
};

}  // namespace poinsot
