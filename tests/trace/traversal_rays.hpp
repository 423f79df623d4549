// Specimens and rays by which the traversals are compared with each other and with the host's reference.
#pragma once

#include "specimen/description.hpp"
#include "specimen/intersector.hpp"
#include "trace/device/device_specimen.hpp"
#include "trace/interface/device_records.hpp"
#include "vulkan/device.hpp"

#include "spirv/probe_hits_bvh.h"
#include "spirv/probe_hits_quadtree.h"
#include "spirv/probe_hits_ray_query.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace vkfv::trace::test {

using kernels::ProbeRay;
using physics::f32::Hit;

inline constexpr double nm = 1e-6; // in mm
inline constexpr double two_pi = 2 * std::numbers::pi;

static_assert(sizeof(Hit) == 8 * 4);

inline const vulkan::Device& device() {
    static const vulkan::Device shared;
    return shared;
}

inline constexpr Traversal every_traversal[] = {Traversal::quadtree, Traversal::ray_query, Traversal::bvh};

inline std::vector<Hit> meet(const specimen::Specimen& specimen, Traversal traversal,
                             const std::vector<ProbeRay>& rays) {
    const DeviceSpecimen on_device(device(), specimen, traversal);
    kernels::Parameters parameters{};
    parameters.specimen = on_device.record(1);
    vulkan::Buffer uniform(device(), sizeof parameters, vulkan::Buffer::Memory::host);
    uniform.write(std::as_bytes(std::span(&parameters, 1)));
    vulkan::Buffer origins(device(), rays.size() * sizeof(ProbeRay));
    origins.write_values(std::span<const ProbeRay>(rays));
    const vulkan::Buffer hits(device(), rays.size() * sizeof(Hit));

    auto declarations = on_device.declarations();
    declarations.push_back({kernels::BINDING_PARAMETERS, vulkan::BindingKind::uniform_buffer});
    declarations.push_back({kernels::BINDING_GIVEN, vulkan::BindingKind::storage_buffer});
    declarations.push_back({kernels::BINDING_FOUND, vulkan::BindingKind::storage_buffer});
    auto bindings = on_device.bindings();
    bindings.push_back({kernels::BINDING_PARAMETERS, &uniform});
    bindings.push_back({kernels::BINDING_GIVEN, &origins});
    bindings.push_back({kernels::BINDING_FOUND, &hits});
    const std::span<const std::uint32_t> spirv =
        traversal == Traversal::ray_query ? std::span<const std::uint32_t>(probe_hits_ray_query)
        : traversal == Traversal::bvh     ? std::span<const std::uint32_t>(probe_hits_bvh)
                                          : std::span<const std::uint32_t>(probe_hits_quadtree);
    const auto count = static_cast<std::uint32_t>(rays.size());
    const vulkan::Kernel kernel(device(), "probe_hits", spirv, declarations, sizeof count, on_device.constants());
    vulkan::Commands commands(device());
    commands.dispatch(kernel, bindings, count, (count + 63) / 64);
    commands.submit_and_wait();
    return hits.read_values<Hit>(rays.size());
}

// A square field of points centred on the axis; heights(x, y) in mm.
template <class Heights>
specimen::HeightField make_field(int points, double pitch, const Heights& heights) {
    specimen::HeightField field;
    field.heights = Grid<float>(points, points);
    field.pitch_x = pitch;
    field.pitch_y = pitch;
    field.x_min = -0.5 * (points - 1) * pitch;
    field.y_min = field.x_min;
    for (int row = 0; row < points; ++row) {
        for (int column = 0; column < points; ++column) {
            field.heights(column, row) =
                static_cast<float>(heights(field.x_min + column * pitch, field.y_min + row * pitch));
        }
    }
    return field;
}

// A Gaussian random surface as a sum of waves of random direction and phase, none shorter than `shortest`.
class RandomWaves {
  public:
    RandomWaves(double sq, double shortest, std::uint32_t seed) {
        std::mt19937 generator(seed);
        std::uniform_real_distribution<double> uniform;
        for (Wave& wave : waves_) {
            const double number = two_pi / (shortest * (1 + 3 * uniform(generator)));
            const double angle = two_pi * uniform(generator);
            wave = {number * std::cos(angle), number * std::sin(angle), two_pi * uniform(generator)};
        }
        amplitude_ = sq * std::sqrt(2.0 / static_cast<double>(waves_.size()));
    }
    double operator()(double x, double y) const {
        double height = 0;
        for (const Wave& wave : waves_) {
            height += std::cos(wave.x * x + wave.y * y + wave.phase);
        }
        return amplitude_ * height;
    }

  private:
    struct Wave {
        double x, y, phase;
    };
    std::vector<Wave> waves_ = std::vector<Wave>(24);
    double amplitude_ = 0;
};

// A field of 512 x 512 points over 0.2 mm, with 4 um of relief and slopes up to about 1: light at NA 0.4 is shadowed
// here and there.
inline const specimen::Specimen& rough() {
    static const specimen::Specimen surface{make_field(512, 0.2 / 511, RandomWaves(0.0006, 0.01, 5)), {}};
    return surface;
}

