// SPDX-License-Identifier: MIT
#include <string>

#include "chicane/live/pages.hpp"
#include "chicane/recording/html_report.hpp"
#include "conversion.hpp"
#include "faces.hpp"

namespace chicane::python {
namespace {

/// The dashboard with a recording, as one page. Returns its size in bytes.
std::size_t write_page(const std::string& recording, const std::string& name, const std::string& page) {
  const recording::ReportOptions options{
      .output = page, .logs = {{name, recording}}, .bundle = live::document_bundle()};
  return value_of(unlocked([&] { return recording::write_report(options); })).bytes;
}

}  // namespace

void add_view(py::module_& module) {
  module.def("write_page", write_page, py::arg("recording"), py::arg("name"), py::arg("page"));
}

}  // namespace chicane::python
