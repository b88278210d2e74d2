// SPDX-License-Identifier: MIT
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
