// SPDX-License-Identifier: MIT
// The entry of libFuzzer; CHICANE_FUZZ_TARGET is the name of the target (tests/fuzz/CMakeLists.txt).
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const chicane::fuzz::Target* const target = chicane::fuzz::find(CHICANE_FUZZ_TARGET);
  target->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
