// vkfv_bench_peer: one exposure of a configuration, traced on the CPU by Embree and lenses in double
// (chain.hpp).
#include "chain.hpp"

#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "measurement/scene/assembly.hpp"
#include "trace/interface/traced_instrument.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>

namespace {

using vkfv::InputError;

[[noreturn]] void refuse(const vkfv::Configuration& configuration, std::string key, std::string found,
                         std::string expected, std::string remedy) {
    throw InputError({.where = {.file = configuration.file},
                      .key = std::move(key),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

std::vector<peer::Surface> train(const vkfv::optics::Instrument& instrument, int first, int count) {
    using namespace vkfv::physics::f64;
    std::vector<peer::Surface> result;
    for (int i = first; i < first + count; ++i) {
        const auto& from = instrument.surfaces[static_cast<std::size_t>(i)];
        peer::Surface to;
        to.distance = from.distance;
        to.curvature = from.curvature;
        to.conic = from.conic;
        to.index_ratio = from.index_before / from.index_after;
        to.semi_diameter_squared = (from.flags & SURFACE_CLIPPED) != 0 ? from.semi_diameter_squared : peer::unlimited;
        using Shape = peer::Surface::Shape;
        to.shape = from.curvature == 0 ? Shape::plane : from.conic == 0 ? Shape::sphere : Shape::conic;
        if ((from.flags & SURFACE_ASPHERIC) != 0) {
            to.shape = Shape::asphere;
            to.even = {from.a4, from.a6, from.a8, from.a10, from.a12, from.a14, from.a16};
        }
        result.push_back(to);
    }
    return result;
}

peer::Chain make_chain(const vkfv::Configuration& configuration, const vkfv::optics::Instrument& instrument,
                       const vkfv::specimen::Specimen& specimen, double focal_height, bool gate) {
    if ((instrument.features & ~vkfv::physics::f64::FEATURE_AIMED_RECTANGLE) != 0 ||
        configuration.trace.nonsequential) {
        refuse(configuration, "", "an instrument with a ring light, a spectrum, ideal lenses, losses or tilted parts",
               "the plain chain: disc, surfaces of revolution about one axis, one wavelength",
               "Compare with vkfv --device host.");
    }
    const auto& lobes = specimen.material.lobes;
    if (lobes.size() != 1 || lobes[0].model != "henyey-greenstein" || lobes[0].weight != 1 ||
        lobes[0].parameters[0] < 0 || lobes[0].parameters[0] >= 1) {
        refuse(configuration, "specimen.material", "another material", "one Henyey-Greenstein lobe with 0 <= g < 1",
               "Compare with vkfv --device host.");
    }
    const auto record = vkfv::specimen::record(specimen, configuration.trace.max_bounces);
    const auto& constants = instrument.constants;
    peer::Chain chain;
    chain.source_radius = constants.source_radius;
    chain.source_distance = constants.source_distance;
    chain.emission_sine = constants.emission_sine;
    if ((instrument.features & vkfv::physics::f64::FEATURE_AIMED_RECTANGLE) != 0) {
        chain.emission_half_width = constants.emission_half_width;
        chain.emission_half_height = constants.emission_half_height;
    }
    chain.emission_shift = constants.emission_shift;
    chain.illumination = train(instrument, constants.illumination_first, constants.illumination_count);
    chain.imaging = train(instrument, constants.imaging_first, constants.imaging_count);
    chain.top = record.top;
    chain.top_distance = focal_height + instrument.front_vertex_height - record.top;
    chain.g = lobes[0].parameters[0];
    chain.max_bounces = configuration.trace.max_bounces;
    chain.gate_position = constants.gate_position;
    chain.gate_slope = constants.gate_slope;
    chain.gate_radius = gate ? constants.gate_radius : peer::unlimited;
    chain.detector_distance = constants.detector_distance;
    chain.detector_half_width = constants.detector_half_width;
    chain.detector_half_height = constants.detector_half_height;
    chain.detector_columns = constants.detector_columns;
    chain.detector_rows = constants.detector_rows;
    chain.inverted = constants.magnification < 0;
    return chain;
}

peer::Triangles make_triangles(const vkfv::Configuration& configuration, const vkfv::specimen::Specimen& specimen) {
    peer::Triangles triangles;
    if (const auto* mesh = std::get_if<vkfv::specimen::Mesh>(&specimen.geometry)) {
        for (const auto& vertex : mesh->vertices) {
            triangles.points.insert(triangles.points.end(), {vertex.x, vertex.y, vertex.z});
        }
        for (const auto& corners : mesh->triangles) {
            triangles.corners.insert(triangles.corners.end(), {corners.x, corners.y, corners.z});
        }
    } else if (const auto* field = std::get_if<vkfv::specimen::HeightField>(&specimen.geometry)) {
        const auto columns = static_cast<std::uint32_t>(field->heights.columns);
        const auto rows = static_cast<std::uint32_t>(field->heights.rows);
        for (std::uint32_t j = 0; j < rows; ++j) {
            for (std::uint32_t i = 0; i < columns; ++i) {
                triangles.points.insert(triangles.points.end(), {static_cast<float>(field->x_min + i * field->pitch_x),
                                                                 static_cast<float>(field->y_min + j * field->pitch_y),
                                                                 field->heights.values[std::size_t{j} * columns + i]});
                if (i + 1 < columns && j + 1 < rows) { // split from (i, j) to (i + 1, j + 1)
                    const std::uint32_t corner = j * columns + i;
                    triangles.corners.insert(triangles.corners.end(), {corner, corner + 1, corner + columns + 1, corner,
                                                                       corner + columns + 1, corner + columns});
                }
            }
        }
    } else {
        refuse(configuration, "specimen.representation", "analytic", "triangles",
               "Use --set specimen.representation=facets.");
    }
    return triangles;
}

struct Arguments {
    std::string file, out;
    std::vector<std::string> settings;
    double z_um = 0;
    std::uint64_t rays = 0, seed = 1;
    int runs = 1;
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    int packet = 16, block = 256;
    bool gate = true, json = false;
};

void declare(CLI::App& app, Arguments& given) {
    app.add_option("configuration", given.file)->required()->option_text("C.toml");
    app.add_option("--set", given.settings, "Any key of the configuration")
        ->option_text("KEY=VALUE")
        ->expected(1)
        ->take_all();
    app.add_option("--z", given.z_um, "Height of the focal plane over best focus, um");
    app.add_option("--rays", given.rays, "Rays to launch; the configuration's unless given")
        ->transform([](const std::string& text) { return fmt::format("{:.0f}", std::stod(text)); });
    app.add_option("--seed", given.seed);
    app.add_option("--runs", given.runs, "Times to trace, each with a seed of its own")->check(CLI::Range(1, 1000));
    app.add_option("--threads", given.threads)->check(CLI::Range(1, 1024));
    app.add_option("--packet", given.packet, "Rays that Embree takes at once")->check(CLI::IsMember({1, 8, 16}));
    app.add_option("--block", given.block,
                   "Rays that go through the lenses together, surface by surface; 1: ray by ray")
        ->check(CLI::Range(1, 256));
    app.add_option("--gate", given.gate,
                   "on: light that must miss the pupil is dropped before it is tested for occlusion")
        ->transform(CLI::CheckedTransformer(std::map<std::string, bool>{{"on", true}, {"off", false}}));
    app.add_option("--out", given.out, "Image of the last run: W per pixel as float32 TIFF");
    app.add_flag("--json", given.json);
}

void run(const Arguments& given) {
    std::vector<vkfv::TomlOverride> overrides;
    for (const auto& setting : given.settings) {
        const auto equals = setting.find('=');
        overrides.push_back(
            {setting.substr(0, equals), equals == std::string::npos ? "" : setting.substr(equals + 1), "--set"});
    }
    const auto configuration = vkfv::load_configuration(given.file, overrides, vkfv::Needs::exposure);
    const double focal_height = given.z_um / vkfv::um_per_mm;
    const auto specimen = vkfv::measurement::make_specimen(configuration);
    const auto instrument = vkfv::trace::as_traced(
        vkfv::measurement::assemble_instrument(configuration, specimen, std::span(&focal_height, 1)),
        configuration.trace);
    const auto chain = make_chain(configuration, instrument, specimen, focal_height, given.gate);

    using Clock = std::chrono::steady_clock;
    const auto seconds_since = [](Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    };
    const auto triangles = make_triangles(configuration, specimen);
    const auto before_build = Clock::now();
    const peer::Specimen embree(triangles);
    const double build_seconds = seconds_since(before_build);

    peer::Settings settings{.rays = given.rays > 0 ? given.rays : configuration.trace.rays,
                            .seed = given.seed,
                            .threads = given.threads,
                            .packet = given.packet,
                            .block = given.block};
    std::vector<double> seconds, processor_seconds; // of all threads together
    peer::Counts counts;
    for (int k = 0; k < given.runs; ++k) {
        const auto start = Clock::now();
        const auto processor_start = std::clock();
        counts = peer::trace(chain, embree, settings);
        seconds.push_back(seconds_since(start));
        processor_seconds.push_back(static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC);
        settings.seed += 1;
    }
    const double per_ray = instrument.flux * instrument.aimed_share() * instrument.splitter_reflectance *
                           instrument.splitter_transmittance / static_cast<double>(settings.rays);
    if (!given.out.empty()) {
        vkfv::Grid<float> flux(chain.detector_columns, chain.detector_rows);
        std::ranges::transform(counts.pixels, flux.values.begin(),
                               [&](std::uint32_t count) { return static_cast<float>(per_ray * count); });
        const double pitch = instrument.first_order.pixel_pitch;
        vkfv::write_file(given.out, vkfv::images::tiff_bytes(flux, {.pitch_x = pitch,
                                                                    .pitch_y = pitch,
                                                                    .description = "radiant flux in W, by the peer"}));
    }
    std::ranges::sort(seconds);
    std::ranges::sort(processor_seconds);
    const double rate = static_cast<double>(settings.rays) / seconds[seconds.size() / 2];
    const double processor_median = processor_seconds[processor_seconds.size() / 2];
    if (given.json) {
        fmt::print("{}\n", nlohmann::ordered_json{{"rays", settings.rays},
                                                  {"seconds", seconds},
                                                  {"processor_seconds", processor_seconds},
                                                  {"rays_per_second", rate},
                                                  {"threads", settings.threads},
                                                  {"packet", settings.packet},
                                                  {"block", settings.block},
                                                  {"build_seconds", build_seconds},
                                                  {"triangles", triangles.corners.size() / 3},
                                                  {"arrived", counts.arrived},
                                                  {"met", counts.met},
                                                  {"gated", counts.gated},
                                                  {"detected", counts.detected},
                                                  {"watts_per_ray", per_ray}}
                               .dump());
        return;
    }
    const auto share = [&](std::uint64_t count) {
        return 100 * static_cast<double>(count) / static_cast<double>(counts.launched);
    };
    fmt::print("Embree and lenses in double, {} threads, packets of {}, blocks of {}\n"
               "  rays/s    {:.4g}  (median of {} runs of {:.3g} rays, {:.3g} to {:.3g} s; {:.3g} s of all "
               "threads)\n"
               "  arrived at the specimen {:.3f} %, met it {:.3f} %, within the gate {:.3f} %, detected {:.4f} %\n"
               "  specimen of {} triangles built in {:.2f} s\n",
               settings.threads, settings.packet, settings.block, rate, seconds.size(),
               static_cast<double>(settings.rays), seconds.front(), seconds.back(), processor_median,
               share(counts.arrived), share(counts.met), share(counts.gated), share(counts.detected),
               triangles.corners.size() / 3, build_seconds);
}

} // namespace

int main(int argument_count, char** argument_values) {
    Arguments given;
    CLI::App app("The chain of a configuration on the CPU: Embree for the specimen, lenses in double",
                 "vkfv_bench_peer");
    declare(app, given);
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        spdlog::set_default_logger(spdlog::stderr_color_mt("vkfv_bench_peer"));
        run(given);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "vkfv_bench_peer: {}\n", error.what());
        return 2;
    }
}
