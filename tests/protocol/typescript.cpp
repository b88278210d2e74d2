// SPDX-License-Identifier: MIT
#include "protocol/typescript.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <vector>

#include "chicane/protocol/frame_fields.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "protocol/message_definition.hpp"

namespace chicane::test {
namespace {

constexpr std::size_t kWidth = 120;

bool is_number(const MessageLine& line) {
  return line.type.starts_with("float") || line.type.starts_with("int") || line.type.starts_with("uint");
}

/// The type that @foxglove/rosmsg2-serialization reads a field into.
std::string type_of(const MessageLine& line) {
  if (line.type == "string") return line.array.empty() ? "string" : "string[]";
  if (line.type == "float64" && !line.array.empty()) return "Float64Array";
  if (line.array.empty()) {
    if (line.type == "bool") return "boolean";
    if (line.type == "builtin_interfaces/Time") return "Stamp";
    if (line.type == "uint64" || line.type == "int64") return "bigint";
    if (is_number(line)) return "number";
  }
  throw std::logic_error("no TypeScript for " + line.type + line.array + " " + line.name);
}

/// What a field holds when nothing is known: not-a-number where there is one, else nothing, no, none.
std::string unknown_of(const MessageLine& line) {
  const std::string type = type_of(line);
  if (type == "string") return "''";
  if (type == "string[]") return "[]";
  if (type == "boolean") return "false";
  if (type == "bigint") return "0n";
  if (type == "Stamp") return "{ sec: 0, nsec: 0 }";
  if (line.type == "int32") return "-1";  // a place in a list: none
  if (type == "number") return line.type.starts_with("float") ? "NaN" : "0";
  const std::string length = line.array.substr(1, line.array.size() - 2);
  return length.empty() ? "new Float64Array()" : "new Float64Array(" + length + ").fill(NaN)";
}

/// A comment in front of a declaration, broken at 120 characters.
std::string comment(std::string_view text, std::string_view indent) {
  if (text.empty()) return {};
  std::string line = fmt::format("{}/** {} */\n", indent, text);
  if (line.size() <= kWidth) return line;
  line.clear();
  std::string block = fmt::format("{}/**\n", indent);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (!line.empty() && indent.size() + 3 + line.size() + 1 + word.size() > kWidth) {
      block += fmt::format("{} *{}\n", indent, line);
      line.clear();
    }
    line += fmt::format(" {}", word);
    begin = end + 1;
  }
  return block + fmt::format("{} *{}\n{} */\n", indent, line, indent);
}

std::string upper(std::string_view text) {
  std::string result{text};
  for (char& letter : result) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return result;
}

/// What the names have in common, up to an underscore: "RUNG_" of RUNG_BRAKE and RUNG_CONTROLLER.
std::size_t common_prefix(const std::vector<MessageLine>& constants) {
  std::string_view prefix = constants.front().name;
  for (const MessageLine& each : constants) {
    while (!each.name.starts_with(prefix) || !prefix.ends_with('_')) prefix.remove_suffix(1);
  }
  return prefix.size();
}

/// As Biome writes it: in single quotes unless there is one inside.
std::string quoted(std::string_view text) {
  const char quote = text.find('\'') == std::string_view::npos ? '\'' : '"';
  return fmt::format("{}{}{}", quote, text, quote);
}

std::string constants_object(const std::vector<MessageLine>& constants, std::string_view field) {
  const std::size_t prefix = common_prefix(constants);
  std::string text = fmt::format("/** {} */\nexport const {} = {{\n", field,
                                 std::string_view{constants.front().name}.substr(0, prefix - 1));
  for (const MessageLine& each : constants) {
    text += comment(each.meaning, "  ");
    text += fmt::format("  {}: {},\n", std::string_view{each.name}.substr(prefix), each.constant);
  }
  return text + "} as const;\n\n";
}

std::string_view severity_of(Severity severity) {
  switch (severity) {
    case Severity::kOk:
      return "good";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "bad";
  }
  return "unknown";
}

/// The states of a field of Frame in words: "RUNG_WORDS" for the constants "RUNG_BRAKE" and so on.
std::string words_object(const protocol::FrameField& field) {
  std::vector<MessageLine> lines;
  for (const protocol::FrameConstant& each : field.constants) lines.emplace_back().name = each.name;
  const std::size_t prefix = common_prefix(lines);
  const std::string_view object = field.constants.front().name.substr(0, prefix - 1);
  std::string text =
      fmt::format("\n/** Frame.{} in words. */\nexport const {}_WORDS: Words = {{\n", field.name, object);
  for (const protocol::FrameConstant& each : field.constants) {
    text += fmt::format("  [{}.{}]: {{\n    severity: '{}',\n    text: {},\n  }},\n", object,
                        each.name.substr(prefix), severity_of(each.severity.value()), quoted(each.meaning));
  }
  return text + "};\n";
}

std::string words() {
  std::string text =
      "\n/** Each value of a state, for people: without capital and full stop. */\n"
      "export type Words = Readonly<\n"
      "  Record<number, { readonly severity: 'good' | 'warning' | 'bad'; readonly text: string } | "
      "undefined>\n"
      ">;\n";
  for (const protocol::FrameGroup& group : protocol::frame_groups()) {
    for (const protocol::FrameField& field : group.fields)
      if (!field.constants.empty() && field.constants.front().severity) text += words_object(field);
  }
  return text;
}

}  // namespace

