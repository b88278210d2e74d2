// SPDX-License-Identifier: MIT
// List of controllers to choose from by name: options, names and make functions follow from one entry for
// each.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/base/text.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

namespace detail {
/// Name of an entry with underscores in place of dashes.
template <class Entry>
inline constexpr auto kGroupText = [] {
  std::array<char, Entry::kName.size()> text{};
  std::replace_copy(Entry::kName.begin(), Entry::kName.end(), text.begin(), '-', '_');
  return text;
}();
}  // namespace detail

/// Group of a controller's options in files and keys: "pure_pursuit" for "pure-pursuit".
template <class Entry>
inline constexpr std::string_view kOptionGroup{detail::kGroupText<Entry>.data(),
                                               detail::kGroupText<Entry>.size()};

/// Checks options and vehicle of an entry. kInvalidArgument names the first value out of range.
template <class Entry>
[[nodiscard]] Result<void> check(const typename Entry::Options& options,
                                 const model::VehicleParams& vehicle) {
  if (Result<void> valid = model::validate(vehicle); !valid) return valid;
  return check_options(kOptionGroup<Entry>, Entry::options(), &options);
}

/// Controllers to choose from by name. Runs, files, the command line and viewers use these entries only. An
/// entry is a struct beside its controller:
///
///   struct PidEntry {
///     using Options = PidOptions;                        // a struct of its own
///     static constexpr std::string_view kName = "pid";   // small letters and dashes
///     static constexpr std::string_view kMeaning = "…";  // a line for `chicane list controllers`
///     static std::span<const Option> options() noexcept; // a row for each field of Options
///     static constexpr auto kMake = &make_pid;           // from options and model::VehicleParams
///     // Both optional: the option that --speed-mps sets, and options that exclude each other.
///     static constexpr std::string_view kSpeedOption = "speed_reference";
///     static std::vector<OptionContradiction> contradictions(const Options&);
///   };
template <class... Entries>
class ControllerList {
 public:
  /// Options of all controllers; read by std::get<PidOptions>(options).
  using Options = std::tuple<typename Entries::Options...>;

  /// Entry without its type.
  struct Kind {
    std::string_view name;
    std::string_view group;         ///< kOptionGroup
    std::string_view meaning;       ///< one line for people
    std::string_view speed_option;  ///< option that --speed-mps sets; empty: none
    /// Functions of the entry, for the options of all controllers.
    Result<std::unique_ptr<Controller>> (*make)(const Options&, const model::VehicleParams&);
    std::vector<OptionContradiction> (*contradictions)(const Options&);
  };

  static constexpr std::array<std::string_view, sizeof...(Entries)> kNames{Entries::kName...};  ///< in order

  /// All entries, in order.
  [[nodiscard]] static std::span<const Kind> kinds() noexcept {
    static constexpr std::array<Kind, sizeof...(Entries)> kKinds{kind<Entries>()...};
    return kKinds;
  }
  /// Entry of this name; null if there is none.
  [[nodiscard]] static const Kind* find(std::string_view name) noexcept {
    for (const Kind& kind : kinds())
      if (kind.name == name) return &kind;
    return nullptr;
  }

  /// Calls visit.template operator()<Entry>() for each entry, in order.
  template <class Visitor>
  static void for_each(Visitor visit) {
    (visit.template operator()<Entries>(), ...);
  }

  /// Makes a controller. kInvalidArgument "controller: got mpc, expected one of pid, ...", or the error of
  /// the entry's make function.
  [[nodiscard]] static Result<std::unique_ptr<Controller>> make(std::string_view name, const Options& options,
                                                                const model::VehicleParams& vehicle) {
    if (const Kind* kind = find(name)) return kind->make(options, vehicle);
    return fail(ErrorCode::kInvalidArgument,
                "controller: got " + printable(name) + ", expected one of " + joined(kNames));
  }

  /// Applies options to a controller of this list while it drives (Tunable); no effect on other controllers.
  static void configure(Controller& controller, const Options& options,
                        const model::VehicleParams& vehicle) noexcept {
    for_each([&]<class Entry>() {
      using Own = typename Entry::Options;
      if (auto* tunable = dynamic_cast<Tunable<Own>*>(&controller))
        tunable->configure(std::get<Own>(options), vehicle);
    });
  }

 private:
  template <class Entry>
  static constexpr Kind kind() {
    return {Entry::kName,          kOptionGroup<Entry>, Entry::kMeaning,
            speed_option<Entry>(), make_as<Entry>,      contradictions_of<Entry>};
  }
  template <class Entry>
  static constexpr std::string_view speed_option() {
    if constexpr (requires { Entry::kSpeedOption; })
      return Entry::kSpeedOption;
    else
      return {};
  }
  template <class Entry>
  static Result<std::unique_ptr<Controller>> make_as(const Options& options,
                                                     const model::VehicleParams& vehicle) {
    return Entry::kMake(std::get<typename Entry::Options>(options), vehicle);
  }
  template <class Entry>
  static std::vector<OptionContradiction> contradictions_of(const Options& options) {
    if constexpr (requires { &Entry::contradictions; })
      return Entry::contradictions(std::get<typename Entry::Options>(options));
    else
      return {};
  }
};

}  // namespace chicane::controller