// Rays from the top plane down, uniform over the footprint widened by `margin` on each side and over the pupil.
inline std::vector<ProbeRay> rays_from_top(const specimen::Specimen& specimen, std::size_t count, double aperture,
                                           double margin, std::uint32_t seed) {
    const auto record = specimen::record(specimen, 1);
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform;
    std::vector<ProbeRay> rays(count);
    for (ProbeRay& ray : rays) {
        const double sine = aperture * std::sqrt(uniform(generator));
        const double angle = two_pi * uniform(generator);
        const double x = record.x_min - margin + uniform(generator) * (record.x_max - record.x_min + 2 * margin);
        const double y = record.y_min - margin + uniform(generator) * (record.y_max - record.y_min + 2 * margin);
        ray.origin = glm::vec3(x, y, record.top);
        ray.direction = glm::vec3(sine * std::cos(angle), sine * std::sin(angle), -std::sqrt(1 - sine * sine));
    }
    return rays;
}

// Rays from hits on the surface, over the hemisphere of the normal as a Lambertian scatterer sends light.
inline std::vector<ProbeRay> scattered_rays(const std::vector<Hit>& hits, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    std::vector<ProbeRay> rays;
    for (const Hit& hit : hits) {
        if (hit.found == 1) {
            const glm::vec3 random(normal(generator), normal(generator), normal(generator));
            rays.push_back(
                {physics::f32::scatter_origin(hit), glm::normalize(hit.normal + 0.999F * glm::normalize(random))});
        }
    }
    return rays;
}

// The lengths that the device calls rounding: four rounding steps (2^-23) of the largest coordinate of a footprint of
// 0.2 mm.
inline constexpr double rounding = 4 * 0x1p-23 * 0.1;

// Vertices are rounded to 2^-24 of 0.1 mm: a facet 0.39 um wide turns by that over its width.
inline constexpr double turn_by_rounding = 8 * 0x1p-24 * 0.1 / (0.2 / 511);

// Whether a ray so close to this one, in double, may end in the given way. Where a ray grazes a crest, passes the
// border of the footprint or starts beside a crease, both ways are right within rounding.
inline bool within_rounding(const specimen::Intersector& reference, const ProbeRay& ray, const Hit& hit) {
    for (int k = 0; k < 26; ++k) {
        const int code = k < 13 ? k : k + 1; // the 26 neighbours, without the ray itself
        const glm::dvec3 aside(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
        const auto moved = reference.hit(glm::dvec3(ray.origin) + 4 * rounding * aside, glm::dvec3(ray.direction));
        if (moved.found == hit.found &&
            (hit.found == 0 || std::abs(moved.position.z - static_cast<double>(hit.position.z)) < nm)) {
            return true;
        }
    }
    return false;
}

struct Comparison {
    std::size_t both = 0;
    std::size_t one_only = 0;     // found by one, and not for rounding
    std::size_t apart = 0;        // heights by more than the tolerance, and not for rounding
    std::size_t for_rounding = 0; // differences that are right within rounding
    double largest_height = 0;    // difference, of those not apart, mm
    double largest_distance = 0;  // likewise, along the ray
    double largest_normal = 0;    // likewise, length of the difference
    std::size_t turned = 0;       // normals further apart than the rounding of the same facet
};

template <class First, class Second>
Comparison compare(const specimen::Intersector& reference, const std::vector<ProbeRay>& rays,
                   const std::vector<First>& first, const std::vector<Second>& second, double tolerance) {
    Comparison result;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const First& a = first[k];
        const Second& b = second[k];
        const double height = std::abs(static_cast<double>(a.position.z) - static_cast<double>(b.position.z));
        if (a.found == b.found && (a.found == 0 || height <= tolerance)) {
            result.both += a.found;
            if (a.found == 1) {
                result.largest_height = std::max(result.largest_height, height);
                result.largest_distance = std::max(result.largest_distance, std::abs(static_cast<double>(a.distance) -
                                                                                     static_cast<double>(b.distance)));
                const double turn = glm::length(glm::dvec3(a.normal) - glm::dvec3(b.normal));
                result.largest_normal = std::max(result.largest_normal, turn);
                result.turned += turn > turn_by_rounding ? 1 : 0;
            }
        } else {
            Hit other{};
            other.found = b.found;
            other.position = glm::vec3(b.position);
            if (within_rounding(reference, rays[k], a) && within_rounding(reference, rays[k], other)) {
                ++result.for_rounding;
            } else if (a.found == b.found) {
                ++result.apart;
            } else {
                ++result.one_only;
            }
        }
    }
    return result;
}

inline std::vector<physics::f64::Hit> meet(const specimen::Intersector& reference, std::span<const ProbeRay> rays) {
    std::vector<physics::f64::Hit> hits;
    for (const ProbeRay& ray : rays) {
        hits.push_back(reference.hit(glm::dvec3(ray.origin), glm::dvec3(ray.direction)));
    }
    return hits;
}

// Rounding decides over a belt of some 10 roundings (0.5 nm) beside crests and the border. Shadow lines are
// at most as long as a few times the footprint's side, so the belt holds less than 1e-4 of the rays.
inline constexpr double share_for_rounding = 1e-4;

inline specimen::Specimen shifted(const specimen::Specimen& surface, double height) {
    specimen::Specimen result = surface;
    for (float& value : std::get<specimen::HeightField>(result.geometry).heights.values) {
        value += static_cast<float>(height);
    }
    return result;
}

} // namespace vkfv::trace::test
