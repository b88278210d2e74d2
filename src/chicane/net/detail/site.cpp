// SPDX-License-Identifier: MIT
#include "chicane/net/detail/site.hpp"

#include <algorithm>
#include <utility>

namespace chicane::net {

Site::Site(std::vector<Asset> assets, OnGet on_get) : assets_{std::move(assets)}, on_get_{std::move(on_get)} {
  for (const Asset& asset : assets_) tags_.push_back(tag_of(asset.content));
}

HttpResponse Site::answer(std::string_view target, const HttpRequest& asked) const {
  const std::string_view path = target.substr(0, target.find('?'));
  std::optional<Content> content;
  if (on_get_) content = on_get_(path);
  if (content) return HttpResponse::of(std::move(*content), asked);
  const std::string_view wanted = path == "/" ? "/index.html" : path;
  const auto asset = std::find_if(assets_.begin(), assets_.end(),
                                  [&](const Asset& candidate) { return candidate.path == wanted; });
  if (asset == assets_.end()) return HttpResponse::in_words("404 Not Found", "no such page");
  const std::string& tag = tags_[static_cast<std::size_t>(asset - assets_.begin())];
  return HttpResponse::of_asset(asset->content, asset->content_type, asset->gzip, tag, asked);
}

}  // namespace chicane::net
