// SPDX-License-Identifier: MIT
#include "usage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::apps {
namespace {

/// The longest name of an option, as users write it.
std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

/// The option whose name the parser's sentence has as a word; null where there is none.
const CLI::Option* option_in(const CLI::App& command, std::string_view sentence) {
  const CLI::Option* found = nullptr;
  std::size_t at = std::string_view::npos;
  for (const CLI::Option* option : command.get_options()) {
    std::vector<std::string> names{option->get_name(), option->get_name(false, true)};
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : names) {
      const std::size_t place = name.empty() ? std::string_view::npos : sentence.find(name);
      const bool ends =
          place != std::string_view::npos &&
          (place + name.size() == sentence.size() ||
           std::string_view(" :,.").find(sentence[place + name.size()]) != std::string_view::npos);
      if (!ends || place >= at) continue;
      found = option;
      at = place;
    }
  }
  return found;
}

std::string joined_values(const std::vector<std::string>& values) {
  std::vector<std::string> words;
  for (const std::string& value : values) words.push_back(printable(value));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// "a number in [0, 65535]", "NAME|FILE", "one of bash, zsh, fish": what an option's values are.
std::string expectation(const CLI::Option& option) {
  const std::string type = option.get_type_name();  // "P:INT in [0 - 65535]", "SHELL:{bash,zsh,fish}"
  const std::size_t colon = type.find(':');
  std::string rule = colon == std::string::npos ? "" : type.substr(colon + 1);
  if (rule.starts_with('{')) {
    std::string words;
    for (const char c : rule.substr(1, rule.find('}') - 1)) words += c == ',' ? ", " : std::string(1, c);
    return "one of " + words;
  }
  if (const std::size_t range = rule.find(" in ["); range != std::string::npos) {
    std::string limits = rule.substr(range + 4);
    if (const std::size_t dash = limits.find(" - "); dash != std::string::npos) limits.replace(dash, 3, ", ");
    return (rule.starts_with("INT") ? "a whole number in " : "a number in ") + limits;
  }
  if (rule == "POSITIVE") return "a number > 0";
  if (rule == "NONNEGATIVE") return "a number >= 0";
  // "NAME (chicane list tracks)": where such names come from.
  const std::string help = option.get_description();
  const std::size_t list = help.find("chicane list ");
  const std::string name =
      type.substr(0, colon) +
      (list == std::string::npos ? "" : " (" + help.substr(list, help.find(')', list) - list) + ")");
  if (name == "X" || name == "S" || name == "T") return "a number";
  if (name == "N" || name == "P") return "a whole number";
  return name;
}

/// The first word that is no option, and the one that it may have meant.
std::string unexpected(const CLI::App& command) {
  const std::vector<std::string> unknown = command.remaining();
  const auto flag = std::find_if(unknown.begin(), unknown.end(),
                                 [](const std::string& word) { return word.starts_with('-'); });
  const std::string got = flag != unknown.end() ? *flag
                          : unknown.empty()     ? "a word too many"
                                                : unknown.front();
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) names.push_back(name_of(*option));
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string_view best = protocol::nearest(got.substr(0, got.find('=')), views);
  const std::string_view kind = got.starts_with('-') ? "one of its options" : "nothing more";
  return fmt::format("got {}, expected {}{}", printable(got), kind,
                     best.empty() ? "" : fmt::format(" (did you mean {}?)", best));
}

std::string fault_of(const CLI::Option& option, const std::string& sentence) {
  const std::vector<std::string> values = option.results();
  const bool is_once = option.get_items_expected_max() <= 1;
  if (is_once && values.size() > 1)
    return fmt::format("got it {} times ({}), expected once", values.size(), joined_values(values));
  if (const std::size_t own = sentence.find("got "); own != std::string::npos) return sentence.substr(own);
  const bool is_empty = values.empty() || (values.size() == 1 && values.front().empty());
  return fmt::format("got {}, expected {}", is_empty ? "nothing" : joined_values(values),
                     expectation(option));
}

/// The other option that a sentence of the parser names, "--pace excludes --fast".
std::string other(const std::string& sentence, std::string_view verb) {
  return sentence.substr(sentence.find(verb) + verb.size());
}

}  // namespace

std::string usage_fault(const CLI::App& command, const CLI::ParseError& error) {
  const std::string sentence = error.what();
  // Its name is that of the command.
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) return unexpected(command);
  const CLI::Option* option = option_in(command, sentence);
  if (option == nullptr) return sentence;
  const std::string name = name_of(*option);
  if (error.get_name() == "RequiresError")
    return fmt::format("{}: got it alone, expected {} with it", name, other(sentence, " requires "));
  if (error.get_name() == "ExcludesError")
    return fmt::format("{}: got it with {}, expected one of the two", name, other(sentence, " excludes "));
  return fmt::format("{}: {}", name, fault_of(*option, sentence));
}

}  // namespace chicane::apps
