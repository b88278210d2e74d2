// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/protocol/yaml_tree.hpp"

namespace chicane::protocol {

/// Parses what the shipped presets and cars are written in: maps of plain scalars, nested by spaces, with
/// comments. Gives the tree that parse_yaml() gives. For builds without yaml-cpp (apps/page): its files are
/// our own, so that this is a check and no defence. kParse, "FILE:LINE: ...", for everything else that YAML
/// has: lists, quotes, braces, tags, anchors, several documents, tabs.
[[nodiscard]] Result<YamlTree> parse_plain_yaml(std::string_view text, const std::string& file);

}  // namespace chicane::protocol
