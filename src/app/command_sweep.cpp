#include "app/commands.hpp"
#include "core/digest.hpp"
#include "measurement/assembly.hpp"
#include "measurement/exposure.hpp"
#include "measurement/sweep_report.hpp"
#include "specimen/geometry_digest.hpp"

#include "core/file.hpp"
#include "core/result_folder.hpp"
#include "core/units.hpp"
#include "images/image_file.hpp"
#include "scan/store.hpp"
#include "surface_files/surface_file.hpp"
#include "trace/ledger.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace vkfv::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A signal-to-noise ratio and a height noise that a user may want; the rays for them follow from those of the run.
constexpr double wanted_ratio = 100;
constexpr double wanted_height_noise = 0.1; // um

std::vector<std::vector<std::string>> combinations(const Sweep& sweep) {
    std::vector<std::vector<std::string>> result = {{}};
    for (const auto& parameter : sweep.parameters) {
        std::vector<std::vector<std::string>> longer;
        for (const auto& begun : result) {
            for (const auto& value : parameter.values) {
                longer.push_back(begun);
                longer.back().push_back(value);
            }
        }
        result = std::move(longer);
    }
    return result;
}

Json read_json(const fs::path& path) {
    auto parsed = Json::parse(read_file(path), nullptr, false);
    return parsed.is_object() ? parsed : Json();
}

Json figures_of(const trace::Image& image, bool ledger_tells) {
    double flux = 0, square = 0;
    for (const double value : image.flux.values) {
        flux += value;
        square += value * value;
    }
    const auto pixels = static_cast<double>(image.flux.values.size());
    const double mean = flux / pixels, ratio = measurement::signal_to_noise(image);
    Json figures;
    figures["signal to noise"] = ratio;
    // What is left of the spread of the pixels without the noise.
    figures["contrast"] = std::sqrt(std::max(0.0, square / pixels / (mean * mean) - 1 - 1 / (ratio * ratio)));
    const auto share = ledger_tells ? trace::share_collected(image.ledger) : std::nullopt;
    figures["share collected"] = share ? Json(*share) : Json();
    figures["detected / emitted"] = flux / image.ledger.emitted;
    figures["detected rays a pixel"] = static_cast<double>(image.detected) / pixels;
    figures[fmt::format("rays for a ratio of {:g}", wanted_ratio)] =
        static_cast<double>(image.rays) * std::pow(wanted_ratio / ratio, 2);
    return figures;
}

// Most sweeps vary something else than the surface, which may take longer to make than an image to trace.
class Surfaces {
  public:
    struct Surface {
        specimen::Specimen specimen; // with the material asked for
        std::string digest;          // of the geometry
    };
    const Surface& of(const Configuration& configuration) {
        specimen::Description geometry = configuration.specimen.value();
        geometry.material = {};
        geometry.where = {};
        if (!made_of_ || *made_of_ != geometry) {
            surface_.specimen = measurement::make_specimen(configuration);
            surface_.digest = specimen::geometry_digest(surface_.specimen);
            made_of_ = std::move(geometry);
        }
        surface_.specimen.material = configuration.specimen->material;
        return surface_;
    }

  private:
    std::optional<specimen::Description> made_of_;
    Surface surface_;
};

// What an image of the sweep is known again by: all that decides its bits, and what is written beside it.
std::string image_digest(const Configuration& configuration, const std::string& identity, double focal_height) {
    const auto& blur = configuration.diffraction;
    return Digest()
        .add(fmt::format("{}z = {}\nblur = {} {}\n", identity, focal_height, blur.airy, blur.pitch))
        .add(blur.file.empty() ? std::string() : read_file(blur.file, {.key = "diffraction.file"}))
        .text();
}

// The image and its figures, from an earlier run if they are there and whole.
measurement::SweepRow image_row(const Configuration& configuration, ResultFolder& results, const fs::path& name,
                                Surfaces& surfaces) {
    const double focal_height = configuration.sweep->focal_height;
    const fs::path image_name = name / "image.tif", figures_name = name / "image.json";
    const auto& surface = surfaces.of(configuration);
    const auto instrument = measurement::instrument_for(configuration, surface.specimen, focal_height);
    const auto tracer = trace::expected_identity(instrument, surface.specimen, configuration.trace);
    const std::string digest =
        image_digest(configuration, measurement::image_identity(configuration, surface.digest, tracer), focal_height);
    measurement::SweepRow row;
    const bool whole = results.holds(image_name) && results.holds(figures_name) &&
                       (!configuration.diffraction.any() || results.holds(name / "image_diffracted.tif"));
    const Json earlier = whole ? read_json(results.path() / figures_name) : Json::object();
    if (earlier.value("digest", "") == digest) {
        row.figures = earlier.at("figures");
    } else {
        const measurement::Exposure exposure =
            measurement::expose(configuration, instrument, surface.specimen, focal_height);
        const bool tells =
            configuration.trace.estimator == trace::Estimator::forward && !configuration.trace.directed_scatter;
        row.figures = figures_of(exposure.image, tells);
        for (const auto& [file, bytes] : measurement::image_files(image_name, exposure, focal_height)) {
            results.write(file, bytes);
        }
        results.write(figures_name,
                      Json{{"digest", digest}, {"device", exposure.tracer.text()}, {"figures", row.figures}}.dump(2) +
                          "\n");
        results.write_checksums();
        scan::append_timing(results.path(), fmt::format("\"{}\"", name.string()), exposure.image.seconds,
                            static_cast<double>(exposure.image.rays));
        spdlog::info("traced in {:.3g} s", exposure.image.seconds);
    }
    row.picture = images::read_image(results.path() / image_name);
    return row;
}

