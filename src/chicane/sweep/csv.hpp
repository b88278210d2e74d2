// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/base/result.hpp"

namespace chicane::sweep {

/// A value of RFC 4180, in quotes where it has to be.
[[nodiscard]] std::string csv_cell(const std::string& text);

/// Writes a file of results as comma separated values (RFC 4180): `run`, the keys of the axes, the columns.
/// Lists stand in quotes, as JSON; what was not measured is empty. Memory does not grow with the file.
/// kParse, kIo.
[[nodiscard]] Result<void> write_csv(const std::string& results, const std::string& csv);

}  // namespace chicane::sweep
