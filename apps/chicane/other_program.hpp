// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// Programs that are installed apart from this one, and do the work of one of its commands.
namespace chicane::apps {

/// The program of that name: in the folder of this one, in libexec/chicane or bin of an installation, or on
/// PATH where `is_on_path`. Empty when there is none.
[[nodiscard]] std::string other_program(const std::string& name, bool is_on_path);

/// The folder that this program lies in; empty where the system does not say.
[[nodiscard]] std::string own_folder();

/// Becomes `program`, called with `words`. Comes back only where it cannot be started, with the reason.
[[nodiscard]] std::string become(const std::string& program, std::vector<std::string> words);

}  // namespace chicane::apps
