#include "dimensions/find_sphere.hpp"

#include "surface/filter.hpp"
#include "surface/sphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

// Limits of sphere and plane in units of the rim's radius: the zone between them may be rounded and is left out.
constexpr double inside_rim = 0.9, outside_rim = 1.05;

template <class Visit>
void for_measured(const HeightMap& map, const Visit& visit) {
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            if (const double z = map.height(column, row); std::isfinite(z)) {
                visit(map.x(column), map.y(row), z);
            }
        }
    }
}

// Means over square blocks, at most `most` along the longer side; NaN for blocks of which less than a quarter was
// measured.
HeightMap block_means(const HeightMap& map, int most) {
    const int block = (std::max(map.columns(), map.rows()) + most - 1) / most;
    if (block <= 1) {
        return map;
    }
    HeightMap means{.height = Grid<double>((map.columns() + block - 1) / block, (map.rows() + block - 1) / block,
                                           surface::undefined),
                    .x0 = map.x0 + 0.5 * (block - 1) * map.pitch_x,
                    .y0 = map.y0 + 0.5 * (block - 1) * map.pitch_y,
                    .pitch_x = block * map.pitch_x,
                    .pitch_y = block * map.pitch_y};
    for (int row = 0; row < means.rows(); ++row) {
        for (int column = 0; column < means.columns(); ++column) {
            double sum = 0;
            int count = 0;
            for (int k = row * block; k < std::min((row + 1) * block, map.rows()); ++k) {
                for (int i = column * block; i < std::min((column + 1) * block, map.columns()); ++i) {
                    if (const double z = map.height(i, k); std::isfinite(z)) {
                        sum += z;
                        ++count;
                    }
                }
            }
            if (4 * count >= block * block) {
                means.height(column, row) = sum / count;
            }
        }
    }
    return means;
}

// A circle on the map, mm.
struct Rim {
    double x = 0, y = 0, radius = 0;

    double share(double px, double py) const { return std::hypot(px - x, py - y) / radius; }
};

// A paraboloid over a circle, fitted together with a plane; gain() is its reduction of the heights' sum of squares.
class Bump {
  public:
    explicit Bump(const HeightMap& map) : level_(surface::remove_plane(map, surface::least_squares_plane(map))) {
        double sum_x = 0, sum_y = 0;
        for_measured(level_, [&](double x, double y, double) {
            count_ += 1;
            sum_x += x;
            sum_y += y;
        });
        x_ = sum_x / count_;
        y_ = sum_y / count_;
        double xy = 0;
        for_measured(level_, [&](double x, double y, double) {
            xx_ += (x - x_) * (x - x_);
            xy += (x - x_) * (y - y_);
        });
        lean_ = xy / xx_;
        for_measured(level_, [&](double x, double y, double) { yy_ += std::pow(y - y_ - lean_ * (x - x_), 2); });
    }

    // True if the points can distinguish a plane from a bump on it.
    bool settled() const { return count_ >= 12 && xx_ > 0 && yy_ > 0; }

    double rest(const Rim& rim) const {
        double squares = 0;
        for_measured(level_, [&](double, double, double z) { squares += z * z; });
        return squares - gain(rim);
    }

    double gain(const Rim& rim) const {
        const auto within = [&](double from, double first, double pitch, int points) {
            const double low = (from - rim.radius - first) / pitch, high = (from + rim.radius - first) / pitch;
            return std::array{static_cast<int>(std::ceil(std::clamp(low, 0.0, points + 0.0))),
                              static_cast<int>(std::floor(std::clamp(high, -1.0, points - 1.0)))};
        };
        const auto [left, right] = within(rim.x, level_.x0, level_.pitch_x, level_.columns());
        const auto [first, last] = within(rim.y, level_.y0, level_.pitch_y, level_.rows());
        double points = 0, sum = 0, along_x = 0, along_y = 0, squares = 0, product = 0;
        for (int row = first; row <= last; ++row) {
            for (int column = left; column <= right; ++column) {
                const double z = level_.height(column, row), x = level_.x(column), y = level_.y(row);
                const double dx = (x - rim.x) / rim.radius, dy = (y - rim.y) / rim.radius;
                const double bump = 1 - dx * dx - dy * dy;
                if (!(bump > 0) || !std::isfinite(z)) {
                    continue;
                }
                points += 1;
                sum += bump;
                along_x += bump * (x - x_);
                along_y += bump * (y - y_ - lean_ * (x - x_));
                squares += bump * bump;
                product += bump * z;
            }
        }
        const double rest = squares - sum * sum / count_ - along_x * along_x / xx_ - along_y * along_y / yy_;
        return points >= 8 && rest > 1e-6 * squares ? product * product / rest : 0;
    }

