// SPDX-License-Identifier: MIT
#include "chicane/ros/dds.hpp"

namespace chicane::ros {

bool Participant::is_available() noexcept { return false; }

Result<std::unique_ptr<Participant>> Participant::create(const NetworkOptions&) {
  return fail(ErrorCode::kIo,
              "this program was built without Cyclone DDS: install cyclonedds-dev and libssl-dev, configure "
              "anew and build");
}

}  // namespace chicane::ros
