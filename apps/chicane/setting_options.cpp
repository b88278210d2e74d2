// SPDX-License-Identifier: MIT
#include "setting_options.hpp"

#include <fmt/format.h>

#include <vector>

#include "chicane/base/text.hpp"

namespace chicane::apps {

void add_setting(CLI::App& command, Options& options, const std::string& name, const std::string& key,
                 const std::string& type, const std::string& help) {
  command
      .add_option_function<std::string>(
          name, [&options, key](const std::string& text) { options.settings.emplace_back(key, text); }, help)
      ->type_name(type);
}

void add_negation(CLI::App& command, const std::string& name, bool& value, const std::string& help) {
  command.add_flag_callback(
      name, [&value] { value = false; }, help);
}

void add_set(CLI::App& command, Options& options) {
  const auto take = [&options](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || equals == 0) {
        throw CLI::ValidationError("--set",
                                   fmt::format("got {}, expected key=value without blanks", printable(text)));
      }
      options.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  };
  command
      .add_option_function<std::vector<std::string>>("--set", take,
                                                     "Setting of `chicane list parameters`; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

}  // namespace chicane::apps
