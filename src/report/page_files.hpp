// The files of src/report/page, the libraries that pages carry, and assets/schemas, embedded when vkfv is built.
#pragma once

#include <string_view>

namespace vkfv::report {

// A file by its name: "page.css", "d3.min.js", "results.schema.json". std::out_of_range for any other.
std::string_view page_file(std::string_view name);

} // namespace vkfv::report
