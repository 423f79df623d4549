#include "bench/bench.hpp"

#include "configuration/configuration.hpp"
#include "measurement/assembly.hpp"

#include "bench/agreement.hpp"
#include "bench/hit_times.hpp"
#include "bench/stage_times.hpp"
#include "core/units.hpp"
#include "images/image_file.hpp"
#include "specimen/kinds.hpp"
#include "trace/device_tracer.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include <unistd.h>

namespace vkfv::bench {

const std::vector<std::string> bench_parts = {"validation", "stages", "whole",     "forms",    "traversals", "hits",
                                              "estimators", "rays",   "triangles", "surfaces", "pixels",     "peer"};

namespace {

constexpr double in_focus = 0;
constexpr double warm_up_seconds = 0.5;    // an idle GPU's clocks rise as slowly
constexpr double still_warm_seconds = 0.1; // where the device was busy within the last second
constexpr double false_alarms = 1e-4;      // of a whole validation
constexpr int seeds = 8;                   // of a variance

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

double spread(const std::vector<double>& values) {
    const auto [least, most] = std::ranges::minmax(values);
    return (most - least) / median(values);
}

// The largest 1, 2 or 5 times a power of ten up to a number.
std::uint64_t round_below(double number) {
    const double power = std::pow(10.0, std::floor(std::log10(number)));
    return static_cast<std::uint64_t>(power * (number >= 5 * power ? 5 : number >= 2 * power ? 2 : 1));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Measured measured(const trace::Image& image) {
    Measured result{image.flux, image.standard_error};
    for (double& value : result.variance.values) {
        value *= value;
    }
    return result;
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

// A way of tracing that is compared with the others.
struct Way {
    std::string name;
    trace::TraceOptions options;
    std::uint64_t rays = 0; // of an image; 0: those of a run
};

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

class Bench {
  public:
    explicit Bench(const BenchOptions& options)
        : options_(options), configuration_(load_configuration(options.file, options.overrides, Needs::exposure)),
          kept_({configuration_.trace.device}), device_(kept_.report()), run_seconds_(options.quick ? 0.2 : 1.0) {
        if (configuration_.trace.nonsequential) {
            throw InputError({.where = configuration_.places.at("trace.mode"),
                              .key = "trace.mode",
                              .found = "\"nonsequential\"",
                              .expected = "the sequential trace, which has stages to be timed",
                              .remedy = "Use --set trace.mode=sequential, or time --image."});
        }
        specimen_ = measurement::make_specimen(configuration_);
        instrument_ = instrument_of(configuration_, specimen_);
    }

    Json measure(const std::function<void(const Json&)>& after_part) {
        Json report;
        report["program"] = "vkfv " VKFV_VERSION;
        report["commit"] = options_.commit;
        report["date"] = now();
        report["device"] = device_.name;
        report["driver"] = device_.driver;
        report["device_type"] = device_.type;
        report["configuration"] = options_.file.string();
        report["aimed_share"] = std::pow(instrument_.constants.emission_sine, 2);
        report["runs"] = options_.runs;
        if (wants("validation")) {
            report["validation"] = validation();
            const auto agrees = [](const Json& check) { return check["agrees"].get<bool>(); };
            if (!std::ranges::all_of(report["validation"], agrees)) {
                throw RunError(fmt::format("images of one scene do not agree, and nothing was timed:\n{}",
                                           report["validation"].dump(2)));
            }
        }
        if (wants("stages")) {
            report["stages"] = stages();
            after_part(report);
        }
        const bool exposes = std::ranges::any_of(bench_parts, [&](const std::string& part) {
            return part != "validation" && part != "stages" && part != "hits" && wants(part);
        });
        if (exposes) {
            rays_ = rays_of_a_run();
            report["rays_per_run"] = rays_;
        }
        if (wants("whole")) {
            const auto tracer = tracer_of(configuration_.trace, rays_);
            report["traversal"] = tracer->description();
            report["whole"] = timing(*tracer);
            after_part(report);
        }
        if (wants("forms")) {
            report["forms"] = forms();
            after_part(report);
        }
        if (wants("traversals")) {
            report["traversals"] = traversal_timings();
            after_part(report);
        }
        if (wants("hits")) {
            report["hits"] = hits();
            after_part(report);
        }
        if (wants("estimators")) {
            report["estimators"] = estimator_timings();
            after_part(report);
        }
        if (wants("rays")) {
            report["scaling"]["rays"] = over_rays();
            after_part(report);
        }
        if (wants("triangles")) {
            report["scaling"]["triangles"] = over_triangles();
            after_part(report);
        }
        if (wants("surfaces")) {
            report["scaling"]["surfaces"] = over_surfaces();
            after_part(report);
        }
        if (wants("pixels")) {
            report["scaling"]["pixels"] = over_pixels();
            after_part(report);
        }
        if (wants("peer") && !options_.peer.empty()) {
            report["peer"] = beside_peer();
        }
        return report;
    }

  private:
    bool wants(const std::string& part) const {
        return std::ranges::find(options_.parts, part) != options_.parts.end();
    }

    static std::string now() {
        const std::time_t time = std::time(nullptr);
        std::tm utc{};
        gmtime_r(&time, &utc);
        return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                           utc.tm_hour, utc.tm_min, utc.tm_sec);
    }

    static optics::Instrument instrument_of(const Configuration& configuration, const specimen::Specimen& specimen) {
        auto turned = configuration; // for the backward estimator
        turned.instrument.turned = !configuration.instrument.ring;
        return measurement::assemble_instrument(turned, specimen, std::span(&in_focus, 1));
    }

    std::unique_ptr<trace::Tracer> tracer_of(trace::TraceOptions options, std::uint64_t rays) const {
        options.rays = rays;
        return trace::make_device_tracer(instrument_, specimen_, options);
    }

    bool software() const { return device_.type == "CPU"; }

    // As many rays as the device traces in the time of a run, at most the configuration's.
    std::uint64_t rays_of_a_run() const {
        constexpr std::uint64_t pilot = 1 << 20;
        const auto tracer = tracer_of(configuration_.trace, pilot);
        warm_up(*tracer);
        const double rate = pilot / tracer->expose(in_focus, 0).device_seconds;
        return std::min(configuration_.trace.rays, round_below(rate * run_seconds_));
    }

    void warm_up(const trace::Tracer& tracer) const {
        const double wanted = seconds_since(last_busy_) < 1 ? still_warm_seconds : warm_up_seconds;
        const auto start = std::chrono::steady_clock::now();
        do {
            tracer.expose(in_focus, 0);
        } while (seconds_since(start) < wanted);
    }

    Json timing(const trace::Tracer& tracer, int runs) const {
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
    Json timing(const trace::Tracer& tracer) const { return timing(tracer, options_.runs); }

    // Those that the specimen and the device admit.
    std::vector<Way> traversals() const {
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

    // The first is what the others' efficiency is relative to.
    std::vector<Way> estimators() const {
        auto forward = configuration_.trace;
        forward.estimator = trace::Estimator::forward;
        std::vector<Way> ways = {{"forward", forward}};
        if (instrument_.turned) {
            auto backward = configuration_.trace;
            backward.estimator = trace::Estimator::backward;
            const auto side = static_cast<std::uint64_t>(instrument_.constants.detector_pixels);
            for (const std::uint64_t paths : {32, 1024}) {
                if (paths == 32 || !software()) {
                    ways.push_back({fmt::format("backward, {} paths a pixel", paths), backward, paths * side * side});
                }
            }
        }
        return ways;
    }

    // Every way against the first traversal, each with random numbers of its own; besides a twin whose lobe is wider or
    // narrower than the scene's, which has to be found apart.
    Json validation() const {
        const std::uint64_t rays = software() ? options_.quick ? 500'000 : 2'000'000 : 20'000'000;
        std::vector<Way> ways = traversals();
        const auto reference_way = ways.front();
        ways.erase(ways.begin());
        const auto each_estimator = estimators();
        ways.insert(ways.end(), each_estimator.begin() + 1, each_estimator.end());
        const double level = false_alarms / static_cast<double>(ways.size() + 1);
        spdlog::info("validation: {} rays an image", rays);
        std::uint32_t image = 0;
        const auto expose = [&](const Way& way) {
            return measured(tracer_of(way.options, way.rays > 0 ? way.rays : rays)->expose(in_focus, image++));
        };
        // First, since it fails at once if it fails.
        Measured peer;
        if (!options_.peer.empty()) {
            peer = image_of_peer(rays);
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
        auto& lobes = specimen_.material.lobes;
        if (lobes.size() == 1 && lobes[0].model == "henyey-greenstein") {
            auto twin = specimen_;
            double& g = twin.material.lobes[0].parameters[0];
            g += g < 0.5 ? 0.1 : -0.1;
            auto options = reference_way.options;
            options.rays = rays;
            check(fmt::format("a twin with g = {:.2f}, which must be found apart", g),
                  measured(trace::make_device_tracer(instrument_, twin, options)->expose(in_focus, image++)), true);
        }
        if (!options_.peer.empty()) {
            check("the peer", peer, false);
        }
        return checks;
    }

    // Without its gate, so that ours is tested too.
    Measured image_of_peer(std::uint64_t rays) const {
        const auto file = std::filesystem::temp_directory_path() / fmt::format("vkfv_bench_peer_{}.tif", getpid());
        const auto told = run_peer(options_.peer, options_.file, options_.overrides,
                                   {"--rays", fmt::format("{}", rays), "--gate", "off", "--out", file.string()});
        const auto flux = images::read_image(file);
        std::filesystem::remove(file);
        Grid<double> watts(flux.columns, flux.rows);
        std::ranges::copy(flux.values, watts.values.begin());
        return measured_counts(watts, told["watts_per_ray"].get<double>());
    }

    Json stages() const {
        spdlog::info("stages");
        const auto times = time_stages(instrument_, specimen_, configuration_.trace, in_focus, options_.runs);
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

    // Sharp and wide lobe, one and four bounces, and the specimen as it comes from an STL of its triangles.
    Json forms() const {
        Json result = Json::array();
        const bool one_lobe =
            specimen_.material.lobes.size() == 1 && specimen_.material.lobes[0].model == "henyey-greenstein";
        if (!one_lobe) {
            return result;
        }
        auto form = specimen_;
        const auto* field = std::get_if<specimen::HeightField>(&specimen_.geometry);
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
                    auto options = configuration_.trace;
                    options.max_bounces = bounces;
                    options.rays = rays_;
                    if (as_mesh && options.traversal == trace::Traversal::quadtree) {
                        options.traversal = trace::Traversal::automatic;
                    }
                    const auto tracer = trace::make_device_tracer(instrument_, form, options);
                    Json entry = {{"g", g},
                                  {"max_bounces", bounces},
                                  {"geometry", as_mesh ? "mesh" : "as configured"},
                                  {"traversal", tracer->description()}};
                    entry.update(timing(*tracer));
                    result.push_back(entry);
                }
            }
        }
        return result;
    }

    Json traversal_timings() const {
        Json result = Json::array();
        for (const auto& way : traversals()) {
            spdlog::info("traversal {}", way.name);
            Json entry = {{"name", way.name}};
            entry.update(timing(*tracer_of(way.options, rays_)));
            result.push_back(entry);
        }
        return result;
    }

    Json hits() const {
        using enum bench::HitOrder;
        constexpr double numerical_aperture = 0.4;
        const std::vector<std::pair<bench::HitOrder, std::string>> orders = {
            {random, "random"}, {morton, "morton"}, {leaving, "leaving"}};
        Json result = Json::array();
        for (const auto& way : traversals()) {
            for (const auto& [order, name] : orders) {
                spdlog::info("hits by {}, {}", way.name, name);
                const auto times = time_hits(specimen_, way.options, numerical_aperture, order, options_.runs);
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

    Json estimator_timings() const {
        Json result = Json::array();
        double of_first = 0;
        for (const auto& way : estimators()) {
            spdlog::info("estimator {}: variance of {} seeds", way.name, seeds);
            const auto tracer = tracer_of(way.options, way.rays > 0 ? way.rays : rays_);
            Json entry = {{"name", way.name}};
            entry.update(timing(*tracer));
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

    Json over_rays() const {
        Json result = Json::array();
        for (const std::uint64_t part : {1000, 100, 10, 1}) {
            const std::uint64_t rays = std::max<std::uint64_t>(1, rays_ / part);
            spdlog::info("{} rays", rays);
            result.push_back(timing(*tracer_of(configuration_.trace, rays)));
        }
        return result;
    }

    // Runs of a point of a scaling, where sizes count more than medians.
    int few_runs() const { return std::min(options_.runs, 3); }

    // The same surface by other numbers of triangles.
    Json over_triangles() const {
        Json result = Json::array();
        const double size = specimen::size_of(configuration_.specimen->shape);
        if (!std::holds_alternative<specimen::HeightField>(specimen_.geometry) || size == 0) {
            return result;
        }
        std::vector<double> numbers = {1e3, 1e4, 1e5, 1e6};
        if (!options_.quick) {
            numbers.insert(numbers.end(), {4e6, 1.6e7});
        }
        for (const double number : numbers) {
            auto description = *configuration_.specimen;
            const double cells = std::round(std::sqrt(number / 2));
            description.shape = specimen::with_pitch(std::move(description.shape), size / cells);
            const auto specimen = specimen::make(description);
            for (const auto& way : traversals()) {
                if (way.name == "bvh" && software() && number > 1e6) {
                    continue; // on two cores it takes longer to build than all else together
                }
                spdlog::info("{:.0f} triangles by {}", 2 * cells * cells, way.name);
                auto options = way.options;
                options.rays = rays_;
                Json entry = {{"triangles", 2 * cells * cells}, {"traversal", way.name}};
                entry.update(timing(*trace::make_device_tracer(instrument_, specimen, options), few_runs()));
                result.push_back(entry);
            }
        }
        return result;
    }

    // The library's objectives with the configuration's tube lens and specimen, each pupil filled, with and without the
    // beam splitter's glass.
    Json over_surfaces() const {
        Json result = Json::array();
        const double magnification = std::abs(instrument_.first_order.magnification);
        for (const char* objective : {"5x_0.15", "10x_0.28", "20x_0.41", "50x_0.66", "100x_0.83"}) {
            auto overrides = options_.overrides;
            overrides.push_back({"objective.prescription", fmt::format("\"{}\"", objective), "--bench"});
            auto configuration = load_configuration(options_.file, overrides, Needs::exposure);
            auto& description = configuration.instrument;
            for (const bool glass : {true, false}) {
                if (!glass) {
                    if (description.splitter.kind == optics::BeamSplitter::Kind::ideal) {
                        continue;
                    }
                    description.splitter.kind = optics::BeamSplitter::Kind::ideal;
                }
                const auto first_order = measurement::assemble_instrument(configuration).first_order;
                auto fitted = configuration;
                fitted.instrument.source_radius = first_order.pupil_radius_in_source;
                // A wider field of view than the configuration's would be lit beyond its specimen.
                if (fitted.instrument.field_stop_radius) {
                    *fitted.instrument.field_stop_radius *=
                        std::min(1.0, std::abs(first_order.magnification) / magnification);
                }
                spdlog::info("objective {} with {}", objective, glass ? "the splitter's glass" : "an ideal splitter");
                const auto instrument = instrument_of(fitted, specimen_);
                auto options = configuration_.trace;
                options.rays = rays_;
                Json entry = {
                    {"objective", objective},
                    {"splitter", glass ? "glass" : "ideal"},
                    {"surfaces", instrument.constants.illumination_count + instrument.constants.imaging_count},
                    {"numerical_aperture", instrument.first_order.numerical_aperture}};
                entry.update(timing(*trace::make_device_tracer(instrument, specimen_, options), few_runs()));
                result.push_back(entry);
            }
        }
        return result;
    }

    Json over_pixels() const {
        Json result = Json::array();
        for (const int pixels : {64, 256, 1024, 4096}) {
            spdlog::info("{} x {} pixels", pixels, pixels);
            auto configuration = configuration_;
            configuration.instrument.detector_pixels = pixels;
            const auto instrument = instrument_of(configuration, specimen_);
            auto options = configuration_.trace;
            options.rays = rays_;
            Json entry = {{"pixels_along_a_side", pixels}};
            entry.update(timing(*trace::make_device_tracer(instrument, specimen_, options), few_runs()));
            result.push_back(entry);
        }
        return result;
    }

    // In turn, so that whatever else the machine does slows both.
    Json beside_peer() const {
        const std::uint64_t rays = std::min(rays_, std::uint64_t{10'000'000});
        const auto tracer = tracer_of(configuration_.trace, rays_);
        warm_up(*tracer);
        std::vector<double> seconds, processor, ratio, processor_ratio;
        Json told;
        for (int run = 0; run < options_.runs; ++run) {
            spdlog::info("peer, run {} of {}", run + 1, options_.runs);
            told = run_peer(options_.peer, options_.file, options_.overrides,
                            {"--rays", fmt::format("{}", rays), "--seed", fmt::format("{}", run + 1)});
            seconds.push_back(told["seconds"][0].get<double>());
            processor.push_back(told["processor_seconds"][0].get<double>());
            const auto start = std::clock();
            const auto image = tracer->expose(in_focus, static_cast<std::uint32_t>(run));
            const double ours_per_its = static_cast<double>(image.rays) / static_cast<double>(rays);
            processor_ratio.push_back(ours_per_its * processor.back() /
                                      (static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC));
            ratio.push_back(ours_per_its * seconds.back() / image.seconds);
        }
        return {{"threads", told["threads"]},
                {"packet", told["packet"]},
                {"block", told["block"]},
                {"rays", rays},
                {"seconds", median(seconds)},
                {"spread", spread(seconds)},
                {"rays_per_second", static_cast<double>(rays) / median(seconds)},
                {"processor_seconds", median(processor)},
                {"ratio", median(ratio)},
                {"ratio_spread", spread(ratio)},
                {"processor_ratio", median(processor_ratio)}};
    }

    const BenchOptions& options_;
    Configuration configuration_;
    // Each tracer opens the device anew. With one open all along the driver stays loaded: NVIDIA's, loaded
    // anew some fifty times, was seen to fail.
    vulkan::Device kept_;
    vulkan::DeviceReport device_;
    double run_seconds_;
    specimen::Specimen specimen_;
    optics::Instrument instrument_;
    std::uint64_t rays_ = 0;
    mutable std::chrono::steady_clock::time_point last_busy_{};
};

} // namespace

Json measure_bench(const BenchOptions& options, const std::function<void(const Json&)>& after_part) {
    return Bench(options).measure(after_part);
}

} // namespace vkfv::bench
