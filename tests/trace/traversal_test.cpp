// The traversals against each other, against the host's reference in double, and against closed forms.
#include "trace/device_specimen.hpp"

#include "core/error.hpp"
#include "specimen/description.hpp"
#include "specimen/intersector.hpp"
#include "spirv/probe_hits_bvh.h"
#include "spirv/probe_hits_quadtree.h"
#include "spirv/probe_hits_ray_query.h"
#include "trace/device_records.hpp"
#include "trace/pyramid.hpp"
#include "vulkan/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::trace {
namespace {

using physics::f32::Hit;
using testing::HasSubstr;

constexpr double nm = 1e-6; // in mm
constexpr double two_pi = 2 * std::numbers::pi;

struct ProbeRay {
    glm::vec3 origin;
    glm::vec3 direction;
};
static_assert(sizeof(ProbeRay) == 6 * 4);
static_assert(sizeof(Hit) == 8 * 4);

const vulkan::Device& device() {
    static const vulkan::Device shared;
    return shared;
}

constexpr Traversal every_traversal[] = {Traversal::quadtree, Traversal::ray_query, Traversal::bvh};

std::vector<Hit> meet(const specimen::Specimen& specimen, Traversal traversal, const std::vector<ProbeRay>& rays) {
    const DeviceSpecimen on_device(device(), specimen, traversal);
    Parameters parameters{};
    parameters.specimen = on_device.record(1);
    vulkan::Buffer uniform(device(), sizeof parameters, vulkan::Buffer::Memory::host);
    uniform.write(std::as_bytes(std::span(&parameters, 1)));
    vulkan::Buffer origins(device(), rays.size() * sizeof(ProbeRay));
    origins.write_values(std::span<const ProbeRay>(rays));
    const vulkan::Buffer hits(device(), rays.size() * sizeof(Hit));

    auto declarations = on_device.declarations();
    declarations.push_back({1, vulkan::BindingKind::uniform_buffer});
    declarations.push_back({6, vulkan::BindingKind::storage_buffer});
    declarations.push_back({7, vulkan::BindingKind::storage_buffer});
    auto bindings = on_device.bindings();
    bindings.push_back({1, &uniform});
    bindings.push_back({6, &origins});
    bindings.push_back({7, &hits});
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

// 512 x 512 points over 0.2 mm, 4 um of relief, slopes up to about 1: light at NA 0.4 is shadowed here and
// there.
const specimen::Specimen& rough() {
    static const specimen::Specimen surface{make_field(512, 0.2 / 511, RandomWaves(0.0006, 0.01, 5)), {}};
    return surface;
}

// From the top plane down, uniform over the footprint widened by `margin` on each side and over the pupil.
std::vector<ProbeRay> rays_from_top(const specimen::Specimen& specimen, std::size_t count, double aperture,
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

// From hits on the surface, over the hemisphere of the normal as a Lambertian scatterer sends light.
std::vector<ProbeRay> scattered_rays(const std::vector<Hit>& hits, std::uint32_t seed) {
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

// Four rounding steps (2^-23) of the largest coordinate of a footprint of 0.2 mm: what the device calls
// rounding.
constexpr double rounding = 4 * 0x1p-23 * 0.1;

// Vertices are rounded to 2^-24 of 0.1 mm: a facet 0.39 um wide turns by that over its width.
constexpr double turn_by_rounding = 8 * 0x1p-24 * 0.1 / (0.2 / 511);

// May a ray so close to this one, in double, end in the given way? Where a ray grazes a crest, passes the
// border of the footprint or starts beside a crease, both ways are right within rounding.
bool within_rounding(const specimen::Intersector& reference, const ProbeRay& ray, const Hit& hit) {
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

std::vector<physics::f64::Hit> meet(const specimen::Intersector& reference, std::span<const ProbeRay> rays) {
    std::vector<physics::f64::Hit> hits;
    for (const ProbeRay& ray : rays) {
        hits.push_back(reference.hit(glm::dvec3(ray.origin), glm::dvec3(ray.direction)));
    }
    return hits;
}

// Rounding decides over a belt of some 10 roundings (0.5 nm) beside crests and the border. Shadow lines are
// at most as long as a few times the footprint's side, so the belt holds less than 1e-4 of the rays.
constexpr double share_for_rounding = 1e-4;

specimen::Specimen shifted(const specimen::Specimen& surface, double height) {
    specimen::Specimen result = surface;
    for (float& value : std::get<specimen::HeightField>(result.geometry).heights.values) {
        value += static_cast<float>(height);
    }
    return result;
}

TEST(Traversal, AllAgreeOnARoughSurface) {
    const specimen::Intersector reference(rough());
    const auto rays = rays_from_top(rough(), 1'000'000, 0.4, 0.002, 1);
    const auto quadtree = meet(rough(), Traversal::quadtree, rays);
    const auto ray_query = meet(rough(), Traversal::ray_query, rays);
    const auto bvh = meet(rough(), Traversal::bvh, rays);
    for (const auto& [name, seen] :
         {std::pair("quadtree, ray query", compare(reference, rays, quadtree, ray_query, nm)),
          std::pair("quadtree, bvh", compare(reference, rays, quadtree, bvh, nm)),
          std::pair("ray query, bvh", compare(reference, rays, ray_query, bvh, nm))}) {
        SCOPED_TRACE(name);
        EXPECT_GT(seen.both, rays.size() * 9 / 10);
        EXPECT_EQ(seen.one_only, 0u);
        EXPECT_EQ(seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), share_for_rounding * static_cast<double>(rays.size()));
        // The distance is as much longer than the height as the steepest slope against the flattest ray makes it.
        EXPECT_LT(seen.largest_distance, 4 * nm);
        // Within two roundings of the edges, 3.4 pitches of which belong to each cell, either facet is right.
        EXPECT_LT(static_cast<double>(seen.turned),
                  3.4 * 4 * rounding / (0.2 / 511) * static_cast<double>(rays.size()));
        RecordProperty(std::string(name) + " for_rounding", std::to_string(seen.for_rounding));
        RecordProperty(std::string(name) + " largest_height_nm", std::to_string(seen.largest_height / nm));
        RecordProperty(std::string(name) + " largest_distance_nm", std::to_string(seen.largest_distance / nm));
    }
}

TEST(Traversal, AShiftOfThreeNanometresIsRejected) {
    const specimen::Intersector reference(rough());
    const auto rays = rays_from_top(rough(), 2'000, 0.4, 0, 2);
    const auto quadtree = meet(rough(), Traversal::quadtree, rays);
    for (const Traversal traversal : {Traversal::ray_query, Traversal::bvh}) {
        const auto moved = meet(shifted(rough(), 3 * nm), traversal, rays);
        EXPECT_GT(compare(reference, rays, quadtree, moved, nm).apart, rays.size() * 9 / 10);
    }
}

TEST(Traversal, EachAgreesWithTheHostsReferenceInDouble) {
    const specimen::Intersector reference(rough());
    const auto rays = rays_from_top(rough(), 100'000, 0.4, 0.002, 3);
    const auto expected = meet(reference, rays);
    for (const Traversal traversal : every_traversal) {
        const Comparison seen = compare(reference, rays, meet(rough(), traversal, rays), expected, nm);
        EXPECT_GT(seen.both, rays.size() * 9 / 10);
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), share_for_rounding * static_cast<double>(rays.size()));
    }
    const auto wrong = meet(shifted(rough(), 3 * nm), Traversal::quadtree, rays);
    EXPECT_GT(compare(reference, {rays.begin(), rays.begin() + 1000}, wrong, expected, nm).apart, 900u);
}

TEST(Traversal, ScatteredLightIsMetAlike) {
    const specimen::Intersector reference(rough());
    const auto down = rays_from_top(rough(), 100'000, 0.4, 0, 4);
    const auto rays = scattered_rays(meet(rough(), Traversal::quadtree, down), 4);
    const auto quadtree = meet(rough(), Traversal::quadtree, rays);
    const auto ray_query = meet(rough(), Traversal::ray_query, rays);
    const auto bvh = meet(rough(), Traversal::bvh, rays);
    const auto expected = meet(reference, rays);
    // Few leave so flat that they meet the surface again; but some must, or nothing is tested.
    EXPECT_GT(compare(reference, rays, quadtree, ray_query, nm).both, rays.size() / 100);
    for (const Comparison& seen :
         {compare(reference, rays, quadtree, ray_query, nm), compare(reference, rays, quadtree, expected, nm),
          compare(reference, rays, ray_query, expected, nm), compare(reference, rays, bvh, expected, nm),
          compare(reference, rays, bvh, quadtree, nm), compare(reference, rays, bvh, ray_query, nm)}) {
        EXPECT_EQ(seen.one_only, 0u);
        EXPECT_EQ(seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
    }
}

TEST(Traversal, LightFromTheSideIsMetAlike) {
    // Low over the surface, and from beside it between its lowest and highest point: above it or below.
    const specimen::Intersector reference(rough());
    const auto record = specimen::record(rough(), 1);
    std::mt19937 generator(6);
    std::uniform_real_distribution<double> uniform;
    std::vector<ProbeRay> rays;
    for (int k = 0; k < 30'000; ++k) {
        const double angle = two_pi * uniform(generator);
        const glm::dvec2 across(std::cos(angle), std::sin(angle));
        const double z = record.bottom + uniform(generator) * (record.top - record.bottom);
        // Towards a place over the footprint, within 6 degrees of the plane, from further away than it is wide.
        const glm::dvec2 target(0.1 * (2 * uniform(generator) - 1), 0.1 * (2 * uniform(generator) - 1));
        const double rise = 0.1 * (2 * uniform(generator) - 1);
        rays.push_back({glm::vec3(target - 0.3 * across, z - 0.25 * rise), glm::normalize(glm::vec3(across, rise))});
    }
    const auto expected = meet(reference, rays);
    // A step of a float is 0.03 nm at 0.3 mm, and rays that are flatter than the surface draw it out.
    for (const Traversal traversal : every_traversal) {
        const Comparison seen = compare(reference, rays, meet(rough(), traversal, rays), expected, 4 * nm);
        EXPECT_GT(seen.both, rays.size() / 2);
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
    }
    const auto wrong = meet(shifted(rough(), 10 * nm), Traversal::quadtree, rays);
    EXPECT_GT(compare(reference, {rays.begin(), rays.begin() + 1000}, wrong, expected, 4 * nm).apart, 100u);
}

TEST(Traversal, SteepLightLeavesTheSurface) {
    // Steeper than any slope of the surface: nothing may be in the way, least of all the facet it starts
    // from.
    const auto down = rays_from_top(rough(), 100'000, 0.4, 0, 5);
    std::vector<ProbeRay> rays;
    for (const Hit& hit : meet(rough(), Traversal::quadtree, down)) {
        if (hit.found == 1) {
            rays.push_back({physics::f32::scatter_origin(hit), glm::vec3(0.0F, 0.28F, 0.96F)});
        }
    }
    for (const Traversal traversal : every_traversal) {
        const auto hits = meet(rough(), traversal, rays);
        EXPECT_EQ(std::ranges::count(hits, 1u, &Hit::found), 0);
    }
}

TEST(Traversal, NoRayAtAVertexOrAnEdgeIsLost) {
    // Down at every vertex, at the middle of edges and along rows, columns and diagonals; on a flat specimen,
    // whose top plane is the surface itself, too.
    const specimen::Specimen flat{make_field(129, 0.001, [](double, double) { return 0.0; }), {}};
    const specimen::Specimen hills{make_field(129, 0.001, RandomWaves(0.0005, 0.01, 7)), {}};
    const glm::vec3 directions[] = {{0, 0, -1},          {0.6F, 0, -0.8F},
                                    {0, -0.6F, -0.8F},   {0.48F, 0.48F, -0.73430239F},
                                    {-0.28F, 0, -0.96F}, {0, 0.28F, -0.96F}};
    for (const specimen::Specimen& surface : {flat, hills}) {
        const auto& field = std::get<specimen::HeightField>(surface.geometry);
        const auto top = static_cast<float>(specimen::record(surface, 1).top);
        std::vector<ProbeRay> rays;
        for (const glm::vec3& direction : directions) {
            for (int row = 10; row < 2 * 129 - 20; ++row) {
                for (int column = 10; column < 2 * 129 - 20; ++column) {
                    const glm::vec3 target(field.x_min + 0.5 * column * field.pitch_x,
                                           field.y_min + 0.5 * row * field.pitch_y, field.heights(column / 2, row / 2));
                    rays.push_back({target + direction * ((top - target.z) / direction.z), direction});
                    rays.back().origin.z = top;
                }
            }
        }
        for (const Traversal traversal : every_traversal) {
            const auto hits = meet(surface, traversal, rays);
            EXPECT_EQ(std::ranges::count(hits, 0u, &Hit::found), 0);
            EXPECT_TRUE(std::ranges::all_of(hits, [](const Hit& hit) { return hit.normal.z > 0; }));
        }
    }
}

TEST(Traversal, ARayFromAfarIsMetAsOnTheHost) {
    // At vertices and middles of edges around the centre, from 10 mm away.
    const specimen::Specimen hills{make_field(129, 0.001, RandomWaves(0.0005, 0.01, 7)), {}};
    const auto& field = std::get<specimen::HeightField>(hills.geometry);
    std::vector<ProbeRay> rays;
    for (const glm::vec3& direction :
         {glm::normalize(glm::vec3(0.1F, 0, -1)), glm::vec3(0.24F, -0.32F, -0.91651514F)}) {
        for (int row = 86; row < 170; ++row) {
            for (int column = 86; column < 170; ++column) {
                const glm::vec3 target(field.x_min + 0.5 * column * field.pitch_x,
                                       field.y_min + 0.5 * row * field.pitch_y, field.heights(column / 2, row / 2));
                rays.push_back({target - 10.0F * direction, direction});
            }
        }
    }
    const specimen::Intersector reference(hills);
    const auto expected = meet(reference, rays);
    for (const Traversal traversal : every_traversal) {
        // A float at 10 mm has steps of 1 nm, and so has the place where the ray comes to the specimen.
        const Comparison seen = compare(reference, rays, meet(hills, traversal, rays), expected, 4 * nm);
        EXPECT_EQ(seen.both, rays.size());
    }
}

// The heights at which rays of slope tan(theta) meet two surfaces that are `gap` apart vertically differ by
// at most gap / (1 - slope tan(theta)), where `slope` bounds both surfaces' slopes. Float adds rounding of
// both.
double along_ray(double gap, double slope, double aperture) {
    return (gap + 4 * rounding) / (1 - slope * std::tan(std::asin(aperture)));
}

struct Pair {
    specimen::Analytic analytic;
    specimen::HeightField facets;
    double bound; // of the vertical distance of the two, mm
    double slope; // of both
};

specimen::Analytic analytic_shape(std::uint32_t shape, double p0, double p1, double p2, double half) {
    specimen::Analytic surface;
    surface.shape = shape;
    surface.parameters[0] = p0;
    surface.parameters[1] = p1;
    surface.parameters[2] = p2;
    surface.x_min = surface.y_min = -half;
    surface.x_max = surface.y_max = half;
    return surface;
}

constexpr double pitch = 0.0002;
constexpr int points = 513;
constexpr double half = 0.5 * (points - 1) * pitch;

// A function of x alone lies within max |h''| pitch^2 / 8 of its chords.
Pair sinusoid() {
    const double amplitude = 0.001;
    const double number = two_pi / 0.02;
    return {analytic_shape(physics::f64::SHAPE_SINUSOID, amplitude, 0.02, 0, half),
            make_field(points, pitch, [=](double x, double) { return amplitude * std::sin(number * x); }),
            amplitude * number * number * pitch * pitch / 8, amplitude * number};
}

// h = A sin(2 pi p(x)) with p'' = s: |h''| <= A ((2 pi p')^2 + 2 pi s).
Pair chirp() {
    const double amplitude = 0.0005;
    const double start = 1 / 0.03;
    const double stop = 1 / 0.01;
    const double sweep = (stop - start) / (2 * half);
    return {analytic_shape(physics::f64::SHAPE_CHIRP, amplitude, 0.03, 0.01, half),
            make_field(points, pitch,
                       [=](double x, double) {
                           const double s = x + half;
                           return amplitude * std::sin(two_pi * (start * s + 0.5 * sweep * s * s));
                       }),
            amplitude * (two_pi * stop * two_pi * stop + two_pi * sweep) * pitch * pitch / 8,
            amplitude * two_pi * stop};
}

// The whole footprint lies on the cap. The error of linear interpolation on a triangle of circumradius pitch
// / sqrt(2) is at most that squared / 2 times the largest curvature R^2 / (R^2 - r^2)^(3/2).
Pair sphere() {
    const double radius = 0.2;
    const double cap = 0.05; // its rim stands at r = sqrt(2 R cap - cap^2) = 0.13 mm, beyond the corners at 0.073 mm
    const double r_squared = 2 * half * half;
    const double z = std::sqrt(radius * radius - r_squared);
    return {analytic_shape(physics::f64::SHAPE_SPHERE, radius, cap, 0, half),
            make_field(points, pitch,
                       [=](double x, double y) { return cap - radius + std::sqrt(radius * radius - x * x - y * y); }),
            pitch * pitch / 4 * radius * radius / (z * z * z), std::sqrt(r_squared) / z};
}

// A lattice interpolated by cubic convolution against the facets over the same points. Along a line its
// distance from the chord is u (1 - u) / 2 times a mean of the neighbouring second differences, so at most
// 1/8 of them; the weights across add up to at most 5/4 in size. The bilinear patch between is within 1/4 of
// its mixed difference of the facets.
Pair lattice() {
    Pair pair;
    pair.facets = make_field(points, pitch, RandomWaves(0.0002, 0.015, 11));
    pair.analytic = analytic_shape(physics::f64::SHAPE_PLANE, 0, 0, 0, half);
    pair.analytic.lattice = pair.facets;
    const Grid<float>& h = pair.facets.heights;
    double along_x = 0;
    double along_y = 0;
    double mixed = 0;
    double slope = 0;
    for (int j = 1; j + 1 < points; ++j) {
        for (int i = 1; i + 1 < points; ++i) {
            const double centre = h(i, j);
            along_x = std::max(along_x, std::abs(h(i - 1, j) - 2 * centre + h(i + 1, j)));
            along_y = std::max(along_y, std::abs(h(i, j - 1) - 2 * centre + h(i, j + 1)));
            mixed = std::max(mixed, std::abs(centre - h(i + 1, j) - h(i, j + 1) + h(i + 1, j + 1)));
            slope = std::max(slope, std::hypot(h(i + 1, j) - centre, h(i, j + 1) - centre) / pitch);
        }
    }
    pair.bound = 5.0 / 32 * along_x + along_y / 8 + mixed / 4;
    // The interpolant's slope along a line is at its extreme 5/4 of the chord's less 1/8 of either
    // neighbour's, and the weights across add up to at most 5/4 in size.
    pair.slope = (5.0 / 4 + 2.0 / 8) * 5.0 / 4 * slope;
    return pair;
}

class FacetsAndFunction : public testing::TestWithParam<std::pair<const char*, Pair (*)()>> {};

TEST_P(FacetsAndFunction, AgreeWithinTheInterpolationsBound) {
    const Pair pair = GetParam().second();
    const specimen::Specimen facets{pair.facets, {}};
    const specimen::Specimen function{pair.analytic, {}};
    const double aperture = 0.3;
    const double tolerance = along_ray(pair.bound, pair.slope, aperture);
    // A shift by 3 nm must stand out of it.
    ASSERT_LT(2 * tolerance, 3 * nm / (1 + pair.slope * std::tan(std::asin(aperture))));

    // Where the lattice goes on level, two cells from the border, its distance from the facets is not bounded
    // so; and facets reach no further than their own top plane.
    auto rays = rays_from_top(function, 50'000, aperture, -0.004, 13);
    const specimen::Intersector reference(facets);
    const auto on_facets = meet(facets, Traversal::quadtree, rays);
    const auto by_march = meet(function, Traversal::quadtree, rays);
    const auto by_boxes = meet(function, Traversal::ray_query, rays);
    const auto by_hierarchy = meet(function, Traversal::bvh, rays);
    const auto moved = meet(shifted(facets, 3 * nm), Traversal::quadtree, rays);

    for (const auto& hits : {by_march, by_boxes, by_hierarchy}) {
        const Comparison seen = compare(reference, rays, on_facets, hits, tolerance);
        EXPECT_EQ(seen.both, rays.size());
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        // The normals of a chord and of its arc differ by at most the curvature times a pitch.
        EXPECT_LT(seen.largest_normal, 8 * pair.bound / pitch * std::numbers::sqrt2 + 0.001);
    }
    EXPECT_EQ(compare(reference, rays, by_march, by_boxes, nm).both, rays.size());
    EXPECT_EQ(compare(reference, rays, by_march, by_hierarchy, nm).both, rays.size());
    EXPECT_EQ(compare(reference, rays, moved, by_march, tolerance).both, 0u);
}

INSTANTIATE_TEST_SUITE_P(Traversal, FacetsAndFunction,
                         testing::Values(std::pair("sinusoid", &sinusoid), std::pair("chirp", &chirp),
                                         std::pair("sphere", &sphere), std::pair("lattice", &lattice)),
                         [](const auto& info) { return std::string(info.param.first); });

TEST(Traversal, FunctionsAreMetAsOnTheHost) {
    for (const auto& make_pair : {&sinusoid, &lattice}) {
        const specimen::Specimen function{make_pair().analytic, {}};
        const specimen::Intersector reference(function);
        const auto down = rays_from_top(function, 20'000, 0.4, 0, 17);
        const auto rays = scattered_rays(meet(function, Traversal::quadtree, down), 17);
        for (const auto& probes : {down, rays}) {
            const auto expected = meet(reference, probes);
            for (const Traversal traversal : every_traversal) {
                const Comparison seen = compare(reference, probes, meet(function, traversal, probes), expected, nm);
                EXPECT_EQ(seen.one_only + seen.apart, 0u);
                EXPECT_GT(seen.both, 0u);
            }
        }
    }
}

// A sphere of triangles about (0, 0, 0): a regular octahedron whose edges are halved, the points moved out to
// the radius.
specimen::Mesh octahedral_sphere(double radius, int halvings) {
    std::vector<glm::dvec3> vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<glm::uvec3> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int k = 0; k < halvings; ++k) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, made] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices.size()));
            if (made) {
                vertices.push_back(glm::normalize(vertices[a] + vertices[b]));
            }
            return at->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : triangles) {
            const std::uint32_t ab = middle(t.x, t.y);
            const std::uint32_t bc = middle(t.y, t.z);
            const std::uint32_t ca = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
        }
        triangles = finer;
    }
    specimen::Mesh mesh;
    for (const glm::dvec3& vertex : vertices) {
        mesh.vertices.emplace_back(radius * vertex);
    }
    mesh.triangles = triangles;
    return mesh;
}

// How many rays disagree with a ball of the given radius within the facets' depth below it.
std::size_t disagreements(const std::vector<ProbeRay>& rays, const std::vector<Hit>& hits, double radius,
                          double sagitta) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const glm::dvec3 origin(rays[k].origin);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(rays[k].direction));
        const double along = -glm::dot(origin, direction);
        const double passing = glm::length(origin + along * direction); // distance of the ray from the centre
        const double r = glm::length(glm::dvec3(hits[k].position));
        const bool must_meet = passing < radius - sagitta;
        const bool may_meet = passing <= radius;
        // Met between the ball and the ball that the facets enclose: so is the distance along the ray.
        const auto entry = [&](double ball) {
            return along - std::sqrt(std::max(ball * ball - passing * passing, 0.0));
        };
        const auto distance = static_cast<double>(hits[k].distance);
        const bool right = hits[k].found == 0
                               ? !must_meet
                               : may_meet && r <= radius + rounding && r >= radius - sagitta - rounding &&
                                     distance >= entry(radius) - nm &&
                                     distance <= (must_meet ? entry(radius - sagitta) : along) + nm &&
                                     glm::dot(glm::dvec3(hits[k].normal), direction) < 0;
        count += right ? 0 : 1;
    }
    return count;
}

