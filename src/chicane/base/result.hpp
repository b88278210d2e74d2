// SPDX-License-Identifier: MIT
// Errors, and results that are a value or an error.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace chicane {

/// Kinds of failures in the world outside the program.
enum class ErrorCode { kInvalidArgument, kParse, kNotFound, kIo };

/// A message that can be understood without the source: "scenarios/wet.yaml:14: car.mass_kg: got -900,
/// expected > 0".
struct Error {
  ErrorCode code = ErrorCode::kInvalidArgument;
  std::string message;
};

/// A value, or the reason why there is none.
template <class T>
using Result = tl::expected<T, Error>;

/// Error as a Result, for functions that return one: `return fail(ErrorCode::kIo, "...")`.
inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}
inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

}  // namespace chicane
