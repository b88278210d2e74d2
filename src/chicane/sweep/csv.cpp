// SPDX-License-Identifier: MIT
#include "chicane/sweep/csv.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "chicane/protocol/json.hpp"
#include "chicane/sweep/page_text.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

std::string cell_of(const protocol::Json& value) {
  if (value.is_null()) return "";
  return csv_cell(value.is_string() ? value.get<std::string>() : protocol::json_text(value));
}

}  // namespace

Result<void> write_csv(const std::string& results, const std::string& csv) {
  std::ifstream first(results, std::ios::binary);
  std::string line;
  std::getline(first, line);
  const Result<Header> header = parse_header(line, results);
  if (!header) return fail(header.error());
  std::ofstream out(csv, std::ios::binary | std::ios::trunc);
  if (!out) return fail(ErrorCode::kIo, fmt::format("{}: cannot be written: {}", csv, std::strerror(errno)));
  out << "run";
  for (const std::string& key : header->keys) out << ',' << cell_of(key);
  for (const std::string& column : header->columns) out << ',' << cell_of(column);
  out << ",error\r\n";
  const auto read = read_lines(results, [&](const LinePlace& place, const std::string& text) -> Result<void> {
    const protocol::Json run = protocol::parse_json(text);
    if (!run.is_object()) return fail(ErrorCode::kParse, "got no JSON object");
    const protocol::Json settings = run.value("settings", protocol::Json::object());
    out << place.run;
    for (const std::string& key : header->keys) out << ',' << cell_of(settings.value(key, protocol::Json()));
    for (const std::string& column : header->columns)
      out << ',' << cell_of(run.value(column, protocol::Json()));
    out << ',' << cell_of(run.value("error", protocol::Json())) << "\r\n";
    return {};
  });
  if (!read) return fail(read.error());
  out.close();
  if (!out) return fail(ErrorCode::kIo, fmt::format("{}: cannot be written: the disk is full or gone", csv));
  return {};
}

}  // namespace chicane::sweep
