#pragma once

#include <pmmintrin.h>
#include <xmmintrin.h>

namespace hyades::core {

/// Sets flush-to-zero and denormals-are-zero for the current thread and restores the old mode at
/// the end of its scope. Every thread that computes pixels or builds acceleration structures holds
/// one (invariant 1: a unit is a pure function).
class FpMode {
 public:
  FpMode() : saved_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FpMode() { _mm_setcsr(saved_); }
  FpMode(const FpMode&) = delete;
  FpMode& operator=(const FpMode&) = delete;

 private:
  unsigned saved_;
};

}  // namespace hyades::core
