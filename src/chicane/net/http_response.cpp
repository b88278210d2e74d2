// SPDX-License-Identifier: MIT
// Answers to HTTP requests: ranges of contents, ETags, security headers, and the token of visitors.
#include "chicane/net/http_response.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "chicane/base/random.hpp"
#include "chicane/base/text.hpp"

namespace chicane::net {
namespace {

constexpr std::uint64_t kPiece = 32UL * 1024UL;  // [byte] sent at a time; chosen: memory of a slow connection
constexpr std::string_view kNotModified = "304 Not Modified";
constexpr std::string_view kSecurityHeaders =
    "Content-Security-Policy: default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' "
    "'unsafe-inline'; img-src 'self' data: blob:; worker-src 'self' blob:; connect-src 'self'{}; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";

/// Sources of a content policy for WebSockets of `host`, which 'self' of some browsers leaves out. Empty for
/// IPv6 addresses, which content policies cannot name.
std::string sockets_of(std::string_view host) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-:";
  if (host.empty() || host.find_first_not_of(kPlain) != std::string_view::npos) return "";
  return fmt::format(" ws://{0} wss://{0}", host);
}

}  // namespace

std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!header.starts_with(kUnit)) return std::nullopt;
  const std::string_view range = header.substr(kUnit.size());
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const std::string_view first_text = range.substr(0, dash), last_text = range.substr(dash + 1);
  const auto first = count_in(first_text), last = count_in(last_text);
  if (first_text.empty() && last) return ByteRange{size - std::min(*last, size), std::min(*last, size)};
  if (!first || (!last && !last_text.empty()) || (last && *last < *first)) return std::nullopt;
  if (*first >= size) return ByteRange{size, 0};
  const std::uint64_t end = last ? std::min(*last, size - 1) : size - 1;
  return ByteRange{*first, end - *first + 1};
}

std::string tag_of(std::string_view content) {
  Fnv hash;
  hash.add(std::uint64_t{content.size()});
  for (std::size_t i = 0; i < content.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, content.data() + i, std::min(sizeof(word), content.size() - i));
    hash.add(word);
  }
  return fmt::format("\"{:016x}\"", hash.value());
}

Body Body::of_view(std::string_view bytes) {
  Body body;
  body.view_ = bytes;
  body.size_ = bytes.size();
  return body;
}

Result<Body> Body::open(const std::string& file) {
  struct stat status {};
  Body body;
  body.file_.open(file, std::ios::binary);
  if (!body.file_ || ::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
    return fail(ErrorCode::kIo, file + ": cannot be read");
  body.size_ = static_cast<std::uint64_t>(status.st_size);
  body.file_tag_ =
      fmt::format("\"{:x}-{:x}-{:x}\"", status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
  return body;
}

std::string Body::tag() const { return file_tag_.empty() ? tag_of(view_) : file_tag_; }

void Body::restrict_to(ByteRange range) {
  at_ += range.first;
  size_ = range.count;
  if (file_.is_open()) file_.seekg(static_cast<std::streamoff>(at_));
}

bool Body::next(std::string& piece) {
  const std::uint64_t count = std::min(size_, kPiece);
  if (count == 0) return false;
  if (file_.is_open()) {
    piece.resize(count);
    if (!file_.read(piece.data(), static_cast<std::streamsize>(count))) return false;
  } else {
    piece = view_.substr(at_, count);
  }
  at_ += count;
  size_ -= count;
  return true;
}

HttpResponse HttpResponse::in_words(std::string_view status, std::string words) {
  HttpResponse response(status);
  response.add("Content-Type", "text/plain; charset=utf-8");
  response.body_ = Body(std::move(words) + "\n");
  return response;
}

HttpResponse HttpResponse::see_other(std::string_view location, std::string_view cookie) {
  HttpResponse response = in_words("303 See Other", "the token is kept as a cookie");
  response.add("Location", location);
  response.add("Set-Cookie", cookie);
  return response;
}

HttpResponse HttpResponse::of(Content content, const HttpRequest& request) {
  Body body;
  if (content.file.empty()) {
    body = content.shared ? Body(std::move(content.shared)) : Body(std::move(content.bytes));
  } else {
    Result<Body> opened = Body::open(content.file);
    if (!opened) return in_words("404 Not Found", "the file is gone");
    body = std::move(*opened);
  }
  const std::uint64_t size = body.size();
  const std::string tag = body.tag();
  HttpResponse response("200 OK");
  if (request.if_none_match == tag) {
    response.status_ = kNotModified;
    body = {};
  } else if (!request.is_head && (request.if_range.empty() || request.if_range == tag)) {
    if (const auto range = parse_range(request.range, size); range && range->count > 0) {
      response.status_ = "206 Partial Content";
      response.add("Content-Range",
                   fmt::format("bytes {}-{}/{}", range->first, range->first + range->count - 1, size));
      body.restrict_to(*range);
    } else if (range) {
      response = in_words("416 Range Not Satisfiable", fmt::format("there are {} bytes", size));
      response.add("Content-Range", fmt::format("bytes */{}", size));
      return response;
    }
  }
  response.add("Content-Type", content.content_type);
  response.add("ETag", tag);
  response.add("Accept-Ranges", "bytes");
  if (!content.save_as.empty())
    response.add("Content-Disposition", fmt::format("attachment; filename=\"{}\"", content.save_as));
  response.body_ = std::move(body);
  return response;
}

HttpResponse HttpResponse::of_asset(std::string_view bytes, std::string_view content_type, bool is_gzip,
                                    std::string_view tag, const HttpRequest& request) {
  if (is_gzip && !request.accepts_gzip)
    return in_words("406 Not Acceptable", "this file is sent with gzip only: curl --compressed asks for it");

  const bool is_known = request.if_none_match == tag;
  HttpResponse response(is_known ? kNotModified : "200 OK");
  response.add("Content-Type", content_type);
  if (is_gzip) response.add("Content-Encoding", "gzip");
  response.add("ETag", tag);
  if (!is_known) response.body_ = Body::of_view(bytes);
  return response;
}

void HttpResponse::add(std::string_view name, std::string_view value) { fields_.emplace_back(name, value); }

std::string HttpResponse::head(const HttpRequest& request, std::string_view host) const {
  std::string text = fmt::format("HTTP/1.1 {}\r\nServer: chicane\r\nCache-Control: no-cache\r\n", status_);
  text += fmt::format(kSecurityHeaders, sockets_of(host));
  for (const auto& [name, value] : fields_) text += fmt::format("{}: {}\r\n", name, value);
  if (!request.keep_alive) text += "Connection: close\r\n";
  if (status_ != kNotModified) text += fmt::format("Content-Length: {}\r\n", body_.size());
  return text + "\r\n";
}

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

Result<std::string> make_token() {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  static_assert(kLetters.size() == 64);  // 6 bits each
  std::array<unsigned char, 32> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return fail(ErrorCode::kIo, std::string("token: no random bytes: ") + std::strerror(errno));
  std::string token;
  for (const unsigned char byte : bytes) token += kLetters[byte & 63U];
  return token;
}

bool is_token(std::string_view given, std::string_view token) noexcept {
  if (token.empty() || given.size() != token.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i]);
  return difference == 0;
}

}  // namespace chicane::net
