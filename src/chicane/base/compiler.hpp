// SPDX-License-Identifier: MIT
// Macros for the compiler: checks of our own code, and forced inlining.
#pragma once

#include <cstdio>
#include <cstdlib>

/// A bug in our own code: stops in Debug, sanitizer and test builds, compiled out in Release. Never for input
/// from outside.
#if !defined(NDEBUG) || defined(CHICANE_ENABLE_ASSERT)
#define CHICANE_ASSERT(condition)                                                            \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
#else
#define CHICANE_ASSERT(condition) static_cast<void>(0)
#endif

/// Kernels are written as many small functions that have to become one, whatever the compiler thinks:
/// CHICANE_INLINE puts a function or lambda (after its parameters) into its callers, CHICANE_FLATTEN
/// everything a function calls into it. Not in Debug nor for sanitizers, which would need minutes for one
/// file, nor where CHICANE_NO_FORCED_INLINE is defined; the bits are the same.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CHICANE_IS_SANITIZED
#endif
#endif
#if defined(__OPTIMIZE__) && !defined(CHICANE_NO_FORCED_INLINE) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(CHICANE_IS_SANITIZED)
#define CHICANE_INLINE __attribute__((always_inline))
#define CHICANE_FLATTEN __attribute__((flatten))
#else
#define CHICANE_INLINE
#define CHICANE_FLATTEN
#endif
#undef CHICANE_IS_SANITIZED
