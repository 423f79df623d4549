#include "app/evaluation.hpp"

#include "app/commands.hpp"
#include "app/digest.hpp"
#include "app/text_file.hpp"
#include "app/device_focus_planes.hpp"
#include "core/units.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/image_file.hpp"
#include "surface/surface_file.hpp"
#include "trace/focus_kernels.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

namespace vkfv::app {

namespace {

nlohmann::ordered_json json_of(const topography::Deviation& deviation) {
    // NaN (nothing measured) becomes null in JSON.
    return {{"sq_measured_um", deviation.sq_measured * um_per_mm},
            {"sq_true_um", deviation.sq_true * um_per_mm},
            {"sq_ratio", deviation.sq_measured / deviation.sq_true},
            {"rms_deviation_um", deviation.rms * um_per_mm},
            {"correlation", deviation.correlation},
            {"measured_share", deviation.measured_share}};
}

// Of a map without a truth, levelled.
nlohmann::ordered_json json_of(const surface::HeightMap& map) {
    const auto parameters =
        surface::height_parameters(surface::remove_plane(map, surface::least_squares_plane(map)));
    return {{"sq_measured_um", parameters.sq * um_per_mm}, {"measured_share", parameters.measured_share}};
}

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
    ~Stopwatch() {
        seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
    }

  private:
    double& seconds_;
    std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

std::string text_of(const char* treatment, const topography::Deviation& deviation) {
    return fmt::format(
        "{:<30} Sq measured {:.4f} um, true {:.4f} um (ratio {:.3f}), RMS deviation {:.4f} um, "
        "correlation {:.4f}\n",
        treatment, deviation.sq_measured * um_per_mm, deviation.sq_true * um_per_mm,
        deviation.sq_measured / deviation.sq_true, deviation.rms * um_per_mm, deviation.correlation);
}

} // namespace

topography::FocusPlanesMaker focus_planes_for(const std::string& evaluate_on, const std::string& device_selector) {
    const bool traced_on_host = device_selector == "host";
    if (evaluate_on == "host" || (evaluate_on == "auto" && (traced_on_host || !trace::is_hardware(device_selector)))) {
        return topography::make_host_focus_planes;
    }
    return device_focus_planes(traced_on_host ? std::string() : device_selector);
}

StackEvaluation::StackEvaluation(const topography::TopographyOptions& options,
                                 topography::FocusPlanesMaker make_planes)
    : evaluator_(options, std::move(make_planes)) {
    evaluation_.options = options;
}

void StackEvaluation::add(topography::Channels image, double z) {
    const Stopwatch stopwatch(evaluation_.seconds);
    if (!image.empty()) {
        columns_ = image.front().columns;
        rows_ = image.front().rows;
    }
    evaluator_.add(std::move(image), z);
}

Evaluation StackEvaluation::finish(surface::HeightMap truth, double l_filter) {
    {
        const Stopwatch stopwatch(evaluation_.seconds);
        evaluation_.topography = evaluator_.finish(truth.x0, truth.y0, truth.pitch_x);
        const auto& measured = evaluation_.topography.height;
        evaluation_.deviation = topography::compare(measured, truth, 0);
        evaluation_.l_filter = l_filter;
        if (l_filter > 0) {
            evaluation_.filtered_deviation = topography::compare(measured, truth, l_filter);
        }
        evaluation_.truth = std::move(truth);
    }
    return std::move(evaluation_);
}

Evaluation StackEvaluation::finish(double pitch) {
    {
        const Stopwatch stopwatch(evaluation_.seconds);
        evaluation_.topography =
            evaluator_.finish(-0.5 * (columns_ - 1) * pitch, -0.5 * (rows_ - 1) * pitch, pitch);
    }
    return std::move(evaluation_);
}

TopographyFiles topography_files(const Configuration& configuration) {
    TopographyFiles files{.names = configuration.topography_files};
    files.provenance.comment =
        fmt::format("configuration digest {}", Digest().add(configuration.identity).text());
    return files;
}

void write_evaluation(const std::filesystem::path& folder, const Evaluation& evaluation,
                      const nlohmann::ordered_json& more, const TopographyFiles& files) {
    const auto& topography = evaluation.topography;
    for (const std::string& file : files.names) {
        surface::write_surface(folder / file, topography.height, files.provenance);
    }
    const surface::ImageTags pitch{
        .pitch_x = topography.height.pitch_x, .pitch_y = topography.height.pitch_y, .description = {}};
    surface::write_tiff(folder / "quality.tif", converted<float>(topography.contrast), pitch);
    surface::write_tiff(folder / "fit_residual.tif", converted<float>(topography.fit_residual), pitch);
    surface::write_tiff(folder / "mask.tif", converted<std::uint16_t>(topography.state), pitch);
    surface::write_tiff(folder / "all_in_focus.tif", topography.all_in_focus, pitch);
    if (evaluation.truth) {
        surface::write_height_map(folder / "truth.tif", *evaluation.truth);
        surface::write_height_map(
            folder / "deviation.tif",
            topography::deviation_map(topography.height, *evaluation.truth, evaluation.l_filter));
    }

    const auto path = folder / "results.json";
    auto results = nlohmann::ordered_json::object();
    if (std::ifstream earlier(path); earlier) {
        auto parsed = nlohmann::ordered_json::parse(earlier, nullptr, false);
        if (parsed.is_object()) {
            results = std::move(parsed);
        }
    }
    results.update(evaluation.deviation ? json_of(*evaluation.deviation) : json_of(topography.height));
    results.erase("l_filtered");
    if (evaluation.filtered_deviation) {
        auto filtered = json_of(*evaluation.filtered_deviation);
        filtered["nesting_index_um"] = evaluation.l_filter * um_per_mm;
        results["l_filtered"] = std::move(filtered);
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
    results["points"] = point_counts(topography.state);
    results["evaluation_seconds"] = evaluation.seconds;
    results["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    results.update(more);
    write_text_aside(path, results.dump(2) + "\n");
}

std::string summary(const Evaluation& evaluation) {
    const double measured = surface::height_parameters(evaluation.topography.height).measured_share;
    if (!(measured > 0)) {
        return "no point was measured: the focus of no pixel rises above its noise. Trace more rays, scan "
               "further or in "
               "finer steps, or give the specimen texture.\n";
    }
    std::string text = fmt::format("measured {:.1f} % of the points\n", 100 * measured);
    if (evaluation.deviation) {
        text += text_of("levelled:", *evaluation.deviation);
    }
    if (evaluation.filtered_deviation) {
        text += text_of(fmt::format("and L-filtered at {:g} um:", evaluation.l_filter * um_per_mm).c_str(),
                        *evaluation.filtered_deviation);
    }
    return text;
}

} // namespace vkfv::app
