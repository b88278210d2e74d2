// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chicane::test {

/// One line of a definition in ROS 2's .msg language
/// (https://docs.ros.org/en/jazzy/Concepts/Basic/About-Interfaces.html): a field, or a constant for the field
/// that follows.
struct MessageLine {
  std::string type;      ///< of one element: "float64", "chicane_msgs/Plan"
  std::string array;     ///< "" for one element, "[]" for as many as the message says, "[3]" for that many
  std::string name;      ///< "time_s"
  std::string constant;  ///< the value of a constant; empty for a field
  std::string meaning;   ///< the comment behind it
  std::string title;     ///< the comment of the group that it begins; empty where it begins none
};

/// The lines of the first definition of a text, without those it refers to.
inline std::vector<MessageLine> message_lines(std::string_view text) {
  std::vector<MessageLine> lines;
  std::string title;
  std::istringstream stream{std::string{text.substr(0, text.find("\n===="))}};
  const auto trimmed = [](std::string_view part) {
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
    return std::string{part};
  };
  for (std::string line; std::getline(stream, line);) {
    const std::size_t comment = line.find('#');
    const std::string code = trimmed(std::string_view{line}.substr(0, comment));
    const std::string meaning =
        comment == std::string::npos ? "" : trimmed(std::string_view{line}.substr(comment + 1));
    if (code.empty()) {
      // A title is of one or more lines; an empty line ends it.
      if (meaning.empty()) title.clear();
      if (!title.empty()) title += ' ';
      title += meaning;
      continue;
    }
    const std::size_t space = code.find(' '), bracket = code.find('['), equals = code.find('=');
    MessageLine parsed;
    parsed.type = code.substr(0, std::min(space, bracket));
    if (bracket < space) parsed.array = code.substr(bracket, space - bracket);
    parsed.name = trimmed(code.substr(space + 1, equals == std::string::npos ? equals : equals - space - 1));
    if (equals != std::string::npos) parsed.constant = trimmed(code.substr(equals + 1));
    parsed.meaning = meaning;
    parsed.title = std::exchange(title, "");
    lines.push_back(parsed);
  }
  return lines;
}

}  // namespace chicane::test
