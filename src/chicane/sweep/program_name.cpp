// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/sources_digest.hpp"  // written by cmake/WriteDigest.cmake
#include "chicane/sweep/result_file.hpp"
#include "chicane/version.hpp"

namespace chicane::sweep {

std::string program_name() { return "chicane " CHICANE_VERSION " (" CHICANE_SOURCES ")"; }

}  // namespace chicane::sweep
