// SPDX-License-Identifier: MIT
// Replaces protocol/yaml_tree.cpp in the page, which reads its own files only and has no yaml-cpp.
#include "chicane/protocol/yaml_tree.hpp"

namespace chicane::protocol {

Result<YamlTree> parse_yaml(std::string_view text, const std::string& file) {
  return parse_plain_yaml(text, file);
}

}  // namespace chicane::protocol
