#include "measurement/evaluation/evaluation_files.hpp"

#include "core/digest.hpp"
#include "core/file.hpp"
#include "core/job_queue.hpp"
#include "core/json_depth.hpp"
#include "core/threads.hpp"
#include "images/image_file.hpp"
#include "measurement/evaluation/evaluation_figures.hpp"
#include "measurement/evaluation/stack_page.hpp"
#include "report/declared_figures.hpp"
#include "report/layout.hpp"
#include "report/topography_picture.hpp"
#include "scan/store.hpp"
#include "surface/filter.hpp"
#include "surface_files/gwy.hpp"
#include "surface_files/height_image.hpp"
#include "surface_files/npy.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace vkfv::measurement {

namespace {

// How many points are in each state.
nlohmann::ordered_json point_counts(const Grid<topography::PointState>& state) {
    using topography::PointState;
    const auto count = [&](PointState wanted) { return std::ranges::count(state.values, wanted); };
    return {{"measured", count(PointState::measured)},         {"no_peak", count(PointState::no_peak)},
            {"by_chance", count(PointState::by_chance)},       {"poor_fit", count(PointState::poor_fit)},
            {"many_peaks", count(PointState::many_peaks)},     {"repaired", count(PointState::repaired)},
            {"low_contrast", count(PointState::low_contrast)}, {"dark", count(PointState::dark)}};
}

template <class To, class From>
Grid<To> converted(const Grid<From>& grid) {
    Grid<To> result(grid.columns, grid.rows);
    std::ranges::transform(grid.values, result.values.begin(), [](From value) { return static_cast<To>(value); });
    return result;
}

// Levelled, with the filtered ones within.
nlohmann::ordered_json json_of(const std::vector<Figures>& figures) {
    auto json = json_of(figures.front());
    if (figures.size() > 1) {
        json["filtered"] = json_of(figures[1]);
    }
    return json;
}

nlohmann::ordered_json json_of(const topography::TopographyOptions& options) {
    return {{"focus_measure", name_of(options.focus_measure)},
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

// A folder's own name, also of "out/" and ".".
std::string name_of(const std::filesystem::path& folder) {
    const auto whole = std::filesystem::absolute(folder).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::string picture_of(const std::filesystem::path& folder, const Evaluation& evaluation,
                       const std::string& image_unit) {
    report::TopographyPicture picture;
    picture.title = name_of(folder);
    picture.measured = evaluation.levelled.pair.measured;
    picture.truth = evaluation.levelled.truth;
    picture.deviation = evaluation.levelled.deviation;
    picture.image_unit = image_unit;
    picture.all_in_focus = topography::grey(evaluation.topography.all_in_focus);
    return report::topography_picture(picture);
}

// Other values at the places of a map.
surface::HeightMap with_values(surface::HeightMap map, Grid<double> values) {
    map.height = std::move(values);
    return map;
}

// Every map on the heights' grid. deviation: in the evaluation's band; null without a truth.
std::vector<surface::GwyChannel> channels_of(const Evaluation& evaluation, const surface::HeightMap* deviation,
                                             const std::string& image_unit) {
    const auto& topography = evaluation.topography;
    const auto on_grid = [&](Grid<double> values) { return with_values(topography.height, std::move(values)); };
    std::vector<surface::GwyChannel> channels = {{.title = "Height", .map = topography.height}};
    if (evaluation.truth) {
        channels.push_back({.title = "True height", .map = *evaluation.truth});
        channels.push_back({.title = "Deviation from the true height", .map = *deviation});
    }
    channels.push_back({.title = "Noise of the height", .map = on_grid(topography.height_noise)});
    channels.push_back({.title = "Uncertainty of the height", .map = on_grid(topography.height_uncertainty)});
    channels.push_back({.title = "Contrast", .unit = "", .map = on_grid(topography.contrast)});
    channels.push_back({.title = "Fit residual", .unit = "", .map = on_grid(topography.fit_residual)});
    channels.push_back(
        {.title = "What became of the point", .unit = "", .map = on_grid(converted<double>(topography.state))});
    const auto grey = topography::grey(topography.all_in_focus);
    channels.push_back({.title = "All in focus", .unit = image_unit, .map = on_grid(converted<double>(grey))});
    return channels;
}

// The first row has the highest y.
std::string curves_bytes(const topography::FocusCurves& curves) {
    const std::size_t row_values = curves.columns.size() * curves.z.size();
    std::vector<float> values;
    values.reserve(curves.values.size());
    for (std::size_t row = curves.rows.size(); row-- > 0;) {
        const auto begin = curves.values.begin() + static_cast<std::ptrdiff_t>(row * row_values);
        values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(row_values));
    }
    return surface::npy_bytes(values, {curves.rows.size(), curves.columns.size(), curves.z.size()});
}

// Where the values of curves.npy stand: pixels of an image from its left and upper end, heights of the focal plane.
nlohmann::ordered_json places_json(const topography::FocusCurves& curves, int image_rows) {
    std::vector<int> rows;
    std::transform(curves.rows.rbegin(), curves.rows.rend(), std::back_inserter(rows),
                   [&](int row) { return image_rows - 1 - row; });
    return {{"file", "curves.npy"}, {"rows", rows}, {"columns", curves.columns}, {"z", curves.z}};
}

// By the names of assets/schemas, and in the units of the inside.
nlohmann::ordered_json figures_of_curves(const Evaluation& evaluation) {
    nlohmann::ordered_json figures = {{"topography", json_of(evaluation.options)}};
    if (const auto& flatness = evaluation.flatness) {
        figures["flatness"] = {{"file", flatness->file.string()},
                               {"z_flt", flatness->deviation},
                               {"z_flt_s_filter", flatness->s_filter},
                               {"polynomial_peak_to_valley", flatness->polynomial_peak_to_valley}};
    }
    if (evaluation.field_curvature) {
        figures["field_curvature_uncorrected"] = *evaluation.field_curvature;
    }
    const auto& whole = evaluation.topography.stack;
    figures["curves"] = {{"curve_width_steps", whole.curve_width_steps},
                         {"least_unimodality", whole.limit.least.unimodality},
                         {"least_order", whole.limit.least.order},
                         {"chance_rate", whole.limit.rate},
                         {"stack_unimodality", whole.whole.unimodality},
                         {"stack_order", whole.whole.order},
                         {"least_stack_unimodality", whole.limit_of_whole.least.unimodality},
                         {"least_stack_order", whole.limit_of_whole.least.order},
                         {"rivalled_share", whole.rivalled_share},
                         {"image_noise", whole.image_noise},
                         {"noise_correlation", {whole.noise_correlation(1, 0), whole.noise_correlation(0, 1)}},
                         {"height_noise", evaluation.height_noise},
                         {"height_uncertainty", evaluation.height_uncertainty}};
    figures["focus_curves"] = places_json(evaluation.topography.curves, evaluation.topography.height.rows());
    figures["points"] = point_counts(evaluation.topography.state);
    return figures;
}

// What times are told of: not among the results, since no two runs take the same. A script, which alone a page that was
// opened from a disk may load.
void write_timings_script(const std::filesystem::path& folder) {
    const nlohmann::json text = read_file(folder / "timings.csv");
    write_file(folder / "timings.js", "vkfv.timings.show(" + text.dump() + ");\n");
}

// Into this folder in the results' own, each file by a thread of its own. Returns what the page shows of them; `count`
// evaluations share it.
EvaluationData write_maps(ResultFolder& results, const std::filesystem::path& folder, const Evaluation& evaluation,
                          const TopographyFiles& files, int count) {
    const auto& topography = evaluation.topography;
    const images::ImageTags pitch{
        .pitch_x = topography.height.pitch_x, .pitch_y = topography.height.pitch_y, .description = {}};
    const surface::HeightMap* deviation = nullptr; // in the evaluation's band; none without a truth
    EvaluationData data;
    JobQueue jobs(core_count(), 100);
    const auto write = [&](const std::string& name, const auto& bytes_of) {
        jobs.add([&results, path = folder / name, bytes_of] { results.write(path, bytes_of()); });
    };
    jobs.add([&] {
        results.write(folder / "topography.svg", picture_of(results.path() / folder, evaluation, files.image_unit));
    });
    jobs.add([&] { data = evaluation_data(folder.empty() ? "plain" : "diffracted", evaluation, count); });
    write("curves.npy", [&] { return curves_bytes(topography.curves); });
    if (evaluation.truth) {
        write("truth.tif", [&] { return surface::height_map_bytes(*evaluation.truth); });
        deviation = evaluation.filtered ? &evaluation.filtered->difference : &evaluation.levelled.deviation.value();
        write("deviation.tif", [&] { return surface::height_map_bytes(*deviation); });
    }
    // The format that laboratories exchange has all heights. What is no height, X3P cannot hold: it is in GWY.
    if (deviation != nullptr && std::ranges::find(files.names, "topography.x3p") != files.names.end()) {
        const auto write_surface = [&](const std::string& name, const surface::HeightMap& map, const char* what) {
            surface::Provenance provenance = files.provenance;
            provenance.comment = fmt::format("{}\n{}", what, provenance.comment);
            write(name, [&map, name, provenance] { return surface::surface_bytes(name, map, provenance); });
        };
        write_surface("truth.x3p", *evaluation.truth, "true heights of the specimen at the pixels' centres");
        write_surface("deviation.x3p", *deviation, "measured less true heights, after form and filters");
    }
    for (const std::string& file : files.names) {
        write(file, [&, file] {
            return file.ends_with(".gwy")
                       ? surface::gwy_bytes(channels_of(evaluation, deviation, files.image_unit), files.provenance)
                       : surface::surface_bytes(file, topography.height, files.provenance);
        });
    }
    write("height_noise.tif",
          [&] { return surface::height_map_bytes(with_values(topography.height, topography.height_noise)); });
    write("height_uncertainty.tif",
          [&] { return surface::height_map_bytes(with_values(topography.height, topography.height_uncertainty)); });
    write("quality.tif", [&] { return images::tiff_bytes(converted<float>(topography.contrast), pitch); });
    write("fit_residual.tif", [&] { return images::tiff_bytes(converted<float>(topography.fit_residual), pitch); });
    write("mask.tif", [&] { return images::tiff_bytes(converted<std::uint16_t>(topography.state), pitch); });
    write("all_in_focus.tif", [&] { return images::tiff_bytes(topography.all_in_focus, pitch); });
    jobs.finish();
    return data;
}

} // namespace

TopographyFiles topography_files(const Configuration& configuration) {
    TopographyFiles files;
    files.names = configuration.topography_files;
    files.image_unit = configuration.camera ? "DN" : "W";
    files.provenance.comment = fmt::format("configuration digest {}", Digest().add(configuration.identity).text());
    return files;
}

StackSource stack_source(const Configuration& configuration, const optics::Instrument& instrument) {
    return {.layout = report::layout_svg(instrument, name_of(configuration.output_directory)),
            .configuration = configuration.canonical};
}

void write_results(ResultFolder& folder, const EvaluatedStack& stack) {
    const auto& evaluation = stack.evaluation;
    auto figures = std::async(std::launch::async, [&] { return figures_of(evaluation); });
    auto frames =
        std::async(std::launch::async, [&] { return frames_data(evaluation.frames, stack.files.image_unit); });
    const int count = evaluation.diffracted ? 2 : 1;
    auto data = write_maps(folder, "", evaluation, stack.files, count);
    StackPage page{.title = name_of(folder.path()),
                   .plain = {.figures = figures.get(), .dimensions = evaluation.dimensions, .data = std::move(data)},
                   .diffracted = {},
                   .frames = frames.get(),
                   .results = {},
                   .ledger = stack.source.ledger,
                   .layout = stack.source.layout,
                   .configuration = stack.source.configuration};
    auto results = json_of(page.plain.figures);
    if (evaluation.beyond_uncertainty) {
        results["beyond_uncertainty_share"] = *evaluation.beyond_uncertainty;
    }
    add_dimensions(results, evaluation.dimensions);
    if (evaluation.diffracted) {
        page.diffracted = {.figures = figures_of(*evaluation.diffracted),
                           .dimensions = evaluation.diffracted->dimensions,
                           .data = write_maps(folder, "diffracted", *evaluation.diffracted, stack.files, count)};
        results["diffracted"] = json_of(page.diffracted->figures);
        add_dimensions(results["diffracted"], evaluation.diffracted->dimensions);
    }
    results.update(report::as_declared("results", figures_of_curves(evaluation)));
    results["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    results.update(stack.origin);
    folder.write(results_name, results.dump(2) + "\n");
    page.results = std::move(results);
    folder.write("report.html", stack_page(page));
    scan::append_timing(folder.path(), "evaluation", evaluation.seconds);
    write_timings_script(folder.path());
    folder.write_checksums();
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
        }
    }
    return run;
}

} // namespace vkfv::measurement
