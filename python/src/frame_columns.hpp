// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <variant>
#include <vector>

#include "chicane/protocol/frame_fields.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::python {

/// The frames of a run as columns: one for each number of protocol::frame_groups(), lists left out.
class FrameColumns {
 public:
  FrameColumns();
  void add(const telemetry::Frame& frame);
  /// Name: array of the field's type, one element for each control cycle. Gives the columns away. With the
  /// interpreter's lock.
  [[nodiscard]] pybind11::dict take();

 private:
  /// A std::vector<bool> has no array of its own.
  struct Flags {
    std::vector<std::uint8_t> values;
  };
  using Values =
      std::variant<std::vector<double>, Flags, std::vector<std::int8_t>, std::vector<std::uint8_t>,
                   std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::uint64_t>>;
  struct Column {
    const protocol::FrameField* field;
    Values values;
  };
  std::vector<Column> columns_;
};

}  // namespace chicane::python
