#include "specimen/mesh_file.hpp"

#include "specimen/description.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vkfv::specimen {
namespace {

struct Box {
    glm::dvec3 lower = glm::dvec3(std::numeric_limits<double>::infinity());
    glm::dvec3 upper = glm::dvec3(-std::numeric_limits<double>::infinity());
};

Box box_of(const std::vector<glm::dvec3>& points) {
    Box box;
    for (const glm::dvec3& point : points) {
        box.lower = glm::min(box.lower, point);
        box.upper = glm::max(box.upper, point);
    }
    return box;
}

double largest_of(const glm::dvec3& size) {
    return std::max({std::abs(size.x), std::abs(size.y), std::abs(size.z)});
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The mean height of the uppermost surface over points of the bounding rectangle; points without a surface are left
// out.
double mean_height(const Mesh& mesh) {
    constexpr int pixels = 256;
    const Box box = box_of({mesh.vertices.begin(), mesh.vertices.end()});
    const double pitch_x = (box.upper.x - box.lower.x) / pixels;
    const double pitch_y = (box.upper.y - box.lower.y) / pixels;
    const surface::HeightMap map =
        truth({mesh, {}}, pixels, pixels, box.lower.x + 0.5 * pitch_x, box.lower.y + 0.5 * pitch_y, pitch_x, pitch_y);
    double sum = 0;
    int count = 0;
    for (const double height : map.height.values) {
        if (!std::isnan(height)) {
            sum += height;
            ++count;
        }
    }
    return count > 0 ? sum / count : 0;
}

std::string text_of(const glm::dvec3& point) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", point.x, point.y, point.z);
}

// The vertex farthest from most others, and its distance.
struct Outlier {
    glm::dvec3 vertex;
    double distance = 0; // from the medians of the coordinates, largest component
    double usual = 0;    // median of the distances of all vertices
};

Outlier outlier_of(const std::vector<glm::dvec3>& vertices) {
    glm::dvec3 middle;
    std::vector<double> values(vertices.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(vertices, values.begin(), [axis](const glm::dvec3& vertex) { return vertex[axis]; });
        middle[axis] = median_of(values);
    }
    std::ranges::transform(vertices, values.begin(),
                           [&](const glm::dvec3& vertex) { return largest_of(vertex - middle); });
    const auto farthest = std::ranges::max_element(values);
    return {vertices[static_cast<std::size_t>(farthest - values.begin())], *farthest, median_of(values)};
}

// Twice the area; coordinates below largest_length cannot make it overflow.
double area_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::length(glm::cross(b - a, c - a));
}

class Placing {
  public:
    Placing(FileMesh source, const MeshFile& description, const SourceLocation& mention)
        : source_(std::move(source)), description_(description), mention_(mention) {}

    Mesh mesh() {
        scale();
        const Outlier outlier = outlier_of(source_.vertices);
        check_extent(outlier);
        const Box box = box_of(source_.vertices);
        glm::dvec3 centre(0);
        if (description_.centre) {
            centre = 0.5 * (box.lower + box.upper);
        }
        to_float(centre);
        keep_facets_with_area(centre, outlier);
        if (description_.centre) {
            centre.z += mean_height(mesh_);
            to_float(centre);
        }
        const glm::dvec3 extent = box.upper - box.lower;
        spdlog::info("{}: {} triangles, {:.6g} x {:.6g} x {:.6g} mm; {} without area dropped",
                     description_.file.string(), mesh_.triangles.size(), extent.x, extent.y, extent.z, flat_ + lost_);
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected,
                           const std::string& remedy) const {
        throw InputError({mention_, "specimen." + key, found, expected, remedy});
    }

    template <class... Values>
    void warn(fmt::format_string<Values...> text, Values&&... values) const {
        spdlog::warn("{}: {}", description_.file.string(), fmt::format(text, std::forward<Values>(values)...));
    }

    void scale() {
        if (!(std::isfinite(description_.unit) && description_.unit > 0)) {
            fail("unit", fmt::format("{}", description_.unit), "a positive number of mm per unit of the file",
                 "Correct the value in the configuration.");
        }
        for (glm::dvec3& vertex : source_.vertices) {
            vertex *= description_.unit;
        }
    }

