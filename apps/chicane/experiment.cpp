// SPDX-License-Identifier: MIT
#include "experiment.hpp"

#include "chicane/protocol/library.hpp"

namespace chicane::apps {

Result<scenario::Scenario> experiment(const Options& options) {
  return protocol::compose({options.scenario_file, options.settings, options.speed_mps, options.faults});
}

}  // namespace chicane::apps