// Stacks of the same surface with different seeds of the trace: how far their heights agree with each other, and their
// mean figures.
measurement::SweepRow stack_row(const CommandOptions& options, const std::vector<TomlOverride>& overrides, int repeats,
                                const fs::path& folder) {
    std::vector<surface::HeightMap> maps;
    std::vector<Json> results;
    const auto configuration = load_configuration(options.file, overrides);
    // A mesh is for viewers alone.
    const auto readable = std::ranges::find_if(configuration.topography_files,
                                               [](const std::string& name) { return !name.ends_with(".ply"); });
    if (readable == configuration.topography_files.end()) {
        throw InputError({configuration.places.at("output.surfaces"), "output.surfaces",
                          "no heights that can be read back",
                          "one of \"tiff\", \"x3p\", \"sur\" and \"sdf\" for a sweep of stacks", "Add one of them."});
    }
    for (int repeat = 0; repeat < repeats; ++repeat) {
        CommandOptions one = options;
        one.overrides = overrides;
        const auto seed = configuration.trace.seed;
        one.overrides.push_back(
            {"trace.seed", fmt::format("{}", seed + static_cast<std::uint32_t>(repeat)), "sweep.repeats"});
        one.out = repeats == 1 ? folder : folder / fmt::format("repeat_{:03}", repeat);
        one.overrides.push_back({"output.directory", toml_quoted(one.out->string()), "sweep"});
        run_stack(one);
        maps.push_back(surface::read_surface(*one.out / *readable).map);
        results.push_back(read_json(*one.out / "results.json"));
    }
    measurement::SweepRow row;
    const auto mean_of = [&](const char* key) {
        double sum = 0;
        for (const Json& result : results) {
            if (!result.contains(key) || !result.at(key).is_number()) {
                return Json();
            }
            sum += result.at(key).get<double>();
        }
        return Json(sum / static_cast<double>(results.size()));
    };
    row.figures["rms deviation / um"] = mean_of("rms_deviation_um");
    row.figures["Sq measured / Sq true"] = mean_of("sq_ratio");
    row.figures["correlation"] = mean_of("correlation");
    row.figures["share measured"] = mean_of("measured_share");
    if (repeats > 1) {
        double variance = 0, points = 0;
        for (std::size_t k = 0; k < maps.front().height.values.size(); ++k) {
            double sum = 0, square = 0;
            for (const auto& map : maps) {
                sum += map.height.values[k];
                square += map.height.values[k] * map.height.values[k];
            }
            if (std::isfinite(sum)) {
                variance += std::max(0.0, square - sum * sum / repeats) / (repeats - 1);
                points += 1;
            }
        }
        const double noise = std::sqrt(variance / points) * um_per_mm;
        row.figures["height noise / um"] = noise;
        const double rays = results.front().at("rays_per_image").get<double>();
        row.figures[fmt::format("rays for {:g} um", wanted_height_noise)] =
            rays * std::pow(noise / wanted_height_noise, 2);
    }
    const auto& heights = maps.front().height;
    // The sheet stretches from 0 to twice the mean: heights from the lowest upwards.
    row.picture = Grid<float>(heights.columns, heights.rows);
    double lowest = 0;
    for (const double height : heights.values) {
        lowest = std::isfinite(height) ? std::min(lowest, height) : lowest;
    }
    std::ranges::transform(heights.values, row.picture.values.begin(), [&](double height) {
        return std::isfinite(height) ? static_cast<float>(height - lowest) : 0.0f;
    });
    return row;
}

} // namespace

void run_sweep(const CommandOptions& options) {
    const auto base = load_configuration(options.file, options.overrides, Needs::exposure);
    if (!base.sweep) {
        throw InputError({{.file = options.file},
                          "sweep",
                          "no such table",
                          "a table [sweep] with [[sweep.parameter]] key and values",
                          "Add what is to be varied."});
    }
    const Sweep& sweep = *base.sweep;
    const fs::path& folder = base.output_directory;
    const auto list = combinations(sweep);
    // Whatever is wrong with a combination is said before the first is traced.
    const auto overrides_of = [&](const std::vector<std::string>& values) {
        auto overrides = options.overrides;
        for (std::size_t k = 0; k < values.size(); ++k) {
            overrides.push_back({sweep.parameters[k].key, values[k], "sweep"});
        }
        return overrides;
    };
    for (const auto& values : list) {
        (void)load_configuration(options.file, overrides_of(values), sweep.stacks ? Needs::stack : Needs::exposure);
    }
    ResultFolder results(folder);
    Surfaces surfaces;
    std::vector<measurement::SweepRow> rows;
    for (const auto& values : list) {
        const std::string name = measurement::sweep_name(sweep, values);
        spdlog::info("{} of {}: {}", rows.size() + 1, list.size(), name);
        const auto overrides = overrides_of(values);
        rows.push_back(sweep.stacks ? stack_row(options, overrides, sweep.repeats, folder / name)
                                    : image_row(load_configuration(options.file, overrides, Needs::exposure), results,
                                                name, surfaces));
        rows.back().values = values;
    }
    const std::string title = options.file.stem().string();
    results.write("sweep.csv", measurement::sweep_csv(sweep, rows));
    results.write("sweep.md", measurement::sweep_markdown(sweep, rows));
    results.write("sweep.svg", measurement::sweep_contact_sheet(sweep, rows, title));
    results.write("charts.svg", measurement::sweep_charts(sweep, rows, title));
    results.write_checksums();
    fmt::print("{}results in {}\n", measurement::sweep_markdown(sweep, rows), folder.string());
}

} // namespace vkfv::app
