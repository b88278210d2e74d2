// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/net/http_response.hpp"
#include "chicane/net/server.hpp"

namespace chicane::net {

/// What GET is answered with: contents that the program makes, then assets.
class Site {
 public:
  using OnGet = std::function<std::optional<Content>(std::string_view path)>;
  Site() = default;
  Site(std::vector<Asset> assets, OnGet on_get);
  /// `target` is path and query; 404 in words where there is nothing.
  [[nodiscard]] HttpResponse answer(std::string_view target, const HttpRequest& asked) const;

 private:
  std::vector<Asset> assets_;
  std::vector<std::string> tags_;  ///< one ETag for each asset
  OnGet on_get_;
};

}  // namespace chicane::net
