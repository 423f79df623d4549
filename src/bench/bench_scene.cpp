#include "bench/bench_scene.hpp"

#include "measurement/scene/assembly.hpp"
#include "trace/device/device_tracer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace vkfv::bench {

namespace {

constexpr double warm_up_seconds = 0.5;    // time in which an idle GPU's clocks rise
constexpr double still_warm_seconds = 0.1; // if the device was busy within the last second

// The largest 1, 2 or 5 times a power of ten up to a number.
std::uint64_t round_below(double number) {
    const double power = std::pow(10.0, std::floor(std::log10(number)));
    return static_cast<std::uint64_t>(power * (number >= 5 * power ? 5 : number >= 2 * power ? 2 : 1));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string name_of(trace::Traversal traversal) {
    switch (traversal) {
    case trace::Traversal::automatic:
        return "auto";
    case trace::Traversal::ray_query:
        return "ray-query";
    case trace::Traversal::quadtree:
        return "quadtree";
    case trace::Traversal::bvh:
        return "bvh";
    }
    return "";
}

} // namespace

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

double spread(const std::vector<double>& values) {
    const auto [least, most] = std::ranges::minmax(values);
    return (most - least) / median(values);
}

BenchScene::BenchScene(const BenchOptions& options)
    : options_(options), configuration_(load_configuration(options.file, options.overrides, Needs::exposure)),
      kept_({configuration_.trace.device}), device_(kept_.report()) {
    if (configuration_.trace.nonsequential) {
        throw InputError({.where = configuration_.places.at("trace.mode"),
                          .key = "trace.mode",
                          .found = "\"nonsequential\"",
                          .expected = "the sequential trace, which has stages to be timed",
                          .remedy = "Use --set trace.mode=sequential, or time vkfv image."});
    }
    specimen_ = measurement::make_specimen(configuration_);
    instrument_ = instrument_of(configuration_, specimen_);
}

std::unique_ptr<trace::Tracer> BenchScene::tracer_of(trace::TraceOptions options, std::uint64_t rays) const {
    options.rays = rays;
    return trace::make_device_tracer(instrument_, specimen_, options);
}

void BenchScene::settle_rays() {
    constexpr std::uint64_t pilot = 1 << 20;
    const double run_seconds = options_.quick ? 0.2 : 1.0;
    const auto tracer = tracer_of(configuration_.trace, pilot);
    warm_up(*tracer);
    const double rate = pilot / tracer->expose(in_focus, 0).device_seconds;
    rays_ = std::min(configuration_.trace.rays, round_below(rate * run_seconds));
}

void BenchScene::warm_up(const trace::Tracer& tracer) const {
    const double wanted = seconds_since(last_busy_) < 1 ? still_warm_seconds : warm_up_seconds;
    const auto start = std::chrono::steady_clock::now();
    do {
        tracer.expose(in_focus, 0);
    } while (seconds_since(start) < wanted);
}

Json BenchScene::timing(const trace::Tracer& tracer, int runs) const {
    warm_up(tracer);
    std::vector<double> device, wall, processor;
    trace::Image image;
    for (int run = 0; run < runs; ++run) {
        const auto processor_start = std::clock();
        image = tracer.expose(in_focus, static_cast<std::uint32_t>(run));
        processor.push_back(static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC);
        device.push_back(image.device_seconds);
        wall.push_back(image.seconds);
    }
    last_busy_ = std::chrono::steady_clock::now();
    const double rays = static_cast<double>(image.rays);
    const double seconds = median(device);
    return {{"rays", image.rays},
            {"seconds", seconds},
            {"spread", spread(device)},
            {"wall_seconds", median(wall)},
            {"processor_seconds", median(processor)},
            {"seconds_per_1e9_rays", 1e9 * seconds / rays},
            {"rays_per_second", rays / seconds},
            {"surfaces_per_ray", image.crossings / rays},
            {"ray_surfaces_per_second", image.crossings / seconds},
            {"detected_share", static_cast<double>(image.detected) / rays}};
}

std::vector<Way> BenchScene::traversals() const {
    using enum trace::Traversal;
    std::vector<Way> ways;
    const bool mesh = std::holds_alternative<specimen::Mesh>(specimen_.geometry);
    for (const auto traversal : {quadtree, bvh, ray_query}) {
        if ((traversal == quadtree && mesh) || (traversal == ray_query && !device_.ray_query)) {
            continue;
        }
        ways.push_back({name_of(traversal), configuration_.trace});
        ways.back().options.traversal = traversal;
    }
    return ways;
}

std::vector<Way> BenchScene::estimators() const {
    auto forward = configuration_.trace;
    forward.estimator = trace::Estimator::forward;
    std::vector<Way> ways = {{"forward", forward}};
    if (instrument_.turned) {
        auto backward = configuration_.trace;
        backward.estimator = trace::Estimator::backward;
        const std::uint64_t pixels = instrument_.detector_pixels().count();
        for (const std::uint64_t paths : {32, 1024}) {
            if (paths == 32 || !software()) {
                ways.push_back({fmt::format("backward, {} paths a pixel", paths), backward, paths * pixels});
            }
        }
    }
    return ways;
}

optics::Instrument instrument_of(const Configuration& configuration, const specimen::Specimen& specimen) {
    auto for_all_ways = configuration; // for both estimators and any number of bounces
    for_all_ways.instrument.turned = true;
    for_all_ways.instrument.single_scatter = true;
    return measurement::assemble_instrument(for_all_ways, specimen, std::span(&in_focus, 1));
}

} // namespace vkfv::bench
