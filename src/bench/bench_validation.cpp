#include "bench/agreement.hpp"
#include "bench/bench_parts.hpp"
#include "images/image_file.hpp"
#include "trace/device/device_tracer.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include <unistd.h>

namespace vkfv::bench {

namespace {

constexpr double false_alarms = 1e-4; // over a whole validation

Measured measured(const trace::Image& image) {
    Measured result{image.flux, image.standard_error};
    for (double& value : result.variance.values) {
        value *= value;
    }
    return result;
}

// The peer's image, traced without its gate, so that vkfv's gate is tested too.
Measured image_of_peer(const BenchScene& scene, std::uint64_t rays) {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("vkfv_bench_peer_{}.tif", getpid());
    const auto told = run_peer(scene.options().peer, scene.options().file, scene.options().overrides,
                               {"--rays", fmt::format("{}", rays), "--gate", "off", "--out", file.string()});
    const auto flux = images::read_image(file);
    std::filesystem::remove(file);
    Grid<double> watts(flux.columns, flux.rows);
    std::ranges::copy(flux.values, watts.values.begin());
    return measured_counts(watts, told["watts_per_ray"].get<double>());
}

} // namespace

Json validation(const BenchScene& scene) {
    const std::uint64_t rays = scene.software() ? scene.options().quick ? 500'000 : 2'000'000 : 20'000'000;
    std::vector<Way> ways = scene.traversals();
    const auto reference_way = ways.front();
    ways.erase(ways.begin());
    const auto each_estimator = scene.estimators();
    ways.insert(ways.end(), each_estimator.begin() + 1, each_estimator.end());
    const double level = false_alarms / static_cast<double>(ways.size() + 1);
    spdlog::info("validation: {} rays an image", rays);
    std::uint32_t image = 0;
    const auto expose = [&](const Way& way) {
        return measured(scene.tracer_of(way.options, way.rays > 0 ? way.rays : rays)->expose(in_focus, image++));
    };
    // The peer comes first, since it fails at once if it fails.
    Measured peer;
    if (!scene.options().peer.empty()) {
        peer = image_of_peer(scene, rays);
    }
    const auto reference = expose(reference_way);
    Json checks = Json::array();
    const auto check = [&](const std::string& what, const Measured& other, bool twin) {
        const auto agreement = compare(reference, other);
        checks.push_back({{"what", fmt::format("{} against {}", reference_way.name, what)},
                          {"rays", rays},
                          {"total_z", agreement.total_z},
                          {"chi_square", agreement.chi_square},
                          {"degrees", agreement.degrees},
                          {"p", agreement.p},
                          {"agrees", twin ? !agreement.holds(level) : agreement.holds(level)}});
    };
    for (const auto& way : ways) {
        check(way.name, expose(way), false);
    }
    auto& lobes = scene.specimen().material.lobes;
    if (lobes.size() == 1 && lobes[0].model == "henyey-greenstein") {
        auto twin = scene.specimen();
        double& g = twin.material.lobes[0].parameters[0];
        g += g < 0.5 ? 0.1 : -0.1;
        auto options = reference_way.options;
        options.rays = rays;
        check(fmt::format("a twin with g = {:.2f}, which must be found apart", g),
              measured(trace::make_device_tracer(scene.instrument(), twin, options)->expose(in_focus, image++)), true);
    }
    if (!scene.options().peer.empty()) {
        check("the peer", peer, false);
    }
    return checks;
}

} // namespace vkfv::bench
