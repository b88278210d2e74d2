// SPDX-License-Identifier: MIT
#include "chicane/sweep/csv.hpp"

#include <fstream>

#include "chicane/base/file.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

std::string cell_of(const protocol::Json& value) {
  if (value.is_null()) return "";
  return csv_cell(value.is_string() ? value.get<std::string>() : protocol::json_text(value));
}

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

Result<void> write_csv(const std::string& results, const std::string& csv) {
  std::ifstream first(results, std::ios::binary);
  std::string line;
  std::getline(first, line);
  const Result<Header> header = parse_header(line, results);
  if (!header) return fail(header.error());
  FileWriter out(csv);
  std::string row = "run";
  for (const std::string& key : header->keys) row += ',' + cell_of(key);
  for (const std::string& column : header->columns) row += ',' + cell_of(column);
  out.write(row + ",error\r\n");
  const auto read = read_lines(results, [&](const LinePlace& place, const std::string& text) -> Result<void> {
    const protocol::Json run = protocol::parse_json(text);
    if (!run.is_object()) return fail(ErrorCode::kParse, "got no JSON object");
    const protocol::Json settings = run.value("settings", protocol::Json::object());
    row = std::to_string(place.run);
    for (const std::string& key : header->keys) row += ',' + cell_of(settings.value(key, protocol::Json()));
    for (const std::string& column : header->columns)
      row += ',' + cell_of(run.value(column, protocol::Json()));
    out.write(row + ',' + cell_of(run.value("error", protocol::Json())) + "\r\n");
    return out.check();
  });
  return read ? out.finish() : fail(read.error());
}

}  // namespace chicane::sweep
