#include "bench/pipeline_hits.hpp"

#include "specimen/intersector.hpp"
#include "spirv/pipeline_hits_closest.h"
#include "spirv/pipeline_hits_generation.h"
#include "spirv/pipeline_hits_intersection.h"
#include "spirv/pipeline_hits_miss.h"
#include "spirv/probe_hits_bvh.h"
#include "spirv/probe_hits_quadtree.h"
#include "trace/device/device_specimen.hpp"
#include "trace/interface/device_records.hpp"
#include "vulkan/ray_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace vkfv::bench {

namespace {

using kernels::ProbeRay;
using physics::f32::Hit;
using trace::Traversal;

constexpr double nm = 1e-6; // one nanometre in mm
constexpr double numerical_aperture = 0.4;

// A specimen on a device, and the hits of rays with it there.
class MeetingPlace {
  public:
    MeetingPlace(const vulkan::Device& device, const specimen::Specimen& specimen, Traversal traversal)
        : device_(device), specimen_(device, specimen, traversal), parameters_(device, sizeof(kernels::Parameters)) {
        kernels::Parameters parameters{};
        parameters.specimen = specimen_.record(1);
        parameters_.write_values(std::span<const kernels::Parameters>(&parameters, 1));
    }

    // The hits of rays. meet(commands, bindings, declarations, constants, rays) records the commands that find them.
    template <class Meet>
    std::vector<Hit> hits(const std::vector<ProbeRay>& rays, const Meet& meet) const {
        vulkan::Buffer given(device_, rays.size() * sizeof(ProbeRay));
        given.write_values(std::span<const ProbeRay>(rays));
        const vulkan::Buffer found(device_, rays.size() * sizeof(Hit));
        auto declarations = specimen_.declarations();
        declarations.push_back({kernels::BINDING_PARAMETERS, vulkan::BindingKind::uniform_buffer});
        declarations.push_back({kernels::BINDING_GIVEN, vulkan::BindingKind::storage_buffer});
        declarations.push_back({kernels::BINDING_FOUND, vulkan::BindingKind::storage_buffer});
        auto bindings = specimen_.bindings();
        bindings.push_back({kernels::BINDING_PARAMETERS, &parameters_});
        bindings.push_back({kernels::BINDING_GIVEN, &given});
        bindings.push_back({kernels::BINDING_FOUND, &found});
        vulkan::Commands commands(device_);
        meet(commands, bindings, declarations, specimen_.constants(), static_cast<std::uint32_t>(rays.size()));
        return found.read_values<Hit>(rays.size());
    }

