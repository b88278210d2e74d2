// SPDX-License-Identifier: MIT
// Answers of a server to HTTP requests: contents and files by range, pages of the dashboard, tokens.
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
  std::string content_type{};  ///< media type, like "text/plain"
  std::string bytes{};
  std::shared_ptr<const std::string> shared{};  ///< content without a copy, before `bytes`; null: none
  std::string file{};                           ///< path of a file that is read at each answer; empty: none
  std::string save_as{};  ///< if not empty: browsers save under this name; no quotes, no line ends
};

/// Part of a content, in bytes from its start.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// Range that a Range header names out of `size` bytes: "bytes=0-99", "bytes=100-" or "bytes=-50" (RFC 9110
/// §14.1.2), cut at the end. None for other forms (another unit, several ranges, no range): the whole content
/// is the answer to them. A range that lies beyond the content has count 0.
[[nodiscard]] std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t size);

/// ETag of a content: a hash in quotes, which changes with the content.
[[nodiscard]] std::string tag_of(std::string_view content);

/// Content of an answer, read piece by piece: of a file one piece at a time is in memory.
class Body {
 public:
  Body() = default;
  explicit Body(std::string bytes) : Body(std::make_shared<const std::string>(std::move(bytes))) {}
  explicit Body(std::shared_ptr<const std::string> bytes)
      : owned_{std::move(bytes)}, view_{*owned_}, size_{owned_->size()} {}
  /// Body of bytes that live as long as the program.
  static Body of_view(std::string_view bytes);
  /// Body from a file. Fails with kIo if the file cannot be read.
  [[nodiscard]] static Result<Body> open(const std::string& file);

  /// Number of bytes left.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// ETag of the whole content. Before restrict_to() and next().
  [[nodiscard]] std::string tag() const;
  /// Leaves `range` of the whole content. Before next().
  void restrict_to(ByteRange range);
  /// Takes the next piece of at most 32 KiB; false when nothing is left or is_short().
  [[nodiscard]] bool next(std::string& piece);
  /// After next() returned false: whether bytes are missing, as the file has become shorter since open().
  [[nodiscard]] bool is_short() const { return size_ > 0; }

 private:
  std::shared_ptr<const std::string> owned_{};  ///< null for views and files
  std::string_view view_{};                     ///< bytes of owned_ or of of_view(); empty for files
  std::ifstream file_{};
  std::string file_tag_{};  ///< ETag of the file: its size and time of change; empty: tag_of(view_)
  std::uint64_t at_ = 0;    ///< position of the next byte
  std::uint64_t size_ = 0;  ///< bytes left
};

/// A request, as far as an answer depends on it. A text is empty where its header is absent.
struct HttpRequest {
  bool is_head = false;              ///< HEAD: the head of the answer alone
  bool keep_alive = false;           ///< the connection stays open after the answer
  bool accepts_gzip = false;         ///< Accept-Encoding names gzip
  std::string_view range{};          ///< Range: wanted part
  std::string_view if_range{};       ///< If-Range: ETag for which the part is wanted
  std::string_view if_none_match{};  ///< If-None-Match: ETag of the content that the client has
};

/// One answer in HTTP/1.1: a status, header fields with the security headers of this server, and a body.
class HttpResponse {
 public:
  /// Answer with a sentence for a person; `status` as in "404 Not Found".
  [[nodiscard]] static HttpResponse in_words(std::string_view status, std::string words);
  /// Redirects a browser to another page of this server (303), with a cookie.
  [[nodiscard]] static HttpResponse see_other(std::string_view location, std::string_view cookie);
  /// Answer with a content: the whole (200), a range (206, 416), or nothing if the client has it (304); 404
  /// when its file cannot be read.
  [[nodiscard]] static HttpResponse of(Content content, const HttpRequest& request);
  /// Answer with bytes that live as long as the program; `tag` is tag_of() them. 406 when they are compressed
  /// and the request does not accept gzip.
  [[nodiscard]] static HttpResponse of_asset(std::string_view bytes, std::string_view content_type,
                                             bool is_gzip, std::string_view tag, const HttpRequest& request);

  /// Adds a header field.
  void add(std::string_view name, std::string_view value);
  /// Text of the answer up to its body. The policy in it lets pages open WebSockets to `host`, the Host
  /// header of the request, and to no other host.
  [[nodiscard]] std::string head(const HttpRequest& request, std::string_view host = {}) const;
  [[nodiscard]] Body& body() { return body_; }

 private:
  explicit HttpResponse(std::string_view status) : status_{status} {}
  std::string status_;                                         ///< "200 OK"
  std::vector<std::pair<std::string, std::string>> fields_{};  ///< names and values of header fields
  Body body_{};
};

/// A file of the dashboard, embedded in the program; no file system at run time.
struct Asset {
  std::string_view path{};  ///< "/index.html"; "/" serves "/index.html"
  std::string_view content_type{};
  std::string_view content{};  ///< gzip-compressed when `gzip`
  bool gzip = false;
};

/// Contents for GET: those of the program (OnGet) first, else assets.
class Site {
 public:
  using OnGet = std::function<std::optional<Content>(std::string_view path)>;
  Site() = default;
  Site(std::vector<Asset> assets, OnGet on_get);
  /// Answer to a GET of `target`, path and query; 404 where there is neither content nor asset.
  [[nodiscard]] HttpResponse answer(std::string_view target, const HttpRequest& asked) const;

 private:
  std::vector<Asset> assets_;
  std::vector<std::string> tags_;  ///< one ETag for each asset
  OnGet on_get_;
};

/// Secret that cannot be guessed: 192 random bits of the system as 32 letters, digits, '-' and '_'. Fails
/// with kIo if the system gives no random bits.
[[nodiscard]] Result<std::string> make_token();

/// Whether `given` is `token`, compared in a time that reveals nothing but the length. False for an empty
/// token.
[[nodiscard]] bool is_token(std::string_view given, std::string_view token) noexcept;

}  // namespace chicane::net
