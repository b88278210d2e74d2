// SPDX-License-Identifier: MIT
// Name of this program in result files. A file of its own, because the digest changes with every source file
// that can change a result: only this one is then compiled again.
#include "chicane/sweep/detail/sources_digest.hpp"  // CHICANE_SOURCES, by cmake/WriteDigest.cmake
#include "chicane/sweep/result_file.hpp"
#include "chicane/version.hpp"

namespace chicane::sweep {

std::string program_name() { return "chicane " CHICANE_VERSION " (" CHICANE_SOURCES ")"; }

}  // namespace chicane::sweep
