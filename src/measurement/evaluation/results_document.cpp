#include "measurement/evaluation/results_document.hpp"

#include "core/files/file.hpp"
#include "core/parsing/json_depth.hpp"
#include "measurement/scene/warning_json.hpp"
#include "report/declared_figures.hpp"
#include "report/parameter_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

namespace vkfv::measurement {

namespace {

// The number of points in each state.
nlohmann::ordered_json point_counts(const Grid<topography::PointState>& state) {
    using topography::PointState;
    const auto count = [&](PointState wanted) { return std::ranges::count(state.values, wanted); };
    return {{"measured", count(PointState::measured)},         {"no_peak", count(PointState::no_peak)},
            {"by_chance", count(PointState::by_chance)},       {"poor_fit", count(PointState::poor_fit)},
            {"many_peaks", count(PointState::many_peaks)},     {"repaired", count(PointState::repaired)},
            {"low_contrast", count(PointState::low_contrast)}, {"dark", count(PointState::dark)}};
}

// The figures of the levelled surface, with those of the filtered one as a member.
nlohmann::ordered_json json_of(const std::vector<Figures>& figures) {
    auto json = json_of(figures.front());
    if (figures.size() > 1) {
        json["filtered"] = json_of(figures[1]);
    }
    return json;
}

nlohmann::ordered_json json_of(const topography::TopographyOptions& options) {
    return {{"focus_measure", name_of(options.focus_measure.value())},
            {"window_px", options.window_px},
            {"window_shape", name_of(options.window_shape)},
            {"smoothing_steps", options.smoothing_steps.value_or(0)},
            {"peak", name_of(options.peak)},
            {"peak_range_steps", options.peak_range_steps},
            {"false_peak_rate", options.false_peak_rate},
            {"most_rival", options.most_rival},
            {"least_contrast", options.least_contrast},
            {"most_fit_residual", options.most_fit_residual},
            {"most_peaks", options.most_peaks},
            {"place_by_texture", options.place_by_texture},
            {"repair_outliers", options.repair_outliers}};
}

// The places of the values in curves.npy: rows and columns of an image, counted from its upper left corner, and heights
// of the focal plane.
nlohmann::ordered_json places_json(const topography::FocusCurves& curves, int image_rows) {
    std::vector<int> rows;
    std::transform(curves.rows.rbegin(), curves.rows.rend(), std::back_inserter(rows),
                   [&](int row) { return image_rows - 1 - row; });
    return {{"file", "curves.npy"}, {"rows", rows}, {"columns", curves.columns}, {"z", curves.z}};
}

// The keys are those of assets/schemas without their unit. The values are in mm, which as_declared() converts.
nlohmann::ordered_json figures_of_curves(const Evaluation& evaluation) {
    nlohmann::ordered_json figures = {{"topography", json_of(evaluation.options)}};
    if (const auto& flatness = evaluation.flatness) {
        figures["flatness"] = {{"file", flatness->file.string()},
                               {"z_flt", flatness->deviation},
                               {"z_flt_s_filter", flatness->s_filter},
                               {"polynomial_peak_to_valley", flatness->polynomial_peak_to_valley}};
    }
    if (const auto& mapping = evaluation.mapping) {
        figures["mapping"] = {{"shift_x", mapping->shift.x},
                              {"shift_y", mapping->shift.y},
                              {"amplification_x", mapping->amplification.x},
                              {"amplification_y", mapping->amplification.y},
                              {"rotation", mapping->rotation},
                              {"perpendicularity", mapping->perpendicularity},
                              {"distortion", mapping->residual},
                              {"interpolation_error", mapping->error}};
    }
    if (evaluation.field_curvature) {
        figures["field_curvature_uncorrected"] = *evaluation.field_curvature;
    }
    const auto& whole = evaluation.topography.stack;
    figures["curves"] = {{"curve_width_steps", whole.curve_width_steps},
                         {"least_unimodality", whole.limit.least.unimodality},
                         {"least_order", whole.limit.least.order},
                         {"least_persistence", whole.persistence.least_ratio()},
                         {"chance_rate", whole.limit.rate},
                         {"stack_unimodality", whole.whole.unimodality},
                         {"stack_order", whole.whole.order},
                         {"least_stack_unimodality", whole.limit_of_whole.least.unimodality},
                         {"least_stack_order", whole.limit_of_whole.least.order},
                         {"rivalled_share", whole.rivalled_share},
                         {"image_noise", whole.image_noise},
                         {"noise_correlation", {whole.noise_correlation(1, 0), whole.noise_correlation(0, 1)}},
                         {"height_noise", evaluation.height_noise},
                         {"height_uncertainty", evaluation.height_uncertainty},
                         {"hidden_relief", whole.hidden_relief},
                         {"brightness_pull", whole.brightness_pull}};
    figures["focus_curves"] = places_json(evaluation.topography.curves, evaluation.topography.height.rows());
    figures["points"] = point_counts(evaluation.topography.state);
    return figures;
}

} // namespace

nlohmann::ordered_json results_of(const Evaluation& evaluation, const std::vector<Figures>& plain,
                                  const std::vector<Figures>& diffracted) {
    auto results = json_of(plain);
    if (evaluation.beyond_uncertainty) {
        results["beyond_uncertainty_share"] = *evaluation.beyond_uncertainty;
    }
    add_dimensions(results, evaluation.dimensions);
    if (evaluation.diffracted) {
        results["diffracted"] = json_of(diffracted);
        add_dimensions(results["diffracted"], evaluation.diffracted->dimensions);
    }
    results.update(report::as_declared("results", figures_of_curves(evaluation)));
    results["std_direction"] = report::std_direction;
    results["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    return results;
}

nlohmann::ordered_json run_of(const std::filesystem::path& folder) {
    auto run = nlohmann::ordered_json::object();
    std::error_code none;
    if (!std::filesystem::exists(folder / results_name, none)) {
        return run;
    }
    const std::string text = read_file(folder / results_name);
    check_json_depth(text, folder / results_name);
    const auto results = nlohmann::ordered_json::parse(text, nullptr, false);
    for (const char* key : {"device", "stack_digest", "seed", "images", "rays_per_image", "waves", "stage", "camera"}) {
        if (results.is_object() && results.contains(key)) {
            run[key] = results.at(key);
            if (run[key].is_object()) {
                run[key].erase("warnings"); // results of an earlier version have them here
            }
        }
    }
    return run;
}

std::vector<Warning> warnings_of_run(const std::filesystem::path& folder) {
    // Warnings that need the traced light are kept; the evaluation finds all others again.
    constexpr std::array of_images = {"ray-noise-above-camera", "saturated",    "grey-values-end",
                                      "dark-cut-off",           "coarse-waves", "folded-waves"};
    std::error_code none;
    if (!std::filesystem::exists(folder / results_name, none)) {
        return {};
    }
    const auto results = nlohmann::ordered_json::parse(read_file(folder / results_name), nullptr, false);
    std::vector<Warning> warnings;
    try {
        if (results.is_object() && results.contains("warnings")) {
            warnings = warnings_of_json(results.at("warnings"));
        }
    } catch (const nlohmann::json::exception&) { // another program changed the file
        return {};
    }
    std::erase_if(warnings, [&](const Warning& warning) {
        return std::ranges::none_of(of_images, [&](const char* code) { return warning.code == code; });
    });
    return warnings;
}

} // namespace vkfv::measurement
