// Embree asks for denormal numbers to be flushed to zero. The mode is set around queries and
// restored after them: results must not depend on which thread ran what, and the mode must not leak
// into the rest of the program. Queries do this themselves; callers with many of them in a row
// spare the changes by one of these around all.
#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace lobelia {

#if defined(__SSE__)
class FlushDenormals {
 public:
  FlushDenormals() : old_(_mm_getcsr()) {
    if ((old_ & kBits) != kBits) _mm_setcsr(old_ | kBits);
  }
  ~FlushDenormals() {
    if ((old_ & kBits) != kBits) _mm_setcsr(old_);
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  static constexpr unsigned kBits = 0x8040;  // flush to zero, denormals are zero
  unsigned old_;
};
#else
struct FlushDenormals {
  FlushDenormals() {}
};
#endif

}  // namespace lobelia
