#include "measurement/evaluation/evaluation_maps.hpp"

#include "core/files/digest.hpp"
#include "core/threads/job_queue.hpp"
#include "core/threads/threads.hpp"
#include "images/image_file.hpp"
#include "report/topography_picture.hpp"
#include "surface_files/gwy.hpp"
#include "surface_files/height_image.hpp"
#include "surface_files/npy.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vkfv::measurement {

namespace {

template <class To, class From>
Grid<To> converted(const Grid<From>& grid) {
    Grid<To> result(grid.columns, grid.rows);
    std::ranges::transform(grid.values, result.values.begin(), [](From value) { return static_cast<To>(value); });
    return result;
}

std::string picture_of(const std::filesystem::path& folder, const Evaluation& evaluation,
                       const std::string& image_unit) {
    report::TopographyPicture picture;
    picture.title = folder_name(folder);
    picture.measured = evaluation.levelled.pair.measured;
    picture.truth = evaluation.levelled.truth;
    picture.deviation = evaluation.levelled.deviation;
    picture.image_unit = image_unit;
    picture.all_in_focus = topography::grey(evaluation.topography.all_in_focus);
    return report::topography_picture(picture);
}

// A map of other values at the same places.
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

// The bytes of curves.npy. Its first row has the highest y.
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

} // namespace

std::string folder_name(const std::filesystem::path& folder) {
    const auto whole = std::filesystem::absolute(folder).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

TopographyFiles topography_files(const Configuration& configuration) {
    TopographyFiles files;
    files.names = configuration.topography_files;
    files.image_unit = configuration.camera ? "DN" : "W";
    files.provenance.comment = fmt::format("configuration digest {}", Digest().add(configuration.identity).text());
    return files;
}

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
    // X3P is the format that laboratories exchange, so all heights are written in it. It can only hold heights; GWY has
    // the other maps.
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
            surface::Provenance provenance = files.provenance;
            const bool dated = file.ends_with(".x3p") || file.ends_with(".sdf");
            if (dated && surface::source_date().empty()) {
                provenance.date = files.date_of_images;
            }
            return file.ends_with(".gwy")
                       ? surface::gwy_bytes(channels_of(evaluation, deviation, files.image_unit), provenance)
                       : surface::surface_bytes(file, topography.height, provenance);
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

} // namespace vkfv::measurement