TEST(Traversal, AMeshIsMetLikeTheSphereItApproximates) {
    const double radius = 0.05;
    const int halvings = 6;
    const specimen::Specimen ball{octahedral_sphere(radius, halvings), {}};
    const auto& mesh = std::get<specimen::Mesh>(ball.geometry);
    // A facet lies below the sphere by at most R - sqrt(R^2 - rho^2) with rho its circumradius, at most its
    // longest edge over sqrt(2) for these triangles without obtuse angles (and over sqrt(3) for an
    // equilateral one).
    double longest = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        longest = std::max({longest, static_cast<double>(glm::distance(mesh.vertices[t.x], mesh.vertices[t.y])),
                            static_cast<double>(glm::distance(mesh.vertices[t.y], mesh.vertices[t.z])),
                            static_cast<double>(glm::distance(mesh.vertices[t.z], mesh.vertices[t.x]))});
    }
    const double sagitta = radius - std::sqrt(radius * radius - longest * longest / 2);

    std::mt19937 generator(19);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    std::vector<ProbeRay> rays = rays_from_top(ball, 50'000, 0.3, 0.01, 18);
    // And from all sides: from 0.09 mm off the centre towards a point of a slightly larger ball.
    for (int k = 0; k < 50'000; ++k) {
        const glm::vec3 from = glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
        const glm::vec3 to = glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
        rays.push_back({0.09F * from, glm::normalize(0.055F * uniform(generator) * to - 0.09F * from)});
    }
    for (const Traversal traversal : {Traversal::ray_query, Traversal::bvh}) {
        const auto hits = meet(ball, traversal, rays);
        EXPECT_GT(std::ranges::count(hits, 1u, &Hit::found), 50'000);
        EXPECT_EQ(disagreements(rays, hits, radius, sagitta), 0u);
        // A ball larger by two depths of its facets is another one.
        EXPECT_GT(disagreements(rays, hits, radius + 2 * sagitta, sagitta), rays.size() / 2);
    }
}

// From points within, up at every vertex and every edge's middle: those that the traversals do not try again.
TEST(Traversal, AClosedMeshLetsNoRayThroughItsHierarchy) {
    specimen::Specimen ball{octahedral_sphere(0.05, 5), {}};
    auto& mesh = std::get<specimen::Mesh>(ball.geometry);
    std::vector<ProbeRay> rays;
    for (const glm::vec3& from : {glm::vec3(0), glm::vec3(0.013F, -0.007F, -0.011F), glm::vec3(0, 0.03F, -0.02F)}) {
        const auto aim = [&](const glm::vec3& target) {
            if (target.z > from.z) {
                rays.push_back({from, glm::normalize(target - from)});
            }
        };
        for (const glm::uvec3& t : mesh.triangles) {
            aim(mesh.vertices[t.x]);
            aim(0.5F * (mesh.vertices[t.x] + mesh.vertices[t.y]));
            aim(0.5F * (mesh.vertices[t.y] + mesh.vertices[t.z]));
            aim(0.5F * (mesh.vertices[t.z] + mesh.vertices[t.x]));
        }
    }
    EXPECT_EQ(std::ranges::count(meet(ball, Traversal::bvh, rays), 0u, &Hit::found), 0);
    mesh.triangles.erase(mesh.triangles.begin()); // a hole, in the octant of +x, +y, +z
    EXPECT_GT(std::ranges::count(meet(ball, Traversal::bvh, rays), 0u, &Hit::found), 0);
}

// Slivers and crossing triangles of all sizes in a cube of 0.1 mm: what no grid of cells resembles.
specimen::Mesh thicket(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    specimen::Mesh mesh;
    for (std::size_t k = 0; k < count; ++k) {
        const auto point = [&](float size) {
            return size * glm::vec3(uniform(generator), uniform(generator), uniform(generator));
        };
        const glm::vec3 corner = point(0.05F);
        const float size = 0.03F * std::pow(0.5F, 3.0F * (1 + uniform(generator)));
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {corner, corner + point(size), corner + point(size)});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

// From all sides, also from within, towards points of a ball of 0.05 mm; the longest travel 0.3 mm.
std::vector<ProbeRay> rays_from_all_sides(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    const auto point = [&](float radius) {
        return radius * uniform(generator) *
               glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
    };
    std::vector<ProbeRay> rays;
    while (rays.size() < count) {
        const glm::vec3 from = point(0.15F);
        const glm::vec3 to = point(0.05F);
        if (glm::distance(from, to) > 0.001F) {
            rays.push_back({from, glm::normalize(to - from)});
        }
    }
    return rays;
}

TEST(Traversal, AnyMeshIsMetAsOnTheHost) {
    const specimen::Specimen surface{thicket(3000, 31), {}};
    const specimen::Intersector reference(surface);
    auto rays = rays_from_all_sides(200'000, 32);
    for (std::size_t k = 0; k < rays.size(); k += 10) {
        rays[k].direction = {0, 0, rays[k].direction.z < 0 ? -1.0F : 1.0F}; // along an axis
    }
    const auto expected = meet(reference, rays);
    for (const Traversal traversal : {Traversal::ray_query, Traversal::bvh}) {
        const Comparison seen = compare(reference, rays, meet(surface, traversal, rays), expected, nm);
        EXPECT_GT(seen.both, rays.size() / 3);
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        // There are more edges to pass than on a height field.
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
    }
}

TEST(Traversal, IsChosenForDeviceAndSpecimen) {
    vulkan::DeviceReport cpu;
    cpu.name = "software";
    cpu.type = "CPU";
    cpu.ray_query = true;
    vulkan::DeviceReport rtx = cpu;
    rtx.type = "discrete GPU";
    vulkan::DeviceReport without = rtx;
    without.ray_query = false;
    const specimen::Specimen field{make_field(3, 0.001, [](double, double) { return 0.0; }), {}};
    const specimen::Specimen mesh{octahedral_sphere(0.05, 0), {}};
    std::string reason;
    EXPECT_EQ(choose_traversal(cpu, field, Traversal::automatic, reason), Traversal::quadtree);
    EXPECT_THAT(reason, HasSubstr("CPU"));
    EXPECT_EQ(choose_traversal(rtx, field, Traversal::automatic, reason), Traversal::ray_query);
    EXPECT_EQ(choose_traversal(without, field, Traversal::automatic, reason), Traversal::quadtree);
    EXPECT_THAT(reason, HasSubstr("no ray query"));
    EXPECT_EQ(choose_traversal(cpu, field, Traversal::ray_query, reason), Traversal::ray_query);
    EXPECT_EQ(choose_traversal(rtx, field, Traversal::quadtree, reason), Traversal::quadtree);
    EXPECT_THAT(reason, HasSubstr("asked"));
    EXPECT_EQ(choose_traversal(rtx, field, Traversal::bvh, reason), Traversal::bvh);
    EXPECT_THAT(reason, HasSubstr("bvh (as asked"));
    EXPECT_EQ(choose_traversal(rtx, mesh, Traversal::automatic, reason), Traversal::ray_query);
    EXPECT_EQ(choose_traversal(cpu, mesh, Traversal::automatic, reason), Traversal::bvh);
    EXPECT_THAT(reason, HasSubstr("CPU"));
    EXPECT_EQ(choose_traversal(without, mesh, Traversal::automatic, reason), Traversal::bvh);
    EXPECT_THAT(reason, HasSubstr("no ray query"));
    EXPECT_THROW(choose_traversal(rtx, mesh, Traversal::quadtree, reason), InputError);
    EXPECT_THROW(choose_traversal(without, mesh, Traversal::ray_query, reason), DeviceError);
    EXPECT_THROW(choose_traversal(without, field, Traversal::ray_query, reason), DeviceError);
}

TEST(Traversal, ASpecimenTooLargeForTheDeviceIsRefusedWithSizes) {
    const std::uint64_t limit = device().report().max_storage_buffer_bytes;
    int side = 512; // 8 bytes a point
    while (std::uint64_t{8} * static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) <= limit) {
        side += 512;
    }
    ASSERT_LT(side, 20'000) << "this device takes more than the test can make";
    specimen::HeightField field;
    field.heights = Grid<float>(side, side);
    field.pitch_x = field.pitch_y = 0.001;
    try {
        const DeviceSpecimen refused(device(), {field, {}}, Traversal::quadtree);
        FAIL() << "taken";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr(std::to_string(limit)));
        EXPECT_THAT(error.what(), HasSubstr("larger pitch"));
    }
}

TEST(Pyramid, EnclosesTheSurface) {
    std::mt19937 generator(23);
    std::uniform_real_distribution<double> uniform;
    for (const auto& make_pair : {&sinusoid, &chirp, &sphere, &lattice}) {
        const specimen::Analytic surface = make_pair().analytic;
        specimen::Analytic shape = surface;
        shape.lattice.reset();
        const Pyramid pyramid = make_pyramid(surface, specimen::record({shape, {}}, 1));
        const auto record = specimen::record({surface, {}}, 1);
        struct Scene {
            const specimen::Analytic* surface;
            double lattice_at(int column, int row) const { return surface->lattice->heights(column, row); }
        };
        const Scene scene{&surface};
        EXPECT_EQ(glm::ivec2(pyramid.header.cells_x, pyramid.header.cells_y), pyramid_cells(surface));
        std::size_t outside = 0;
        std::size_t outside_half = 0;
        for (int k = 0; k < 20'000; ++k) {
            const double u = uniform(generator);
            const double v = uniform(generator);
            const double height =
                physics::f64::surface_height(scene, record, -half + u * 2 * half, -half + v * 2 * half).height;
            for (int level = 0; level <= pyramid.header.top_level; ++level) {
                const glm::dvec2 range = pyramid.range(level, static_cast<int>(u * pyramid.header.cells_x) >> level,
                                                       static_cast<int>(v * pyramid.header.cells_y) >> level);
                outside += height < range.x || height > range.y ? 1 : 0;
                const double middle = 0.5 * (range.x + range.y);
                outside_half += std::abs(height - middle) > 0.25 * (range.y - range.x) ? 1 : 0;
            }
        }
        EXPECT_EQ(outside, 0u);
        EXPECT_GT(outside_half, 1000u); // half as wide would not do: the ranges are not idle
    }
}

// By brute force: no point of the surface within a block's side of the block stands over its ceiling, and every ceiling
// is needed; the steepest facet is the one that a search by cross products finds.
TEST(Ceilings, StandOverAllThatIsNear) {
    auto field = make_field(151, 0.001, RandomWaves(0.004, 0.02, 29));
    field.pitch_y = 0.0013; // blocks are counted in cells
    const Ceilings ceilings = make_ceilings(field);
    const CeilingsHeader& header = ceilings.header;
    EXPECT_LT(header.fine_level, header.coarse_level);
    const auto check = [&](int level, int first, int columns) {
        const int side = 1 << level;
        for (int row = 0; row * side < 150; ++row) {
            for (int column = 0; column * side < 150; ++column) {
                float highest = -1;
                for (int j = std::max(0, (row - 1) * side); j <= std::min(150, (row + 2) * side); ++j) {
                    for (int i = std::max(0, (column - 1) * side); i <= std::min(150, (column + 2) * side); ++i) {
                        highest = std::max(highest, field.heights(i, j));
                    }
                }
                const float ceiling = ceilings.heights.at(static_cast<std::size_t>(first + row * columns + column));
                EXPECT_GT(ceiling, highest);
                EXPECT_LT(static_cast<double>(ceiling - highest), 2 * rounding);
            }
        }
    };
    check(header.fine_level, 0, header.fine_columns);
    check(header.coarse_level, header.coarse_first, header.coarse_columns);

    double steepest = 0;
    for (int row = 0; row < 150; ++row) {
        for (int column = 0; column < 150; ++column) {
            const auto point = [&](int i, int j) {
                return glm::dvec3((column + i) * field.pitch_x, (row + j) * field.pitch_y,
                                  field.heights(column + i, row + j));
            };
            for (const glm::dvec3& normal : {glm::cross(point(1, 0) - point(0, 0), point(1, 1) - point(0, 0)),
                                             glm::cross(point(1, 1) - point(0, 0), point(0, 1) - point(0, 0))}) {
                steepest = std::max(steepest, std::hypot(normal.x, normal.y) / normal.z);
            }
        }
    }
    EXPECT_GT(static_cast<double>(header.steepest), steepest);
    EXPECT_LT(static_cast<double>(header.steepest), 1.001 * steepest);
}

} // namespace
} // namespace vkfv::trace
