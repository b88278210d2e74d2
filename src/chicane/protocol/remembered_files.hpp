// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"

namespace chicane::protocol {

/// Presets, cars, scenarios and names of tracks, read once for many compositions: to read them takes a
/// quarter of a millisecond, a tenth of a short run. What changes on the disk later is not seen. Keeps up to
/// kMost of them; failures are not kept. One thread.
class RememberedFiles {
 public:
  static constexpr std::size_t kMost = 64;

  /// The document of a name on a shelf; `read` is asked for one that is not known yet.
  [[nodiscard]] Result<Document> document(Shelf shelf, const std::string& name,
                                          const std::function<Result<Document>()>& read);

 private:
  std::map<std::pair<Shelf, std::string>, Document> documents_;
};

/// The same as compose(request), with what is remembered in the place of files.
[[nodiscard]] Result<scenario::Scenario> compose(const Request& request, RememberedFiles& files);

}  // namespace chicane::protocol
