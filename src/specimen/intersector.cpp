#include "specimen/intersector.hpp"

#include "core/mathematics/box_tree.hpp"
#include "specimen/analytic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace vkfv::specimen {
namespace {

using physics::f64::Hit;
using physics::f64::SpecimenRecord;

constexpr double infinity = std::numeric_limits<double>::infinity();
// The margin of intervals that only preselect candidates: far above the rounding of a few operations, far below any
// pitch.
constexpr double selection_margin = 1e-12;

// A ray with the triangle test of S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", JCGT 2, 1
// (2013): in coordinates sheared so that the ray is the third axis, the edge functions of neighbours have exactly
// opposite values on their common edge, and zero counts as inside; no ray passes between two triangles.
class Ray {
  public:
    Ray(const glm::dvec3& origin, const glm::dvec3& direction) : origin_(origin), direction_(direction) {
        const glm::dvec3 size = glm::abs(direction);
        z_ = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        x_ = (z_ + 1) % 3;
        y_ = (z_ + 2) % 3;
        shear_ = glm::dvec3(direction[x_], direction[y_], 1.0) / direction[z_];
    }

    // The distance to the triangle; none unless it is > 0.
    std::optional<double> meet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
        const glm::dvec3 pa = shear(a);
        const glm::dvec3 pb = shear(b);
        const glm::dvec3 pc = shear(c);
        const double u = pc.x * pb.y - pc.y * pb.x;
        const double v = pa.x * pc.y - pa.y * pc.x;
        const double w = pb.x * pa.y - pb.y * pa.x;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) {
            return std::nullopt;
        }
        const double sum = u + v + w;
        if (sum == 0) { // the ray lies in the triangle's plane
            return std::nullopt;
        }
        const double distance = (u * pa.z + v * pb.z + w * pc.z) / sum;
        return distance > 0 ? std::optional(distance) : std::nullopt;
    }

    const glm::dvec3& origin() const { return origin_; }
    const glm::dvec3& direction() const { return direction_; }
    glm::dvec3 at(double distance) const { return origin_ + distance * direction_; }

  private:
    glm::dvec3 shear(const glm::dvec3& point) const {
        const glm::dvec3 p = point - origin_;
        return {p[x_] - shear_.x * p[z_], p[y_] - shear_.y * p[z_], shear_.z * p[z_]};
    }
    glm::dvec3 origin_;
    glm::dvec3 direction_;
    int x_, y_, z_;
    glm::dvec3 shear_;
};

struct Interval {
    double start = 0;
    double stop = infinity;
    bool empty() const { return !(start <= stop); }

    // Clips the interval of distances to lower <= coordinate <= upper.
    void clip(double origin, double direction, double lower, double upper) {
        if (direction == 0) {
            if (origin < lower || origin > upper) {
                stop = -infinity;
            }
            return;
        }
        const double a = (lower - origin) / direction;
        const double b = (upper - origin) / direction;
        start = std::max(start, std::min(a, b));
        stop = std::min(stop, std::max(a, b));
    }
};

Hit no_hit() {
    Hit hit{};
    hit.found = 0;
    hit.distance = infinity;
    return hit;
}

class FieldWalk {
  public:
    explicit FieldWalk(const HeightField& field) : field_(field) {
        const auto [lowest, highest] = std::minmax_element(field.heights.values.begin(), field.heights.values.end());
        bottom_ = static_cast<double>(*lowest);
        top_ = static_cast<double>(*highest);
        margin_ = selection_margin * std::max({std::abs(field.x_min), std::abs(field.x_max()), std::abs(field.y_min),
                                               std::abs(field.y_max()), std::abs(bottom_), std::abs(top_)});
    }

