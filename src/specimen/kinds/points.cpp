#include "specimen/kinds/points.hpp"

#include "specimen/delaunay.hpp"
#include "specimen/file_keys.hpp"
#include "specimen/lengths.hpp"
#include "surface_files/lengths.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const FileKey points_key = needed_file_key("The points: text with x, y and z in the first three columns of each line, "
                                           "in any order; +z is towards the objective.");
const ChoiceKey<double> points_unit_key = for_example("\"mm\"", unit_key(needed, "Of the points' coordinates."));
const ChoiceKey<double> height_unit_key = [] {
    auto key = unit_key(needed, "Of z, where x and y have another.");
    key.name = "height_unit";
    key.fallback = Default::in_words("that of x and y");
    return key;
}();
const NumberKey longest_edge_key("longest_edge_um", NumberRange::positive(), Default::in_words("any length"),
                                 "Triangles with a longer edge, seen along z, are left out: gaps and bays between the "
                                 "points stay open.");

// Replaces several points at one x and y by one of the mean height.
std::vector<glm::dvec3> with_mean_heights(std::vector<glm::dvec3> points, const std::vector<std::uint32_t>& place) {
    std::vector<std::uint32_t> count(points.size(), 0);
    for (std::size_t k = 0; k < points.size(); ++k) {
        glm::dvec3& first = points[place[k]];
        ++count[place[k]];
        first.z += place[k] == k ? 0 : (points[k].z - first.z) / count[place[k]];
    }
    return points;
}

// Refuses points of which one lies so far off that the others cannot be distinguished on the grid of the triangulation.
void require_apart(const std::vector<glm::dvec2>& points, const std::vector<std::uint32_t>& place,
                   const std::filesystem::path& file) {
    std::size_t lost = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        lost += points[place[k]] != points[k] ? 1 : 0;
    }
    if (2 * lost > points.size()) {
        const auto distance = [&](const glm::dvec2& point) { return glm::distance(point, points.front()); };
        const glm::dvec2 farthest = std::ranges::max(points, {}, distance);
        throw InputError(
            {{file, 0, 0, {}},
             "points",
             fmt::format("{} of {} points in no other place than their neighbours, beside the extent of all", lost,
                         points.size()),
             "points that are told apart by 2^-32 of their extent",
             fmt::format("Look at the point at x = {:.6g}, y = {:.6g}.", farthest.x, farthest.y)});
    }
}

// Converts coordinates whose unit the file states to the units of the keys, which the code that follows expects.
void take_stated_units(double unit, double height_unit, const std::filesystem::path& file, FilePoints& read) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto stated = read.units[static_cast<std::size_t>(axis)];
        const double given = axis == 2 ? height_unit : unit;
        if (!stated || !surface::contradicts(given, *stated)) {
            continue;
        }
        spdlog::warn("{}: the unit of {} is that of the columns' names, \"{}\", not that of the configuration",
                     file.string(), "xyz"[axis], read.column_names);
        for (glm::dvec3& point : read.points) {
            point[axis] *= *stated / given;
        }
    }
}

// The mesh of the triangles, without points that no triangle uses.
FileMesh used(const std::vector<glm::dvec3>& points, std::vector<glm::uvec3> triangles) {
    constexpr std::uint32_t unused = ~0u;
    std::vector<std::uint32_t> place(points.size(), unused);
    FileMesh mesh;
    for (glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t& index = place[triangle[corner]];
            if (index == unused) {
                index = static_cast<std::uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back(points[triangle[corner]]);
            }
            triangle[corner] = index;
        }
    }
    mesh.triangles = std::move(triangles);
    return mesh;
}

} // namespace

std::vector<const Key*> Points::keys() {
    auto all = mesh_file_keys(points_key, points_unit_key);
    all.insert(all.end(), {&height_unit_key, &longest_edge_key});
    return all;
}

Points Points::read(const Section& section) {
    Points points;
    read_mesh_file(section, points_key, points_unit_key, points);
    points.longest_edge = from_um(section.number_if_given(longest_edge_key).value_or(0));
    if (section.has(height_unit_key)) {
        points.height_unit = section.choice(height_unit_key);
    }
    return points;
}

Mesh Points::mesh(const SourceLocation& mention) const {
    FilePoints read = read_points(file, mention);
    take_stated_units(unit, height_unit > 0 ? height_unit : unit, file, read);
    auto& points = read.points;
    const std::size_t not_measured = read.not_measured;
    std::vector<glm::dvec2> plane(points.begin(), points.end());
    auto [triangles, place] = delaunay(plane);
    require_apart(plane, place, file);
    if (triangles.empty()) {
        throw InputError({{file, 0, 0, {}},
                          "points",
                          fmt::format("{} points, all on a line in x and y", points.size()),
                          "at least three points that span a triangle",
                          "Export points of a surface, with x and y in the first two columns."});
    }
    const double longest = longest_edge / unit;
    const auto is_long = [&](const glm::uvec3& triangle) {
        const glm::dvec2 &a = plane[triangle.x], &b = plane[triangle.y], &c = plane[triangle.z];
        return std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}) > longest;
    };
    const auto left_out = longest > 0 ? std::erase_if(triangles, is_long) : 0;
    if (triangles.empty()) {
        require_um(false, mention, "longest_edge_um", longest_edge,
                   fmt::format("a length that leaves at least one of {} triangles", left_out));
    }
    std::size_t repeated = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
        repeated += place[k] != k ? 1 : 0;
    }
    points = with_mean_heights(std::move(points), place);
    if (height_unit > 0) {
        for (glm::dvec3& point : points) {
            point.z *= height_unit / unit;
        }
    }
    spdlog::info("{}: {} points, {} lines not measured, {} points at the place of another and averaged with it; {} "
                 "triangles left out as too long",
                 file.string(), points.size(), not_measured, repeated, left_out);
    return placed_mesh(used(points, std::move(triangles)), *this, mention);
}

} // namespace vkfv::specimen