    Rim best() const {
        const double width = (level_.columns() - 1) * level_.pitch_x, height = (level_.rows() - 1) * level_.pitch_y;
        const double longest = std::hypot(width, height);
        const double least = std::max(3 * std::max(level_.pitch_x, level_.pitch_y), 0.02 * longest);
        Rim best;
        double most = 0;
        for (double radius = least; radius < longest; radius *= 1.2) {
            for (double y = 0; y <= height; y += radius / 2) {
                for (double x = 0; x <= width; x += radius / 2) {
                    const Rim rim{level_.x0 + x, level_.y0 + y, radius};
                    if (const double gained = gain(rim); gained > most) {
                        most = gained;
                        best = rim;
                    }
                }
            }
        }
        return best;
    }

    // Maximizes the gain by steps along each unknown, halved when none increases it.
    Rim refined(Rim rim) const {
        if (!(rim.radius > 0)) {
            return rim;
        }
        double most = gain(rim);
        for (double step = rim.radius / 4; step > 1e-3 * rim.radius;) {
            const Rim from = rim;
            for (const auto& [x, y, radius] : {std::array{step, 0.0, 0.0},
                                               {-step, 0.0, 0.0},
                                               {0.0, step, 0.0},
                                               {0.0, -step, 0.0},
                                               {0.0, 0.0, step},
                                               {0.0, 0.0, -step}}) {
                const Rim next{from.x + x, from.y + y, from.radius + radius};
                if (const double gained = next.radius > 0 ? gain(next) : 0; gained > most) {
                    most = gained;
                    rim = next;
                }
            }
            if (rim.x == from.x && rim.y == from.y && rim.radius == from.radius) {
                step /= 2;
            }
        }
        return rim;
    }

  private:
    HeightMap level_;
    double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, lean_ = 0, yy_ = 0;
};

HeightMap part_of(HeightMap map, const Rim& rim, bool inside) {
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            const double share = rim.share(map.x(column), map.y(row));
            if (inside ? !(share < inside_rim) : !(share > outside_rim)) {
                map.height(column, row) = surface::undefined;
            }
        }
    }
    return map;
}

double measured_points(const HeightMap& map) {
    return static_cast<double>(std::ranges::count_if(map.height.values, [](double z) { return std::isfinite(z); }));
}

double orthogonal_distance(const surface::Sphere& sphere, double x, double y, double z) {
    const double centre = sphere.convex ? sphere.apex - sphere.radius : sphere.apex + sphere.radius;
    return std::hypot(x - sphere.x_centre, y - sphere.y_centre, z - centre) - sphere.radius;
}

// The sag of a sphere over a circle of this radius about its pole (mm).
double sag_over(const surface::Sphere& sphere, double radius) {
    return sphere.radius - std::sqrt(std::max(0.0, sphere.radius * sphere.radius - radius * radius));
}

struct CapOnPlane {
    surface::Sphere sphere;
    surface::Plane plane;
    Rim rim;
    double height = 0; // mm, height of the pole above the plane; negative: a dimple
};

// The circle in which sphere and plane meet; if more than half of the sphere is above the plane, the equator, which
// hides that circle.
std::optional<CapOnPlane> meeting(const surface::Sphere& sphere, const surface::Plane& plane) {
    const double side = sphere.convex ? 1 : -1;
    const double centre = sphere.apex - side * sphere.radius;
    const double steepness = std::hypot(1, plane.slope_x, plane.slope_y);
    // The signed distance of the centre from the plane, positive above it.
    const double over = (centre - plane.height(sphere.x_centre, sphere.y_centre)) / steepness;
    const double distance = std::min(0.0, side * over);
    if (!(sphere.radius + distance > 0)) {
        return std::nullopt;
    }
    const double along = over == 0 ? 0 : side * distance / steepness;
    return CapOnPlane{.sphere = sphere,
                      .plane = plane,
                      .rim = {.x = sphere.x_centre + along * plane.slope_x,
                              .y = sphere.y_centre + along * plane.slope_y,
                              .radius = std::sqrt(sphere.radius * sphere.radius - distance * distance)},
                      .height = side * (sphere.radius + distance)};
}

