# Warnings, sanitizers and floating-point flags as one INTERFACE target. Linked privately, so users never inherit it.
add_library(chicane_options INTERFACE)
target_compile_features(chicane_options INTERFACE cxx_std_20)
target_compile_options(chicane_options INTERFACE
  # no -Wsign-conversion: g++ 12 then demands a cast for every std::array<T, N> with an int N
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wshadow -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # g++ 12 sees overlaps in std::string that are not there (GCC bug 105651)
  -ffp-contract=off      # same bits from gcc and clang, Debug and Release
  -fno-math-errno
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
