// The measurements of vkfv bench, part by part, as one JSON document:
//   program, commit, date (UTC), device, driver, device_type, configuration, traversal
//   aimed_share       of the source's flux that launched rays stand for; runs, rays_per_run
//   validation[]      what, rays, total_z, chi_square, degrees, p, agrees
//   stages            of one batch: seconds_per_1e9_rays and its shares source, illumination, specimen, imaging,
//                     detection
//   whole             a timing: rays, seconds, spread ((max - min) / median), wall_seconds, processor_seconds,
//                     seconds_per_1e9_rays, rays_per_second, surfaces_per_ray, ray_surfaces_per_second, detected_share
//   forms[]           g, max_bounces, geometry ("as configured", "mesh": the height field's triangles), and a timing
//   traversals[]      name and a timing
//   hits[]            traversal, order, numerical_aperture, hits_per_second, spread, share_met
//   pipeline[]        of rays by a ray-tracing pipeline and by a traversal: traversal, rays, both, one_alone, apart,
//                     unexplained, largest_height_apart_nm (pipeline_hits.hpp)
//   estimators[]      name, a timing, seeds, variance (W^2, summed over the pixels), relative_efficiency (forward: 1)
//   scaling           rays[], triangles[], surfaces[], pixels[]: the quantity and a timing
//   peer              rays, seconds, rays_per_second, processor_seconds, ratio (our rate over its), processor_ratio
// All seconds are medians over the runs; `seconds` are the device's own. Parts that were not measured are absent.
#pragma once

#include "core/toml/toml_document.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vkfv::bench {

using Json = nlohmann::ordered_json;

// The parts, in the order in which they are measured.
extern const std::vector<std::string> bench_parts;

struct BenchOptions {
    std::filesystem::path file; // configuration
    std::vector<TomlOverride> overrides;
    int runs = 5;                   // number of runs, whose median counts
    std::vector<std::string> parts; // names from bench_parts
    bool quick = false;             // shorter runs and fewer sizes
    std::filesystem::path peer;     // the program vkfv_bench_peer; empty: none
    std::string commit;             // commit that the report names
};

// Measures the parts. Throws RunError if the validation fails: then nothing is timed. after_part: gets the report so
// far, so that nothing is lost if a later part fails.
Json measure_bench(const BenchOptions& options, const std::function<void(const Json&)>& after_part);

// The report of the peer itself (--json of vkfv_bench_peer) on a configuration with overrides. Throws RunError.
Json run_peer(const std::filesystem::path& program, const std::filesystem::path& configuration,
              const std::vector<TomlOverride>& overrides, const std::vector<std::string>& arguments);

// The report as lines of text.
std::string bench_text(const Json& report);

// The report as one SVG.
std::string bench_picture(const Json& report);

} // namespace vkfv::bench
