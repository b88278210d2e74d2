// SPDX-License-Identifier: MIT
#include "frame_columns.hpp"

#include <string_view>

#include "conversion.hpp"

namespace chicane::python {

FrameColumns::FrameColumns() {
  const auto values_of = [](std::string_view type) -> std::optional<Values> {
    if (type == "float64") return std::vector<double>{};
    if (type == "bool") return Flags{};
    if (type == "int8") return std::vector<std::int8_t>{};
    if (type == "uint8") return std::vector<std::uint8_t>{};
    if (type == "int32") return std::vector<std::int32_t>{};
    if (type == "uint32") return std::vector<std::uint32_t>{};
    if (type == "uint64") return std::vector<std::uint64_t>{};
    return std::nullopt;
  };
  for (const protocol::FrameGroup& group : protocol::frame_groups()) {
    for (const protocol::FrameField& field : group.fields) {
      if (auto values = values_of(field.type)) columns_.push_back({&field, std::move(*values)});
    }
  }
}

void FrameColumns::add(const telemetry::Frame& frame) {
  for (Column& column : columns_) {
    const auto keep = [&](auto value) {
      using T = decltype(value);
      if constexpr (std::is_same_v<T, bool>) {
        std::get<Flags>(column.values).values.push_back(value ? 1 : 0);
      } else if constexpr (std::is_arithmetic_v<T>) {
        std::get<std::vector<T>>(column.values).push_back(value);
      }
    };
    std::visit(keep, column.field->value(frame));
  }
}

py::dict FrameColumns::take() {
  py::dict columns;
  for (Column& column : columns_) {
    const auto array = [](auto& values) -> py::object {
      if constexpr (std::is_same_v<std::decay_t<decltype(values)>, Flags>)
        return to_array(std::move(values.values)).attr("view")("bool");
      else
        return to_array(std::move(values));
    };
    columns[to_text(column.field->name)] = std::visit(array, column.values);
  }
  columns_.clear();
  return columns;
}

}  // namespace chicane::python
