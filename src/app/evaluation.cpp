#include "app/evaluation.hpp"

#include "app/commands.hpp"
#include "app/text_file.hpp"
#include "core/units.hpp"
#include "surface/image_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

std::string text_of(const char* treatment, const topography::Deviation& deviation) {
    return fmt::format(
        "{:<30} Sq measured {:.4f} um, true {:.4f} um (ratio {:.3f}), RMS deviation {:.4f} um, "
        "correlation {:.4f}\n",
        treatment, deviation.sq_measured * um_per_mm, deviation.sq_true * um_per_mm,
        deviation.sq_measured / deviation.sq_true, deviation.rms * um_per_mm, deviation.correlation);
}

} // namespace

Evaluation evaluate(const Configuration& configuration, const optics::Instrument& instrument,
                    const specimen::Specimen& specimen, const std::function<Grid<float>(int)>& image) {
    const auto started = std::chrono::steady_clock::now();
    Evaluation evaluation;
    evaluation.options = configuration.topography;
    evaluation.truth = truth_on_pixels(instrument, configuration, specimen);
    topography::StackEvaluator evaluator(configuration.topography);
    const auto positions = configuration.scan->positions();
    for (std::size_t k = 0; k < positions.size(); ++k) {
        evaluator.add(image(static_cast<int>(k)), positions[k]);
    }
    evaluation.topography =
        evaluator.finish(evaluation.truth.x0, evaluation.truth.y0, evaluation.truth.pitch_x);
    const auto& measured = evaluation.topography.height;
    evaluation.deviation = topography::compare(measured, evaluation.truth, 0);
    evaluation.l_filter = configuration.l_filter;
    if (configuration.l_filter > 0) {
        evaluation.filtered_deviation =
            topography::compare(measured, evaluation.truth, configuration.l_filter);
    }
    evaluation.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return evaluation;
}

void write_evaluation(const std::filesystem::path& folder, const Evaluation& evaluation,
                      const nlohmann::ordered_json& more) {
    surface::write_height_map(folder / "topography.tif", evaluation.topography.height);
    surface::write_height_map(folder / "truth.tif", evaluation.truth);
    surface::write_height_map(
        folder / "deviation.tif",
        topography::deviation_map(evaluation.topography.height, evaluation.truth, evaluation.l_filter));

    const auto path = folder / "results.json";
    auto results = nlohmann::ordered_json::object();
    if (std::ifstream earlier(path); earlier) {
        auto parsed = nlohmann::ordered_json::parse(earlier, nullptr, false);
        if (parsed.is_object()) {
            results = std::move(parsed);
        }
    }
    results.update(json_of(evaluation.deviation));
    results.erase("l_filtered");
    if (evaluation.filtered_deviation) {
        auto filtered = json_of(*evaluation.filtered_deviation);
        filtered["nesting_index_um"] = evaluation.l_filter * um_per_mm;
        results["l_filtered"] = std::move(filtered);
    }
    results["topography"] = {{"focus_measure", evaluation.options.focus_measure},
                             {"window_px", evaluation.options.window_px},
                             {"smoothing_steps", evaluation.options.smoothing_steps},
                             {"peak", evaluation.options.peak},
                             {"false_peak_rate", evaluation.options.false_peak_rate}};
    results["evaluation_seconds"] = evaluation.seconds;
    results["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    results.update(more);
    write_text_aside(path, results.dump(2) + "\n");
}

std::string summary(const Evaluation& evaluation) {
    if (!(evaluation.deviation.measured_share > 0)) {
        return "no point was measured: the focus of no pixel rises above its noise. Trace more rays, scan "
               "further or in "
               "finer steps, or give the specimen texture.\n";
    }
    std::string text =
        fmt::format("measured {:.1f} % of the points\n", 100 * evaluation.deviation.measured_share);
    text += text_of("levelled:", evaluation.deviation);
    if (evaluation.filtered_deviation) {
        text += text_of(fmt::format("and L-filtered at {:g} um:", evaluation.l_filter * um_per_mm).c_str(),
                        *evaluation.filtered_deviation);
    }
    return text;
}

} // namespace vkfv::app
