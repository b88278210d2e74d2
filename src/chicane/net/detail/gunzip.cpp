// SPDX-License-Identifier: MIT
#include "chicane/net/detail/gunzip.hpp"

#include <boost/beast/zlib/inflate_stream.hpp>

namespace chicane::net {
namespace {

constexpr std::size_t kHeader = 10;
constexpr std::size_t kTrailer = 8;
constexpr int kExtra = 4, kName = 8, kComment = 16, kHeaderCheck = 2;

/// Where the compressed bytes begin; 0: this is no gzip.
std::size_t skip_header(std::string_view bytes) {
  if (bytes.size() < kHeader + kTrailer || bytes.substr(0, 3) != "\x1f\x8b\x08") return 0;
  const int flags = static_cast<unsigned char>(bytes[3]);
  std::size_t at = kHeader;
  if ((flags & kExtra) != 0) {
    at += 2U + static_cast<unsigned char>(bytes[at]) + 256U * static_cast<unsigned char>(bytes[at + 1]);
  }
  for (const int text : {kName, kComment}) {
    if ((flags & text) == 0) continue;
    const std::size_t end = bytes.find('\0', at);
    if (end == std::string_view::npos) return 0;
    at = end + 1;
  }
  if ((flags & kHeaderCheck) != 0) at += 2;
  return at + kTrailer <= bytes.size() ? at : 0;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<std::string> gunzip(std::string_view compressed) {
  namespace zlib = boost::beast::zlib;
  const std::size_t begin = skip_header(compressed);
  if (begin == 0) return std::nullopt;
  std::uint32_t size = 0;  // in the last four bytes, little endian
  for (int i = 3; i >= 0; --i)
    size = size << 8U |
           static_cast<unsigned char>(compressed[compressed.size() - 4 + static_cast<std::size_t>(i)]);
  const std::string_view body = compressed.substr(begin, compressed.size() - begin - kTrailer);
  if (size > 1100UL * body.size() + 64) return std::nullopt;  // deflate never shrinks more
  std::string plain(size, '\0');
  zlib::inflate_stream stream;
  zlib::z_params params;
  params.next_in = body.data();
  params.avail_in = body.size();
  params.next_out = plain.data();
  params.avail_out = plain.size();
  boost::beast::error_code error;
  stream.write(params, zlib::Flush::none, error);
  if ((error && error != zlib::error::end_of_stream) || params.avail_out != 0) return std::nullopt;
  return plain;
}

bool accepts_gzip(std::string_view accept_encoding) {
  while (!accept_encoding.empty()) {
    const std::size_t comma = accept_encoding.find(',');
    const std::string_view entry = trimmed(accept_encoding.substr(0, comma));
    accept_encoding.remove_prefix(comma == std::string_view::npos ? accept_encoding.size() : comma + 1);
    const std::size_t semicolon = entry.find(';');
    const std::string_view name = trimmed(entry.substr(0, semicolon));
    if (name != "gzip" && name != "x-gzip" && name != "*") continue;
    if (semicolon == std::string_view::npos) return true;
    const std::string_view weight = trimmed(entry.substr(semicolon + 1));
    return weight.find_first_of("123456789", weight.find('=')) != std::string_view::npos;  // not q=0
  }
  return false;
}

}  // namespace chicane::net
