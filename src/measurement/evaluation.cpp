#include "measurement/evaluation.hpp"

#include "core/digest.hpp"
#include "core/file.hpp"
#include "core/json_depth.hpp"
#include "core/pixel_grid.hpp"
#include "core/units.hpp"
#include "images/image_file.hpp"
#include "measurement/evaluation_figures.hpp"
#include "measurement/stack_page.hpp"
#include "report/layout.hpp"
#include "report/topography_picture.hpp"
#include "scan/store.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface_files/height_image.hpp"
#include "surface_files/surface_file.hpp"
#include "topography/device_focus_planes.hpp"
#include "topography/flatness.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace vkfv::measurement {

namespace {

// How many points are in each state.
nlohmann::ordered_json point_counts(const Grid<topography::PointState>& state) {
    using topography::PointState;
    const auto count = [&](PointState wanted) { return std::ranges::count(state.values, wanted); };
    return {{"measured", count(PointState::measured)},         {"no_peak", count(PointState::no_peak)},
            {"low_contrast", count(PointState::low_contrast)}, {"poor_fit", count(PointState::poor_fit)},
            {"many_peaks", count(PointState::many_peaks)},     {"repaired", count(PointState::repaired)}};
}

template <class To, class From>
Grid<To> converted(const Grid<From>& grid) {
    Grid<To> result(grid.columns, grid.rows);
    std::ranges::transform(grid.values, result.values.begin(), [](From value) { return static_cast<To>(value); });
    return result;
}

// Adds the time of its life.
class Stopwatch {
  public:
    explicit Stopwatch(double& seconds) : seconds_(seconds) {}
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;
    ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count(); }