std::string typescript(std::string_view name, std::string_view schema) {
  const std::vector<MessageLine> lines = message_lines(schema);
  std::string fields, unknown, objects;
  std::vector<MessageLine> constants;
  for (const MessageLine& line : lines) {
    const bool is_first = &line == &lines.front();
    if (!is_first && !line.title.empty()) fields += fmt::format("\n  // {}\n", line.title);
    if (!line.constant.empty()) {
      constants.push_back(line);
      continue;
    }
    fields += comment(line.meaning, "  ") + fmt::format("  {}: {};\n", line.name, type_of(line));
    unknown += fmt::format("  {}: {},\n", line.name, unknown_of(line));
    if (!constants.empty()) objects += constants_object(constants, fmt::format("{}.{}", name, line.name));
    constants.clear();
  }
  const std::string about = lines.empty() ? "" : lines.front().title;
  return comment(fmt::format("chicane_msgs/msg/{}. {}", name, about), "") +
         fmt::format("export interface {} {{\n{}}}\n\n", name, fields) + objects +
         fmt::format("/** What a {} says when nothing is known. */\n", name) +
         fmt::format("export const UNKNOWN_{}: {} = {{\n{}}};\n", upper(name), name, unknown);
}

std::string typescript_messages() {
  std::string text =
      "// Messages of chicane_msgs as this page reads them. Made from their definitions, which follow from\n"
      "// src/chicane/protocol/frame_fields.cpp and detail/ros_schemas.hpp; do not edit. As long as the\n"
      "// messages are. Renewed by cmake --build --preset release --target renew_fixtures\n"
      "\n"
      "export interface Stamp {\n  sec: number;\n  nsec: number;\n}\n";
  std::string columns;
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    constexpr std::string_view kPackage = "chicane_msgs/msg/";
    if (!topic.type.starts_with(kPackage)) continue;
    const std::string_view name = topic.type.substr(kPackage.size());
    text += "\n" + typescript(name, topic.schema);
    if (name != "Frame") continue;
    for (const MessageLine& line : message_lines(topic.schema)) {
      const bool is_field = line.constant.empty();
      const std::string type = type_of(line);
      if (is_field && (type == "number" || type == "boolean")) columns += fmt::format("  '{}',\n", line.name);
    }
    text +=
        "\n/** The numbers of a frame, and what is yes or no, in its order. */\nexport const FRAME_NUMBERS = "
        "[\n" +
        columns + "] as const;\n" + words();
  }
  return text;
}

}  // namespace chicane::test
