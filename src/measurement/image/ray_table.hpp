// Tables of rays as CSV, which vkfv trace-rays reads and writes.
#pragma once

#include "trace/device/ray_trace.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::measurement {

// Reads rays from CSV whose first line is `x_mm,y_mm,z_mm,l,m,n`. Each further line is a ray; empty lines are passed
// over. Directions are normalised. Throws InputError with line and column for anything else, also for numbers that are
// not finite and directions whose length is not 1 to a millionth.
std::vector<trace::RayInput> read_ray_table(const std::filesystem::path& file);

// Writes rays as CSV whose first line is `x_mm,y_mm,l,m,n,opl_mm,status,z_origin`, with 17 significant digits, so that
// every double reads back. origin: a word for the plane from which the given rays' z counts.
std::string ray_table_text(std::span<const trace::TracedRay> rays, std::string_view origin);

} // namespace vkfv::measurement
