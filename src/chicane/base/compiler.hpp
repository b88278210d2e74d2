// SPDX-License-Identifier: MIT
// Macros for the compiler: checks of our own code, and forced inlining.
#pragma once

#include <cstdio>
#include <cstdlib>

/// Aborts the program if `condition` is false: a bug of our own code, never an input from outside. Compiled
/// out in Release; active in Debug, sanitizer and test builds.
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

/// Forced inlining, for kernels that are written as many small functions:
///   CHICANE_INLINE   inlines a function or lambda into its callers (of a lambda after its parameters)
///   CHICANE_FLATTEN  inlines all calls that a function makes
/// Both are empty in Debug and for sanitizers, which would compile one file for minutes, and where
/// CHICANE_NO_FORCED_INLINE is defined. Results have the same bits with and without forced inlining.
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
