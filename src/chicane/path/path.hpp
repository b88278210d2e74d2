// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/road/path.hpp"

/// The old name of `road`, for one version: include chicane/road/path.hpp and write `chicane::road`.
namespace chicane::path {
using namespace road;
}  // namespace chicane::path