    Hit hit(const glm::dvec3& origin, const glm::dvec3& direction) const {
        const Ray ray(origin, direction);
        const double margin =
            margin_ + selection_margin * (std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z));
        Interval inside;
        inside.clip(origin.x, direction.x, field_.x_min - margin, field_.x_max() + margin);
        inside.clip(origin.y, direction.y, field_.y_min - margin, field_.y_max() + margin);
        inside.clip(origin.z, direction.z, bottom_ - margin, top_ + margin);
        Hit nearest = no_hit();
        if (inside.empty()) {
            return nearest;
        }
        // The walk goes strip by strip along the axis that the ray covers faster; in each strip it tests the few cells
        // that the ray crosses, each enlarged by a margin.
        const bool by_columns = std::abs(direction.x) >= std::abs(direction.y);
        const int main = by_columns ? 0 : 1;
        const int cells_main = (by_columns ? field_.heights.columns : field_.heights.rows) - 1;
        const double pitch_main = by_columns ? field_.pitch_x : field_.pitch_y;
        const double min_main = by_columns ? field_.x_min : field_.y_min;
        const double from = ray.at(inside.start)[main];
        const double to = ray.at(inside.stop)[main];
        const int step = direction[main] < 0 ? -1 : 1;
        const int first = cell(from - step * margin, min_main, pitch_main, cells_main);
        const int last = cell(to + step * margin, min_main, pitch_main, cells_main);
        for (int strip = first; step * (last - strip) >= 0 && nearest.found == 0; strip += step) {
            Interval part = inside;
            part.clip(origin[main], direction[main], min_main + strip * pitch_main - margin,
                      min_main + (strip + 1) * pitch_main + margin);
            if (part.empty()) {
                continue;
            }
            const double a = ray.at(part.start)[1 - main];
            const double b = ray.at(part.stop)[1 - main];
            const double pitch = by_columns ? field_.pitch_y : field_.pitch_x;
            const double min = by_columns ? field_.y_min : field_.x_min;
            const int cells = (by_columns ? field_.heights.rows : field_.heights.columns) - 1;
            const int end = cell(std::max(a, b) + margin, min, pitch, cells);
            for (int across = cell(std::min(a, b) - margin, min, pitch, cells); across <= end; ++across) {
                meet_cell(ray, by_columns ? strip : across, by_columns ? across : strip, nearest);
            }
        }
        return nearest;
    }

  private:
    static int cell(double coordinate, double min, double pitch, int cells) {
        return static_cast<int>(std::clamp(std::floor((coordinate - min) / pitch), 0.0, cells - 1.0));
    }
    glm::dvec3 point(int column, int row) const {
        return {field_.x_min + column * field_.pitch_x, field_.y_min + row * field_.pitch_y,
                static_cast<double>(field_.heights(column, row))};
    }
    void meet_cell(const Ray& ray, int column, int row, Hit& nearest) const {
        const glm::dvec3 low = point(column, row);
        const glm::dvec3 high = point(column + 1, row + 1);
        meet_triangle(ray, low, point(column + 1, row), high, nearest);
        meet_triangle(ray, low, high, point(column, row + 1), nearest);
    }
    static void meet_triangle(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                              Hit& nearest) {
        const std::optional<double> distance = ray.meet(a, b, c);
        if (distance && *distance < nearest.distance) {
            nearest.found = 1;
            nearest.distance = *distance;
            nearest.position = ray.at(*distance);
            nearest.normal = glm::normalize(glm::cross(b - a, c - a)); // counter-clockwise from above: towards +z
        }
    }

    HeightField field_;
    double bottom_ = 0;
    double top_ = 0;
    double margin_ = 0;
};

class Triangles {
  public:
    explicit Triangles(const Mesh& mesh) {
        triangles_.reserve(mesh.triangles.size());
        std::vector<BoxTree::Box> boxes;
        boxes.reserve(mesh.triangles.size());
        for (const glm::uvec3& triangle : mesh.triangles) {
            const glm::dvec3 a(mesh.vertices[triangle.x]), b(mesh.vertices[triangle.y]), c(mesh.vertices[triangle.z]);
            triangles_.push_back({a, b, c});
            boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
        tree_ = BoxTree(boxes);
    }

    Hit hit(const glm::dvec3& origin, const glm::dvec3& direction) const {
        Hit nearest = no_hit();
        const Ray ray(origin, direction);
        tree_.walk(origin, direction, infinity, [&](std::uint32_t index, double farthest) {
            const auto& t = triangles_[index];
            const std::optional<double> distance = ray.meet(t[0], t[1], t[2]);
            if (distance && *distance < farthest) {
                const glm::dvec3 normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
                nearest.found = 1;
                nearest.distance = *distance;
                nearest.position = ray.at(*distance);
                nearest.normal = glm::dot(normal, direction) > 0 ? -normal : normal;
            }
            return nearest.distance;
        });
        return nearest;
    }

  private:
    std::vector<std::array<glm::dvec3, 3>> triangles_;
    BoxTree tree_;
};

class Marcher {
  public:
    explicit Marcher(const Analytic& analytic)
        : record_(specimen::record({analytic, {}}, 1)), lattice_(analytic.lattice) {}

    Hit hit(const glm::dvec3& origin, const glm::dvec3& direction) const {
        const LatticeScene scene{lattice_ ? &*lattice_ : nullptr};
        return physics::f64::march_surface(scene, record_, origin, direction, 0.0, infinity);
    }

  private:
    SpecimenRecord record_;
    std::optional<HeightField> lattice_;
};

} // namespace

struct Intersector::State {
    std::variant<FieldWalk, Triangles, Marcher> geometry;
    std::optional<ReflectanceMap> reflectance;
    MaterialNumbers material;
};

Intersector::Intersector(const Specimen& specimen) {
    using Geometry = decltype(State::geometry);
    struct Prepare {
        Geometry operator()(const HeightField& field) const { return FieldWalk(field); }
        Geometry operator()(const Mesh& mesh) const { return Triangles(mesh); }
        Geometry operator()(const Analytic& analytic) const { return Marcher(analytic); }
    };
    state_ = std::make_unique<State>(
        State{std::visit(Prepare{}, specimen.geometry), specimen.reflectance, material_numbers(specimen.material)});
}

Intersector::~Intersector() = default;
Intersector::Intersector(Intersector&&) noexcept = default;

Hit Intersector::hit(glm::dvec3 origin, glm::dvec3 direction) const {
    // A stage that leaves the range of numbers sends the rays with it.
    if (!std::isfinite(glm::dot(origin, direction))) {
        return no_hit();
    }
    return std::visit([&](const auto& geometry) { return geometry.hit(origin, direction); }, state_->geometry);
}

std::uint32_t Intersector::features() const {
    return (state_->reflectance ? physics::f64::FEATURE_REFLECTANCE_MAP : 0u) |
           (state_->material.spectral_points > 0 ? physics::f64::FEATURE_SPECTRAL_MATERIAL : 0u);
}

double Intersector::reflectance_at(int column, int row) const {
    return static_cast<double>(state_->reflectance->values(column, row));
}

double Intersector::material_number(int index) const {
    return static_cast<double>(state_->material.numbers[static_cast<std::size_t>(index)]);
}

} // namespace vkfv::specimen
