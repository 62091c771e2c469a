#include "linsolve/block/cancellation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "linsolve/block/kernels.h"

namespace poinsot::block {
namespace {

// A number and its size without cancellation.
struct Sized {
  double value = 0, size = 0;
};

// A whole front, (p + m) × (p + m).
class Square {
 public:
  void clear(int n) {
    n_ = index(n);
    entries_.assign(n_ * n_, {});
  }
  Sized& operator()(int i, int j) { return entries_[index(j) * n_ + index(i)]; }

 private:
  std::size_t n_ = 0;
  std::vector<Sized> entries_;
};

// Eliminates p pivots of n, calling visit(k, part) for the part that pivot k is of its size: true where it is to be
// judged as if it were good. The pivots are those of factor_choosing().
template <class Visit>
void eliminate(Square& a, int p, int n, std::span<double> weight, std::vector<Sized>& l, Visit&& visit) {
  l.resize(index(n));
  for (int k = 0; k < p; ++k) {
    int best = k;
    const auto candidate = [&](int i) { return std::abs(a(i, k).value) * weight[index(i)]; };
    for (int i = k + 1; i < p; ++i)
      if (candidate(i) > candidate(best)) best = i;
    if (candidate(best) > block::kReluctance * candidate(k)) {
      for (int j = 0; j < n; ++j) std::swap(a(k, j), a(best, j));
      std::swap(weight[index(k)], weight[index(best)]);
    }
    Sized& pivot = a(k, k);
    if (visit(k, pivot.size > 0 ? std::abs(pivot.value) / pivot.size : 0))
      pivot.value = pivot.size > 0 ? pivot.size : 1;
    for (int i = k + 1; i < n; ++i) {
      const double multiplier = a(i, k).value / pivot.value;
      l[index(i)] = {-multiplier, std::abs(multiplier)};
    }
    for (int j = k + 1; j < n; ++j) {
      const Sized u{a(k, j).value, std::abs(a(k, j).value)};
      if (u.value == 0) continue;
      Sized* column = &a(0, j);
      for (int i = k + 1; i < n; ++i) {  // both at once, as a vector
        column[i].value += l[index(i)].value * u.value;
        column[i].size += l[index(i)].size * u.size;
      }
    }
  }
}

}  // namespace

Cancelled cancelled_pivots(const Schedule& s, std::span<const double> values, std::span<const double> weight,
                           double part) {
  Cancelled found;
  std::vector<std::vector<Sized>> updates(s.fronts.size());  // m × m, until the parent takes them
  Square a;
  std::vector<int> places;
  std::vector<double> units;
  std::vector<Sized> multipliers;
  const Strip* strip = s.strips.data();
  const int* child = s.children.data();
  for (std::size_t k = 0; k < s.fronts.size(); ++k) {
    const Front& f = s.fronts[k];
    const int p = f.pivots, m = f.others, n = p + m;
    a.clear(n);
    for (const Strip* end = s.strips.data() + f.strips.back(); strip != end; ++strip)
      for (unsigned i = 0; i < strip->length; ++i) {
        // Back from the store of D, L and U to rows and columns.
        const int t = static_cast<int>(strip->target + i), l = t - p * p, u = l - p * f.rows;
        Sized& entry = l < 0 ? a(t % p, t / p) : u < 0 ? a(p + l % f.rows, l / f.rows) : a(u % p, p + u / p);
        const double value = values[index(strip->source) + i];
        entry.value += value;
        entry.size += std::abs(value);
      }
    for (const int* end = s.children.data() + f.children; child != end; ++child) {
      const Front& c = s.fronts[index(*child)];
      places.resize(index(c.others));
      for (int r = c.first_stretch; r < c.last_stretch; ++r) {
        const Stretch& stretch = s.stretches[index(r)];
        for (int i = 0; i < stretch.length; ++i)
          places[index(stretch.from + i)] = stretch.to + i + (r < c.first_outer_stretch ? 0 : p);
      }
      const auto place = [&](int i) { return places[index(i)]; };
      const std::vector<Sized>& update = updates[index(*child)];
      for (int j = 0; j < c.others; ++j)
        for (int i = 0; i < c.others; ++i) {
          Sized& entry = a(place(i), place(j));
          entry.value += update[index(j * c.others + i)].value;
          entry.size += update[index(j * c.others + i)].size;
        }
      std::vector<Sized>().swap(updates[index(*child)]);
    }
    units.resize(index(p));
    for (int i = 0; i < p; ++i) units[index(i)] = weight[index(s.unknown[index(f.first + i)])];
    eliminate(a, p, n, units, multipliers, [&](int i, double left) {
      if (!(left >= found.least)) found.least = left;
      if (left > part) return false;
      found.pivots.push_back(f.first + i);
      return true;
    });
    updates[k].reserve(index(m) * index(m));
    for (int j = p; j < n; ++j) updates[k].insert(updates[k].end(), &a(p, j), &a(p, j) + m);
  }
  return found;
}

}  // namespace poinsot::block
