// SPDX-License-Identifier: MIT
// Page of `chicane identify`.
#pragma once

#include <string>

#include "chicane/identify/identification.hpp"

namespace chicane::apps {

/// Texts of the page of an identification.
struct IdentifyPageWords {
  std::string logs;     ///< names of the files
  std::string advice;   ///< sentences, a line each; may be empty
  std::string command;  ///< command line that drives the found car
};

/// HTML document (protocol/json.hpp) of an identification: numbers with their intervals, predicted against
/// measured motion on the held-out ends, residuals, correlations of the estimates, and the slip that the logs
/// cover.
[[nodiscard]] std::string identify_document(const identify::Identification& found,
                                            const IdentifyPageWords& words);

}  // namespace chicane::apps
