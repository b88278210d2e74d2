// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::net {

/// Answer to a GET of one path: bytes, or a file on disk.
struct Content {
  std::string content_type{};
  std::string bytes{};
  std::shared_ptr<const std::string> shared{};  ///< instead of `bytes`, for what many ask for
  std::string file{};                           ///< if not empty: content is this file's at each answer
  std::string save_as{};  ///< if not empty: browsers save under this name; no quotes, no line ends
};

/// Part of a content, in bytes from its start.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// Range that a Range header asks for out of `size` bytes: "bytes=0-99", "bytes=100-" or "bytes=-50" (RFC
/// 9110 §14.1.2), cut at the end. None for a form that we do not serve in parts (another unit, several
/// ranges, no range): then the whole is sent. A range without a single byte in it has count 0.
[[nodiscard]] std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t size);

/// An ETag that changes with the content.
[[nodiscard]] std::string tag_of(std::string_view content);

/// Content on its way to a client, piece by piece: memory is one piece.
class Body {
 public:
  Body() = default;
  explicit Body(std::string bytes) : Body(std::make_shared<const std::string>(std::move(bytes))) {}
  explicit Body(std::shared_ptr<const std::string> bytes)
      : owned_{std::move(bytes)}, view_{*owned_}, size_{owned_->size()} {}
  /// Body of bytes that live as long as the program.
  static Body of_view(std::string_view bytes);
  /// Body from a file. kIo if it cannot be read.
  [[nodiscard]] static Result<Body> open(const std::string& file);

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Tag of the whole content, before restrict_to().
  [[nodiscard]] std::string tag() const;
  void restrict_to(ByteRange range);
  /// Takes the next at most 32 KiB; false when nothing is left, or when a file has become shorter than it
  /// was: then is_short().
  [[nodiscard]] bool next(std::string& piece);
  [[nodiscard]] bool is_short() const { return size_ > 0; }

 private:
  std::shared_ptr<const std::string> owned_{};
  std::string_view view_{};  ///< view of owned_, or of the program's bytes
  std::ifstream file_{};
  std::string file_tag_{};
  std::uint64_t at_ = 0;    ///< position of the next byte
  std::uint64_t size_ = 0;  ///< bytes left
};

/// A request, as far as an answer depends on it. Empty where a header is absent.
struct HttpRequest {
  bool is_head = false;
  bool keep_alive = false;
  bool accepts_gzip = false;
  std::string_view range{};
  std::string_view if_range{};
  std::string_view if_none_match{};
};

/// One answer: a head in HTTP/1.1 with our security headers, and what follows it.
class HttpResponse {
 public:
  /// Words for a person; `status` as in "404 Not Found".
  [[nodiscard]] static HttpResponse in_words(std::string_view status, std::string words);
  /// Sends a browser on to another page of ours, with a cookie.
  [[nodiscard]] static HttpResponse see_other(std::string_view location, std::string_view cookie);
  /// A content, whole, by range (206, 416), or not again (304); 404 when its file cannot be read.
  [[nodiscard]] static HttpResponse of(Content content, const HttpRequest& request);
  /// Bytes that live as long as the program, with the ETag that tag_of() gave them; 406 when they are
  /// compressed and the request does not accept gzip.
  [[nodiscard]] static HttpResponse of_asset(std::string_view bytes, std::string_view content_type,
                                             bool is_gzip, std::string_view tag, const HttpRequest& request);

  void add(std::string_view name, std::string_view value);
  /// Head of the answer. Pages may open sockets to the `host` that the request named, and to no other.
  [[nodiscard]] std::string head(const HttpRequest& request, std::string_view host = {}) const;
  [[nodiscard]] Body& body() { return body_; }

 private:
  explicit HttpResponse(std::string_view status) : status_{status} {}
  std::string status_;
  std::vector<std::pair<std::string, std::string>> fields_{};
  Body body_{};
};

/// A file of the dashboard, embedded in the program; no file system at run time.
struct Asset {
  std::string_view path{};  ///< "/index.html"; "/" serves "/index.html"
  std::string_view content_type{};
  std::string_view content{};  ///< gzip-compressed when `gzip`
  bool gzip = false;
};

/// Contents for GET: made by the program, then assets.
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

/// A secret that cannot be guessed: 192 random bits of the system's, as 32 letters, digits, '-' and '_'. kIo
/// where the system has none to give.
[[nodiscard]] Result<std::string> make_token();

/// Whether `given` is `token`, in a time that reveals nothing but the length. Never for an empty token.
[[nodiscard]] bool is_token(std::string_view given, std::string_view token) noexcept;

}  // namespace chicane::net
