// SPDX-License-Identifier: MIT
#include "chicane/net/http_response.hpp"

#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::net {
namespace {

std::string whole(HttpResponse response, const HttpRequest& request = {}) {
  std::string text = response.head(request), piece;
  while (response.body().next(piece)) text += piece;
  return text;
}

std::string pair(const std::optional<ByteRange>& range) {
  return range ? std::to_string(range->first) + "+" + std::to_string(range->count) : "none";
}

TEST(Range, IsReadAsRfc9110Says) {
  EXPECT_EQ(pair(parse_range("bytes=0-0", 100)), "0+1");
  EXPECT_EQ(pair(parse_range("bytes=10-19", 100)), "10+10");
  EXPECT_EQ(pair(parse_range("bytes=90-", 100)), "90+10");
  EXPECT_EQ(pair(parse_range("bytes=90-1000", 100)), "90+10");
  EXPECT_EQ(pair(parse_range("bytes=-30", 100)), "70+30");
  EXPECT_EQ(pair(parse_range("bytes=-1000", 100)), "0+100");
  EXPECT_EQ(pair(parse_range("bytes=100-", 100)), "100+0") << "nothing there: 416";
  EXPECT_EQ(pair(parse_range("bytes=-0", 100)), "100+0");
  EXPECT_EQ(pair(parse_range("bytes=0-5", 0)), "0+0");
}

TEST(Range, OfOtherKindsIsPassedOver) {
  for (const char* header : {"", "bytes", "bytes=", "bytes=-", "bytes=5-4", "bytes=1-2,4-5", "bytes=a-b",
                             "lines=1-2", "bytes= 1-2", "bytes=+1-2", "bytes=99999999999999999999-"}) {
    EXPECT_EQ(pair(parse_range(header, 100)), "none") << header;
  }
}

TEST(HttpResponse, SendsAFileInPiecesThatMakeTheWhole) {
  std::string content(200'000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * i % 251);
  const test::Folder folder;
  const std::string file = folder.write("file", content);
  const std::string answer = whole(HttpResponse::of({.content_type = "application/x", .file = file}, {}));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Length: 200000\r\n"));
  EXPECT_THAT(answer, HasSubstr("Accept-Ranges: bytes\r\n"));
  EXPECT_TRUE(answer.ends_with("\r\n\r\n" + content));

  HttpResponse response =
      HttpResponse::of({.content_type = "application/x", .file = file}, {.range = "bytes=65530-131080"});
  EXPECT_THAT(response.head({}), StartsWith("HTTP/1.1 206 Partial Content\r\n"));
  EXPECT_THAT(response.head({}), HasSubstr("Content-Range: bytes 65530-131080/200000\r\n"));
  EXPECT_THAT(response.head({}), HasSubstr("Content-Length: 65551\r\n"));
  EXPECT_TRUE(whole(std::move(response)).ends_with("\r\n\r\n" + content.substr(65530, 65551)));
}

TEST(HttpResponse, SaysWhenARangeCannotBeAndWhenAFileIsGone) {
  const std::string answer =
      whole(HttpResponse::of({.content_type = "a/b", .bytes = "hello"}, {.range = "bytes=5-"}));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 416"));
  EXPECT_THAT(answer, HasSubstr("Content-Range: bytes */5\r\n"));
  EXPECT_THAT(whole(HttpResponse::of({.content_type = "a/b", .file = "/no/such"}, {})),
              StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(whole(HttpResponse::of({.content_type = "a/b", .file = "/tmp"}, {})),
              StartsWith("HTTP/1.1 404"));
}

TEST(HttpResponse, SendsTheWholeWhenThePartIsOfAnOlderContent) {
  const Content content{.content_type = "a/b", .bytes = "hello"};
  const std::string tag = tag_of("hello");
  EXPECT_THAT(whole(HttpResponse::of(content, {.range = "bytes=0-1", .if_range = tag})),
              StartsWith("HTTP/1.1 206"));
  EXPECT_THAT(whole(HttpResponse::of(content, {.range = "bytes=0-1", .if_range = "\"older\""})),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(whole(HttpResponse::of(content, {.if_none_match = tag})), StartsWith("HTTP/1.1 304"));
}

TEST(HttpResponse, StopsAtTheEndOfAFileThatHasBecomeShorter) {
  const test::Folder folder;
  const std::string file = folder.write("file", std::string(100'000, 'x'));
  HttpResponse response = HttpResponse::of({.content_type = "a/b", .file = file}, {});
  std::filesystem::resize_file(file, 40'000);  // more than one piece
  std::string piece;
  EXPECT_TRUE(response.body().next(piece));
  EXPECT_FALSE(response.body().next(piece));
  EXPECT_TRUE(response.body().is_short());
}

TEST(HttpResponse, NamesTheFileToSaveAs) {
  const Content preset{.content_type = "application/yaml", .bytes = "a: 1\n", .save_as = "preset.yaml"};
  EXPECT_THAT(whole(HttpResponse::of(preset, {})),
              HasSubstr("Content-Disposition: attachment; filename=\"preset.yaml\"\r\n"));
  EXPECT_THAT(whole(HttpResponse::of({.content_type = "a/b"}, {})), Not(HasSubstr("Disposition")));
}

TEST(Token, IsLongFitsIntoALinkAndIsNeverTheSame) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const Result<std::string> token = make_token();
    ASSERT_TRUE(token) << token.error().message;
    EXPECT_EQ(token->size(), 32U);  // 6 bits each
    EXPECT_EQ(token->find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
              std::string::npos);
    seen.insert(*token);
  }
  EXPECT_EQ(seen.size(), 1000U);
}

TEST(Token, IsTheSameLetterForLetterOnly) {
  EXPECT_TRUE(is_token("abc", "abc"));
  for (const char* given : {"", "ab", "abcd", "abC", "bbc", "xyz"})
    EXPECT_FALSE(is_token(given, "abc")) << given;
  EXPECT_FALSE(is_token("", ""));
}

}  // namespace
}  // namespace chicane::net
