#include "measurement/image/ray_table.hpp"

#include "core/messages/error.hpp"
#include "core/parsing/number_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace vkfv::measurement {

namespace {

constexpr double unit_length_tolerance = 1e-6; // admits directions written with seven digits

} // namespace

std::vector<trace::RayInput> read_ray_table(const std::filesystem::path& file) {
    std::vector<trace::RayInput> rays;
    for (const auto& row : read_number_table(file, {"x_mm", "y_mm", "z_mm", "l", "m", "n"}, "vkfv trace-rays", "ray")) {
        const auto& v = row.values;
        const double length = std::hypot(v[3], v[4], v[5]);
        if (std::abs(length - 1) > unit_length_tolerance) {
            throw InputError({.where = {.file = file, .line = row.line, .column = 1},
                              .key = "l,m,n",
                              .found = fmt::format("length {}", length),
                              .expected = "direction cosines: a vector of length 1",
                              .remedy = "Normalise the direction."});
        }
        rays.push_back({v[0], v[1], v[2], v[3] / length, v[4] / length, v[5] / length});
    }
    return rays;
}

std::string ray_table_text(std::span<const trace::TracedRay> rays, std::string_view origin) {
    std::string text = "x_mm,y_mm,l,m,n,opl_mm,status,z_origin\n";
    for (const auto& ray : rays) {
        fmt::format_to(std::back_inserter(text), "{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{}\n", ray.x,
                       ray.y, ray.l, ray.m, ray.n, ray.path_length, ray.status, origin);
    }
    return text;
}

} // namespace vkfv::measurement