  private:
    double& seconds_;
    std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

std::string text_of(const char* treatment, const topography::Deviation& deviation) {
    return fmt::format("{:<30} Sq measured {:.4f} um, true {:.4f} um (ratio {:.3f}), RMS deviation {:.4f} um, "
                       "correlation {:.4f}\n",
                       treatment, deviation.sq_measured * um_per_mm, deviation.sq_true * um_per_mm,
                       deviation.sq_measured / deviation.sq_true, deviation.rms * um_per_mm, deviation.correlation);
}

// Levelled, with the filtered ones within.
nlohmann::ordered_json json_of(const std::vector<Figures>& figures) {
    auto json = json_of(figures.front());
    if (figures.size() > 1) {
        json["filtered"] = json_of(figures[1]);
    }
    return json;
}

// Mean of the channels.
Grid<float> grey(const topography::Channels& channels) {
    Grid<float> result(channels.front().columns, channels.front().rows);
    for (const auto& channel : channels) {
        for (std::size_t k = 0; k < result.values.size(); ++k) {
            result.values[k] += channel.values[k] / static_cast<float>(channels.size());
        }
    }
    return result;
}

// A folder's own name, also of "out/" and ".".
std::string name_of(const std::filesystem::path& folder) {
    const auto whole = std::filesystem::absolute(folder).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::string picture_of(const std::filesystem::path& folder, const Evaluation& evaluation) {
    const auto level = [](const surface::HeightMap& map) {
        return surface::remove_plane(map, surface::least_squares_plane(map));
    };
    report::TopographyPicture picture;
    picture.title = name_of(folder);
    picture.measured = level(evaluation.topography.height);
    if (evaluation.truth) {
        picture.truth = level(*evaluation.truth);
        picture.deviation = topography::deviation_map(evaluation.topography.height, *evaluation.truth);
    }
    picture.all_in_focus = grey(evaluation.topography.all_in_focus);
    return report::topography_picture(picture);
}

// Into this folder in the results' own. Returns the picture.
std::string write_maps(ResultFolder& results, const std::filesystem::path& folder, const Evaluation& evaluation,
                       const TopographyFiles& files) {
    const auto& topography = evaluation.topography;
    for (const std::string& file : files.names) {
        results.write(folder / file, surface::surface_bytes(file, topography.height, files.provenance));
    }
    const images::ImageTags pitch{
        .pitch_x = topography.height.pitch_x, .pitch_y = topography.height.pitch_y, .description = {}};
    const auto write = [&](const char* name, const auto& map) {
        results.write(folder / name, images::tiff_bytes(map, pitch));
    };
    write("quality.tif", converted<float>(topography.contrast));
    write("fit_residual.tif", converted<float>(topography.fit_residual));
    write("mask.tif", converted<std::uint16_t>(topography.state));
    write("all_in_focus.tif", topography.all_in_focus);
    if (evaluation.truth) {
        results.write(folder / "truth.tif", surface::height_map_bytes(*evaluation.truth));
        results.write(folder / "deviation.tif", surface::height_map_bytes(topography::deviation_map(
                                                    topography.height, *evaluation.truth, evaluation.band)));
    }
    const std::string picture = picture_of(results.path() / folder, evaluation);
    results.write(folder / "topography.svg", picture);
    return picture;
}

std::string band_text(const topography::Band& band) {
    std::string text = "and filtered";
    if (band.s_filter > 0) {
        text += fmt::format(", S {:g} um", band.s_filter * um_per_mm);
    }
    if (band.l_filter > 0) {
        text += fmt::format(", L {:g} um", band.l_filter * um_per_mm);
    }
    return text + ":";
}

} // namespace

topography::FocusPlanesMaker focus_planes_for(const std::string& evaluate_on, const std::string& device_selector) {
    const bool traced_on_host = device_selector == "host";
    if (evaluate_on == "host" || (evaluate_on == "auto" && (traced_on_host || !vulkan::is_hardware(device_selector)))) {
        return topography::make_host_focus_planes;
    }
    return topography::device_focus_planes(traced_on_host ? std::string() : device_selector);
}

std::optional<Flat> read_flat(const Configuration& configuration, int columns, int rows, double pitch) {
    const auto& file = configuration.flatness_file;
    if (file.empty()) {
        return std::nullopt;
    }
    constexpr double tolerance = 1e-3; // of a pitch: files round theirs
    auto flat = surface::read_surface(file).map;
    if (flat.columns() != columns || flat.rows() != rows || std::abs(flat.pitch_x - pitch) > tolerance * pitch ||
        std::abs(flat.pitch_y - pitch) > tolerance * pitch) {
        throw InputError(
            {configuration.places.at("topography.flatness_file"), "topography.flatness_file",
             fmt::format("{}: {} x {} points, {:.6g} x {:.6g} um apart", file.string(), flat.columns(), flat.rows(),
                         flat.pitch_x * um_per_mm, flat.pitch_y * um_per_mm),
             fmt::format("the stack's grid, {} x {} points, {:.6g} um apart", columns, rows, pitch * um_per_mm),
             "Measure the flat with the same instrument."});
    }
    // A polynomial knows nothing of places where nothing was measured.
    constexpr double least_share = 0.9;
    const double measured = surface::height_parameters(flat).measured_share;
    if (!(measured >= least_share)) {
        throw InputError(
            {configuration.places.at("topography.flatness_file"), "topography.flatness_file",
             fmt::format("{}: {:.0f} % of the points measured", file.string(), 100 * measured),
             fmt::format("at least {:.0f} %", 100 * least_share),
             "Give the flat texture and light enough to be measured, and scan as far as the field curves."});
    }
    return Flat{.file = file, .heights = std::move(flat)};
}

StackEvaluation::StackEvaluation(const topography::TopographyOptions& options, topography::FocusPlanesMaker make_planes,
                                 std::optional<optics::Diffraction> diffraction)
    : evaluator_(options, make_planes), diffraction_(std::move(diffraction)) {
    evaluation_.options = options;
    if (diffraction_) {
        diffracted_ = std::make_unique<StackEvaluation>(options, std::move(make_planes));
    }
}

void StackEvaluation::add(topography::Channels image, double z) {
    const Stopwatch stopwatch(evaluation_.seconds);
    if (!image.empty()) {
        columns_ = image.front().columns;
        rows_ = image.front().rows;
    }
    if (diffraction_) {
        diffracted_->add({diffraction_->apply(image.front())}, z);
    }
    evaluator_.add(std::move(image), z);
}

void StackEvaluation::reconstruct(double x0, double y0, double pitch, const std::optional<Flat>& flat) {
    evaluation_.topography = evaluator_.finish(x0, y0, pitch);
    if (flat) {
        auto corrected = topography::correct_flatness(std::move(evaluation_.topography.height), flat->heights);
        evaluation_.topography.height = std::move(corrected.heights);
        evaluation_.flatness = {.file = flat->file, .deviation = corrected.peak_to_valley};
    }
}

Evaluation StackEvaluation::finish(surface::HeightMap truth, const topography::Band& band,
                                   const std::optional<Flat>& flat) {
    if (diffracted_) {
        evaluation_.diffracted = std::make_shared<Evaluation>(diffracted_->finish(truth, band, flat));
    }
    {
        const Stopwatch stopwatch(evaluation_.seconds);
        reconstruct(truth.x0, truth.y0, truth.pitch_x, flat);
        const auto& measured = evaluation_.topography.height;
        evaluation_.deviation = topography::compare(measured, truth);
        evaluation_.band = band;
        if (band.limited()) {
            evaluation_.filtered_deviation = topography::compare(measured, truth, band);
        }
        evaluation_.truth = std::move(truth);
    }
    return std::move(evaluation_);
}

Evaluation StackEvaluation::finish(double pitch, const std::optional<Flat>& flat) {
    {
        const Stopwatch stopwatch(evaluation_.seconds);
        const auto grid = PixelGrid::centred(columns_, rows_, pitch);
        reconstruct(grid.x0, grid.y0, pitch, flat);
    }
    return std::move(evaluation_);
}

TopographyFiles topography_files(const Configuration& configuration) {
    TopographyFiles files{.names = configuration.topography_files};
    files.provenance.comment = fmt::format("configuration digest {}", Digest().add(configuration.identity).text());
    return files;
}

StackSource stack_source(const Configuration& configuration, const optics::Instrument& instrument) {
    return {.layout = report::layout_svg(instrument, name_of(configuration.output_directory)),
            .configuration = configuration.canonical};
}

void write_evaluation(ResultFolder& folder, const Evaluation& evaluation, const nlohmann::ordered_json& more,
                      const StackSource& source, const TopographyFiles& files) {
    StackPage page{.title = name_of(folder.path()),
                   .plain = {.figures = figures_of(evaluation), .svg = write_maps(folder, "", evaluation, files)},
                   .diffracted = {},
                   .results = {},
                   .layout = source.layout,
                   .configuration = source.configuration};
    auto results = json_of(page.plain.figures);
    if (evaluation.diffracted) {
        page.diffracted = {.figures = figures_of(*evaluation.diffracted),
                           .svg = write_maps(folder, "diffracted", *evaluation.diffracted, files)};
        results["diffracted"] = json_of(page.diffracted->figures);
    }
    const auto& options = evaluation.options;
    results["topography"] = {{"focus_measure", options.focus_measure},
                             {"window_px", options.window_px},
                             {"window_shape", options.window_shape},
                             {"smoothing_steps", options.smoothing_steps},
                             {"peak", options.peak},
                             {"peak_range_steps", options.peak_range_steps},
                             {"false_peak_rate", options.false_peak_rate},
                             {"least_contrast", options.least_contrast},
                             {"most_fit_residual", options.most_fit_residual},
                             {"most_peaks", options.most_peaks},
                             {"repair_outliers", options.repair_outliers}};
    if (evaluation.flatness) {
        results["flatness"] = {{"file", evaluation.flatness->file.string()},
                               {"deviation_um", evaluation.flatness->deviation * um_per_mm}};
    }
    results["points"] = point_counts(evaluation.topography.state);
    results["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    results.update(more);
    folder.write("results.json", results.dump(2) + "\n");
    page.results = std::move(results);
    folder.write("report.html", stack_page(page));
    scan::append_timing(folder.path(), "evaluation", evaluation.seconds);
    folder.write_checksums();
}

nlohmann::ordered_json run_of(const std::filesystem::path& folder) {
    auto run = nlohmann::ordered_json::object();
    std::error_code none;
    if (!std::filesystem::exists(folder / "results.json", none)) {
        return run;
    }
    const std::string text = read_file(folder / "results.json");
    check_json_depth(text, folder / "results.json");
    const auto results = nlohmann::ordered_json::parse(text, nullptr, false);
    for (const char* key : {"device", "stack_digest", "seed", "images", "rays_per_image"}) {
        if (results.is_object() && results.contains(key)) {
            run[key] = results.at(key);
        }
    }
    return run;
}

std::string summary(const Evaluation& evaluation) {
    const double measured = surface::height_parameters(evaluation.topography.height).measured_share;
    if (!(measured > 0)) {
        return "no point was measured: the focus of no pixel rises above its noise. Trace more rays, scan "
               "further or in "
               "finer steps, or give the specimen texture.\n";
    }
    std::string text = fmt::format("measured {:.1f} % of the points\n", 100 * measured);
    if (evaluation.flatness) {
        text += fmt::format("field curvature removed by the flat: {:.3g} um peak to valley\n",
                            evaluation.flatness->deviation * um_per_mm);
    }
    if (evaluation.deviation) {
        text += text_of("levelled:", *evaluation.deviation);
    }
    if (evaluation.filtered_deviation) {
        text += text_of(band_text(evaluation.band).c_str(), *evaluation.filtered_deviation);
    }
    if (evaluation.diffracted) {
        text += "with diffraction: " + summary(*evaluation.diffracted);
    }
    return text;
}

} // namespace vkfv::measurement