  private:
    const vulkan::Device& device_;
    trace::DeviceSpecimen specimen_;
    vulkan::Buffer parameters_;
};

std::vector<Hit> meet_by_kernel(const vulkan::Device& device, const specimen::Specimen& specimen, Traversal traversal,
                                const std::vector<ProbeRay>& rays) {
    const std::span<const std::uint32_t> spirv = traversal == Traversal::bvh
                                                     ? std::span<const std::uint32_t>(probe_hits_bvh)
                                                     : std::span<const std::uint32_t>(probe_hits_quadtree);
    return MeetingPlace(device, specimen, traversal)
        .hits(rays, [&](vulkan::Commands& commands, const auto& bindings, const auto& declarations,
                        const auto& constants, std::uint32_t count) {
            const vulkan::Kernel kernel(device, "probe_hits", spirv, declarations, sizeof count, constants);
            const auto groups = vulkan::groups_of(count, 64);
            commands.dispatch(kernel, bindings, count, groups.x, groups.y);
            commands.submit_and_wait();
        });
}

std::vector<Hit> meet_by_pipeline(const vulkan::Device& device, const specimen::Specimen& specimen,
                                  const std::vector<ProbeRay>& rays) {
    const bool boxes = specimen::record(specimen, 1).kind == physics::f64::SPECIMEN_ANALYTIC;
    const vulkan::RayStages stages{.generation = pipeline_hits_generation,
                                   .miss = pipeline_hits_miss,
                                   .closest_hit = pipeline_hits_closest,
                                   .intersection = boxes ? std::span<const std::uint32_t>(pipeline_hits_intersection)
                                                         : std::span<const std::uint32_t>()};
    return MeetingPlace(device, specimen, Traversal::ray_query)
        .hits(rays, [&](vulkan::Commands& commands, const auto& bindings, const auto& declarations,
                        const auto& constants, std::uint32_t count) {
            const vulkan::RayPipeline pipeline(device, "pipeline_hits", stages, declarations, 0, constants);
            pipeline.record(commands, bindings, {}, count);
            commands.submit_and_wait();
        });
}

std::vector<ProbeRay> arriving_rays(const specimen::Specimen& specimen, std::uint64_t count, std::mt19937_64& random) {
    const auto record = specimen::record(specimen, 1);
    std::uniform_real_distribution<double> uniform;
    std::vector<ProbeRay> rays(count);
    for (ProbeRay& ray : rays) {
        const double sine = numerical_aperture * std::sqrt(uniform(random));
        const double angle = 2 * std::numbers::pi * uniform(random);
        const double x = record.x_min + uniform(random) * (record.x_max - record.x_min);
        const double y = record.y_min + uniform(random) * (record.y_max - record.y_min);
        ray.origin = glm::vec3(x, y, record.top);
        ray.direction = glm::vec3(sine * std::cos(angle), sine * std::sin(angle), -std::sqrt(1 - sine * sine));
    }
    return rays;
}

std::vector<ProbeRay> leaving_rays(std::span<const Hit> hits, std::mt19937_64& random) {
    std::normal_distribution<float> normal;
    std::vector<ProbeRay> rays;
    for (const Hit& hit : hits) {
        if (hit.found == 1) {
            const glm::vec3 aside(normal(random), normal(random), normal(random));
            // The sphere is scaled to 0.999, so that no sum of normal and point is zero.
            rays.push_back(
                {physics::f32::scatter_origin(hit), glm::normalize(hit.normal + 0.999F * glm::normalize(aside))});
        }
    }
    return rays;
}

// True if both hits lie within 1 nm across the surface: two points of one grazing ray lie farther apart in height.
bool lie_in_one_surface(const Hit& a, const Hit& b) {
    return a.found == 1 && b.found == 1 &&
           std::abs(glm::dot(glm::dvec3(a.position) - glm::dvec3(b.position), glm::dvec3(a.normal))) <= nm;
}

bool is_of_rounding(const specimen::Intersector& reference, const ProbeRay& ray, const Hit& hit) {
    for (int place = 0; place < 27; ++place) {
        const glm::dvec3 aside(place % 3 - 1, place / 3 % 3 - 1, place / 9 - 1);
        const auto moved = reference.hit(glm::dvec3(ray.origin) + nm * aside, glm::dvec3(ray.direction));
        if (moved.found == hit.found &&
            (hit.found == 0 || std::abs(moved.position.z - static_cast<double>(hit.position.z)) < nm)) {
            return true;
        }
    }
    return false;
}

void compare(const specimen::Intersector& reference, std::span<const ProbeRay> rays, std::span<const Hit> one,
             std::span<const Hit> other, HitDifferences& sum) {
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const Hit& a = one[k];
        const Hit& b = other[k];
        const double height = std::abs(static_cast<double>(a.position.z) - static_cast<double>(b.position.z));
        const bool found_alike = a.found == b.found;
        const bool is_apart = found_alike && a.found == 1 && height > nm;
        ++sum.rays;
        sum.both += found_alike && a.found == 1 ? 1 : 0;
        sum.one_alone += found_alike ? 0 : 1;
        sum.apart += is_apart ? 1 : 0;
        if (found_alike && a.found == 1 && !is_apart) {
            sum.largest_height_apart = std::max(sum.largest_height_apart, height);
        }
        if ((!found_alike || is_apart) && !lie_in_one_surface(a, b) &&
            !(is_of_rounding(reference, rays[k], a) && is_of_rounding(reference, rays[k], b))) {
            ++sum.unexplained;
        }
    }
}

} // namespace

HitDifferences compare_pipeline_hits(const specimen::Specimen& specimen, const specimen::Specimen& beside,
                                     Traversal traversal, const std::string& device_selector, std::uint64_t rays,
                                     std::uint64_t seed) {
    const vulkan::Device device({.selector = device_selector, .ray_pipelines = true});
    const specimen::Intersector reference(specimen);
    const Traversal chosen = trace::choose_traversal(device.report(), beside, traversal).traversal;
    std::mt19937_64 random(seed);
    HitDifferences result;
    const auto meet = [&](const std::vector<ProbeRay>& these) {
        const auto by_pipeline = meet_by_pipeline(device, specimen, these);
        auto by_kernel = meet_by_kernel(device, beside, chosen, these);
        compare(reference, these, by_pipeline, by_kernel, result);
        return by_kernel;
    };
    const auto leaving = leaving_rays(meet(arriving_rays(specimen, rays / 2, random)), random);
    if (!leaving.empty()) {
        meet(leaving);
    }
    return result;
}

} // namespace vkfv::bench