// Fits sphere and plane in turn until the rim is stable. None if too little of the map lies beyond the rim, or if the
// rim does not converge.
std::optional<CapOnPlane> settled_cap(const HeightMap& map, Rim rim) {
    constexpr double least_ground = 0.002, least_points = 10;
    constexpr int most_rounds = 50;
    const double nearness = 0.1 * std::max(map.pitch_x, map.pitch_y);
    for (int round = 0; round < most_rounds; ++round) {
        const HeightMap ground = part_of(map, rim, false);
        if (measured_points(ground) < std::max(least_points, least_ground * measured_points(map))) {
            return std::nullopt;
        }
        const auto sphere = surface::least_squares_sphere(part_of(map, rim, true));
        if (!std::isfinite(sphere.radius)) {
            return std::nullopt;
        }
        const auto cap = meeting(sphere, surface::least_squares_plane(ground));
        if (!cap) {
            return std::nullopt;
        }
        const Rim last = rim;
        rim = cap->rim;
        if (std::hypot(rim.x - last.x, rim.y - last.y) < nearness && std::abs(rim.radius - last.radius) < nearness) {
            return cap;
        }
    }
    return std::nullopt;
}

// The residual sums of squares of two models over the same points.
struct Rests {
    double points = 0, cap = 0, whole = 0;
};

Rests rests_of(const HeightMap& map, const CapOnPlane& cap, const surface::Sphere& whole) {
    Rests rests;
    for_measured(map, [&](double x, double y, double z) {
        const double share = cap.rim.share(x, y);
        if (share > inside_rim && share < outside_rim) {
            return;
        }
        const double rest = share < 1 ? orthogonal_distance(cap.sphere, x, y, z) : z - cap.plane.height(x, y);
        rests.points += 1;
        rests.cap += rest * rest;
        rests.whole += std::pow(orthogonal_distance(whole, x, y, z), 2);
    });
    return rests;
}

double rest_of(const HeightMap& map, const surface::Sphere& sphere) {
    double squares = 0, points = 0;
    for_measured(map, [&](double x, double y, double z) {
        squares += std::pow(orthogonal_distance(sphere, x, y, z), 2);
        points += 1;
    });
    return std::sqrt(squares / points);
}

} // namespace

std::optional<SphereCap> found_sphere(const HeightMap& map) {
    constexpr int search_blocks = 64, settling_blocks = 128, judging_blocks = 32;
    constexpr double most_rest = 0.1;    // relative to the sag
    constexpr double like_the_cap = 1.1; // least ratio of sums of squares for which a plane beside the cap is accepted
    constexpr double rounding = 1e-9;    // relative to the radius
    const HeightMap coarse = block_means(map, search_blocks), fine = block_means(map, settling_blocks),
                    judged = block_means(map, judging_blocks);
    const Bump bump(coarse);
    if (!bump.settled()) {
        return std::nullopt;
    }
    const auto whole = surface::least_squares_sphere(fine);
    const Rim start = bump.refined(bump.best());
    const auto cap = start.radius > 0 ? settled_cap(fine, start) : std::nullopt;
    if (cap) {
        const bool spherical = std::isfinite(whole.radius);
        const Rests rests = rests_of(fine, *cap, spherical ? whole : cap->sphere);
        if (!spherical ||
            rests.whole > like_the_cap * rests.cap + rests.points * std::pow(rounding * whole.radius, 2)) {
            const double reach = inside_rim * cap->rim.radius;
            if (!(rest_of(part_of(judged, cap->rim, true), cap->sphere) <= most_rest * sag_over(cap->sphere, reach))) {
                return std::nullopt;
            }
            return SphereCap{
                .frame = {.x = cap->rim.x, .y = cap->rim.y}, .radius = cap->sphere.radius, .height = cap->height};
        }
    }
    // If a bump leaves much less residual than the sphere, the map is no sphere, even if the part beside the bump is
    // too small to determine a plane.
    if (const double whole_rest = rest_of(coarse, whole);
        start.radius > 0 &&
        !(whole_rest * whole_rest * measured_points(coarse) <=
          like_the_cap * bump.rest(start) + measured_points(coarse) * std::pow(rounding * whole.radius, 2))) {
        return std::nullopt;
    }
    const double reach = 0.5 * std::max((map.columns() - 1) * map.pitch_x, (map.rows() - 1) * map.pitch_y);
    if (!(rest_of(judged, whole) <= most_rest * sag_over(whole, reach))) {
        return std::nullopt;
    }
    return SphereCap{};
}

} // namespace vkfv::dimensions
