// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/identify/identification.hpp"

namespace chicane::apps {

/// Texts on the page of an identification, around its figures.
struct IdentifyPageWords {
  std::string logs;     ///< names of the files
  std::string advice;   ///< sentences, a line each; may be empty
  std::string command;  ///< command line that drives the found car
};

/// A document (protocol/json.hpp): the numbers with their intervals, measured against predicted
/// motion on the held-out ends, residuals, correlations of the estimates, and the slip that the log covers.
[[nodiscard]] std::string identify_document(const identify::Identification& found,
                                            const IdentifyPageWords& words);

}  // namespace chicane::apps
