#include "bench/bench_parts.hpp"
#include "bench/hit_times.hpp"
#include "bench/pipeline_hits.hpp"
#include "bench/stage_times.hpp"
#include "core/mathematics/units.hpp"
#include "trace/device/device_tracer.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace vkfv::bench {

namespace {

constexpr int seeds = 8; // images from which a variance is found

specimen::Mesh mesh_of(const specimen::HeightField& field) {
    specimen::Mesh mesh;
    const auto columns = static_cast<unsigned>(field.heights.columns);
    for (int row = 0; row < field.heights.rows; ++row) {
        for (int column = 0; column < field.heights.columns; ++column) {
            mesh.vertices.emplace_back(field.x_min + column * field.pitch_x, field.y_min + row * field.pitch_y,
                                       field.heights(column, row));
            if (column + 1 < field.heights.columns && row + 1 < field.heights.rows) {
                const auto corner = static_cast<unsigned>(field.heights.index(column, row));
                mesh.triangles.emplace_back(corner, corner + 1, corner + columns + 1);
                mesh.triangles.emplace_back(corner, corner + columns + 1, corner + columns);
            }
        }
    }
    return mesh;
}

} // namespace

Json stages(const BenchScene& scene) {
    spdlog::info("stages");
    const auto times =
        time_stages(scene.instrument(), scene.specimen(), scene.configuration().trace, in_focus, scene.options().runs);
    return {{"traversal", times.description},
            {"rays", times.rays},
            {"seconds_per_1e9_rays", 1e9 * times.seconds_per_ray},
            {"rays_per_second", 1 / times.seconds_per_ray},
            {"spread", times.spread},
            {"surfaces_per_ray", times.surfaces_per_ray},
            {"surfaces_per_detected_ray", times.surfaces_per_detected_ray},
            {"ray_surfaces_per_second", times.surfaces_per_ray / times.seconds_per_ray},
            {"shares",
             {{"source", times.source},
              {"illumination", times.illumination},
              {"specimen", times.specimen},
              {"imaging", times.imaging},
              {"detection", times.detection}}}};
}

Json forms(const BenchScene& scene) {
    Json result = Json::array();
    const bool one_lobe =
        scene.specimen().material.lobes.size() == 1 && scene.specimen().material.lobes[0].model == "henyey-greenstein";
    if (!one_lobe) {
        return result;
    }
    auto form = scene.specimen();
    const auto* field = std::get_if<specimen::HeightField>(&scene.specimen().geometry);
    for (const bool as_mesh : {false, true}) {
        if (as_mesh && !field) {
            continue;
        }
        if (as_mesh) {
            form.geometry = mesh_of(*field);
        }
        for (const double g : {0.3, 0.8}) {
            for (const int bounces : {1, 4}) {
                spdlog::info("{}, g = {}, at most {} bounces", as_mesh ? "mesh" : "as configured", g, bounces);
                form.material.lobes[0].parameters[0] = g;
                auto options = scene.configuration().trace;
                options.max_bounces = bounces;
                options.rays = scene.rays();
                if (as_mesh && options.traversal == trace::Traversal::quadtree) {
                    options.traversal = trace::Traversal::automatic;
                }
                const auto tracer = trace::make_device_tracer(scene.instrument(), form, options);
                Json entry = {{"g", g},
                              {"max_bounces", bounces},
                              {"geometry", as_mesh ? "mesh" : "as configured"},
                              {"traversal", tracer->description()}};
                entry.update(scene.timing(*tracer));
                result.push_back(entry);
            }
        }
    }
    return result;
}

Json traversal_timings(const BenchScene& scene) {
    Json result = Json::array();
    for (const auto& way : scene.traversals()) {
        spdlog::info("traversal {}", way.name);
        Json entry = {{"name", way.name}};
        entry.update(scene.timing(*scene.tracer_of(way.options, scene.rays())));
        result.push_back(entry);
    }
    return result;
}

Json pipeline(const BenchScene& scene) {
    Json result = Json::array();
    if (!scene.device().ray_pipeline) {
        return result;
    }
    const std::uint64_t rays = scene.options().quick ? 20'000 : 1'000'000;
    for (const auto& way : scene.traversals()) {
        if (way.options.traversal != trace::Traversal::ray_query) {
            spdlog::info("rays by a ray-tracing pipeline and by {}", way.name);
            const auto found = compare_pipeline_hits(scene.specimen(), scene.specimen(), way.options.traversal,
                                                     way.options.device, rays, way.options.seed);
            result.push_back({{"traversal", way.name},
                              {"rays", found.rays},
                              {"both", found.both},
                              {"one_alone", found.one_alone},
                              {"apart", found.apart},
                              {"unexplained", found.unexplained},
                              {"largest_height_apart_nm", 1000 * um_per_mm * found.largest_height_apart}});
        }
    }
    return result;
}

Json hits(const BenchScene& scene) {
    using enum bench::HitOrder;
    constexpr double numerical_aperture = 0.4;
    const std::vector<std::pair<bench::HitOrder, std::string>> orders = {
        {random, "random"}, {morton, "morton"}, {leaving, "leaving"}};
    Json result = Json::array();
    for (const auto& way : scene.traversals()) {
        for (const auto& [order, name] : orders) {
            spdlog::info("hits by {}, {}", way.name, name);
            const auto times =
                time_hits(scene.specimen(), way.options, numerical_aperture, order, scene.options().runs);
            result.push_back({{"traversal", way.name},
                              {"order", name},
                              {"numerical_aperture", numerical_aperture},
                              {"hits_per_second", times.hits_per_second},
                              {"spread", times.spread},
                              {"share_met", times.share_met}});
        }
    }
    return result;
}

Json estimator_timings(const BenchScene& scene) {
    Json result = Json::array();
    double of_first = 0;
    for (const auto& way : scene.estimators()) {
        spdlog::info("estimator {}: variance of {} seeds", way.name, seeds);
        const auto tracer = scene.tracer_of(way.options, way.rays > 0 ? way.rays : scene.rays());
        Json entry = {{"name", way.name}};
        entry.update(scene.timing(*tracer));
        std::vector<double> sum, squares;
        for (int seed = 0; seed < seeds; ++seed) {
            const auto image = tracer->expose(in_focus, 1000u + static_cast<std::uint32_t>(seed));
            sum.resize(image.flux.values.size());
            squares.resize(sum.size());
            for (std::size_t k = 0; k < sum.size(); ++k) {
                sum[k] += image.flux.values[k];
                squares[k] += image.flux.values[k] * image.flux.values[k];
            }
        }
        double variance = 0;
        for (std::size_t k = 0; k < sum.size(); ++k) {
            variance += (squares[k] - sum[k] * sum[k] / seeds) / (seeds - 1);
        }
        const double efficiency = 1 / (variance * entry["seconds"].get<double>());
        of_first = result.empty() ? efficiency : of_first;
        entry["seeds"] = seeds;
        entry["variance"] = variance;
        entry["relative_efficiency"] = efficiency / of_first;
        result.push_back(entry);
    }
    return result;
}

} // namespace vkfv::bench
