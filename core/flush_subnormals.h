// Numbers below 2.2e-308 count as zero while this object lives, in its thread.
//
// What moves in a plane is kept there by Newton's method: what is off shrinks with every step, by rounding alone to
// fractions of itself, until it is subnormal, and it stays there: the smallest subnormal number times anything above
// one half is itself. Processors compute with such numbers many times slower: runs of planar loops took up to three
// times as long, of the delta robot twice. x86-64 only, where the unit is set by flags (FTZ and DAZ of MXCSR: Intel 64
// and IA-32 Architectures Software Developer's Manual, vol. 1, 10.2.3); elsewhere nothing is done.
#pragma once

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace poinsot {

class FlushSubnormals {
 public:
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

#if defined(__x86_64__)
  FlushSubnormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | kResults | kOperands);
  }
  ~FlushSubnormals() {
    _mm_setcsr(before_);
  }

 private:
  static constexpr unsigned kResults = 0x8000, kOperands = 0x0040;
  unsigned before_;
#else
  FlushSubnormals() {}
  ~FlushSubnormals() {}
#endif
};

}  // namespace poinsot