    void check_extent(const Outlier& outlier) const {
        const Box box = box_of(source_.vertices);
        const glm::dvec3 extent = box.upper - box.lower;
        constexpr const char* remedy = "Correct specimen.unit if all lengths are wrong, else the file.";
        if (!(std::max(largest_of(box.lower), largest_of(box.upper)) <= largest_length)) {
            fail("file", fmt::format("{}, with a vertex at {}", description_.file.string(), text_of(outlier.vertex)),
                 fmt::format("coordinates up to {} mm", largest_length), remedy);
        }
        if (!(extent.x >= smallest_length && extent.y >= smallest_length)) {
            fail("file", fmt::format("a mesh of {:.6g} x {:.6g} mm", extent.x, extent.y), "a footprint in x and y",
                 "Turn the mesh so that its face looks towards +z, or correct specimen.unit.");
        }
        // No shape that is meant to be seen whole is so lopsided.
        constexpr double far = 1e4;
        if (outlier.distance > far * outlier.usual) {
            warn("a vertex at {} lies {:.3g} mm from where most of the {} vertices are, half of them within {:.3g} mm. "
                 "If it is "
                 "wrong, export the mesh anew; it moves the whole mesh when that is centred",
                 text_of(outlier.vertex), outlier.distance, source_.vertices.size(), outlier.usual);
        }
    }

    void to_float(const glm::dvec3& origin) {
        mesh_.vertices.clear();
        for (const glm::dvec3& vertex : source_.vertices) {
            mesh_.vertices.emplace_back(vertex - origin);
        }
    }

    // Keeps the facets that have an area, as no ray meets others. Facets flat in the file are dropped; those that only
    // rounding to float flattens are counted, as they belong to the surface.
    void keep_facets_with_area(const glm::dvec3& centre, const Outlier& outlier) {
        constexpr double thinnest = 1e-9; // relative to the squared length: rounding of a line in the file
        std::vector<double> sides;
        for (const glm::uvec3& triangle : source_.triangles) {
            const glm::dvec3 a = source_.vertices[triangle.x], b = source_.vertices[triangle.y],
                             c = source_.vertices[triangle.z];
            const auto corner = [&](std::uint32_t vertex) { return glm::dvec3(mesh_.vertices[vertex]); };
            const double exact_area = area_of(a, b, c);
            const bool has_area = exact_area > thinnest * std::pow(std::max(glm::length(b - a), glm::length(c - a)), 2);
            const bool kept = area_of(corner(triangle.x), corner(triangle.y), corner(triangle.z)) > 0;
            if (kept) {
                mesh_.triangles.push_back(triangle);
            }
            flat_ += !kept && !has_area ? 1 : 0;
            lost_ += !kept && has_area ? 1 : 0;
            if (has_area) {
                sides.push_back(std::sqrt(exact_area));
            }
        }
        if (mesh_.triangles.empty() && lost_ == 0) {
            fail("file", fmt::format("{} triangles, all without area", flat_), "at least one triangle with an area",
                 "Correct the unit or export the mesh anew.");
        }
        if (2 * flat_ > source_.triangles.size()) {
            warn("{} of {} triangles have no area and are dropped", flat_, source_.triangles.size());
        }
        if (!sides.empty()) {
            check_rounding(median_of(std::move(sides)), centre, outlier);
        }
    }

    void check_rounding(double side, const glm::dvec3& centre, const Outlier& outlier) const {
        double farthest = 0;
        for (const glm::vec3& vertex : mesh_.vertices) {
            farthest = std::max(farthest, largest_of(glm::dvec3(vertex)));
        }
        const double step = farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
        // Limits in units of rounding per facet side: below a few steps the facet's shape is lost, below some tens its
        // slope is visibly wrong.
        constexpr double fewest_steps = 4, fine_steps = 64;
        const std::size_t whole = mesh_.triangles.size();
        if (2 * lost_ > whole || side < fewest_steps * step) {
            fail("file",
                 fmt::format(
                     "{}: of {} triangles {} lose their area, since coordinates up to {:.3g} mm are kept to {:.3g} mm "
                     "and half the triangles are less than {:.3g} mm wide",
                     description_.file.string(), whole + lost_, lost_, farthest, step, side),
                 "a mesh whose facets are not lost in its extent",
                 fmt::format("Look at the vertex at {}; bring the mesh near the origin, or set centre = true.",
                             text_of(outlier.vertex)));
        }
        if (lost_ > 0 || side < fine_steps * step) {
            warn("its coordinates, up to {:.3g} mm from {}, are kept to {:.3g} mm, and half its triangles are less "
                 "than {:.3g} "
                 "mm wide: {} of {} lose their area and are dropped. Bring the mesh near the origin, or set centre = "
                 "true",
                 farthest, text_of(centre), step, side, lost_, whole + lost_);
        }
    }

    FileMesh source_;
    const MeshFile& description_;
    const SourceLocation& mention_;
    Mesh mesh_;
    std::size_t flat_ = 0; // flat in the file
    std::size_t lost_ = 0; // flattened by rounding to float
};

} // namespace

Mesh placed_mesh(FileMesh source, const MeshFile& description, const SourceLocation& mention) {
    return Placing(std::move(source), description, mention).mesh();
}

} // namespace vkfv::specimen
