# Warnings, sanitizers and floating-point flags as one INTERFACE target. Linked privately, so users never inherit it.
add_library(chicane_options INTERFACE)
target_compile_features(chicane_options INTERFACE cxx_std_20)
target_compile_options(chicane_options INTERFACE
  # no -Wsign-conversion: g++ 12 then demands a cast for every std::array<T, N> with an int N
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wshadow -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # g++ 12 sees overlaps in std::string that are not there (GCC bug 105651)
  # `&` joins comparisons of numbers and of vectors alike; clang takes it for a slip of `&&`
  $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>
  # Patterns of stages with 50 variables are computed by the compiler: clang gives up after 1048576 steps.
  $<$<CXX_COMPILER_ID:Clang>:-fconstexpr-steps=100000000>
  -ffp-contract=off      # same bits from gcc and clang, Debug and Release
  -fno-math-errno
  # GCC collects garbage from two gigabytes on, not from 128 MB: a fifth less compile time, up to 0.5 GB more memory
  "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=2000000>"
  $<$<BOOL:${CHICANE_WERROR}>:-Werror>)
if(CHICANE_SANITIZE)
  target_compile_options(chicane_options INTERFACE -fsanitize=${CHICANE_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all
                         # Instrumented code: g++ 12 sees the text of a std::variant used that is not there.
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(chicane_options INTERFACE -fsanitize=${CHICANE_SANITIZE})
  if(CHICANE_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(chicane_options INTERFACE -Wno-tsan)  # Asio has fences beside its locks; the locks are seen
  endif()
endif()

# For what reads a stranger's bytes (docs/reference/security.md): the modules below and the program. The numerical modules stay as they are, because
# they see checked values only. Debug and sanitizer builds have better checks of their own.
set(CHICANE_HARDENED_MODULES net protocol telemetry sweep recording wire live ros)
set(CHICANE_IS_HARDENED OFF)
if(NOT CHICANE_SANITIZE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug" AND NOT CMAKE_CROSSCOMPILING)
  set(CHICANE_IS_HARDENED ON)
endif()
add_library(chicane_hardened INTERFACE)
if(CHICANE_IS_HARDENED)
  target_compile_options(chicane_hardened INTERFACE
    -fstack-protector-strong -fstack-clash-protection -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 -D_GLIBCXX_ASSERTIONS
    $<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},x86_64>:-fcf-protection>)
  target_link_options(chicane_hardened INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
endif()
