#include "measurement/fit/fit.hpp"

#include "core/files/result_folder.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/stages.hpp"
#include "core/messages/warning.hpp"
#include "measurement/calibration/certificate.hpp"
#include "measurement/fit/fit_documents.hpp"
#include "measurement/fit/model_stacks.hpp"
#include "measurement/scene/disk_space.hpp"
#include "scan/image_series.hpp"
#include "scan/stack_identity.hpp"
#include "scan/store.hpp"
#include "topography/focus_measure.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace vkfv::measurement {

namespace {
namespace of_fit { // files of a unity build share the unnamed namespace

namespace fs = std::filesystem;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double told_share = 1.0 / 3; // of the range known beforehand, at most a told parameter's standard uncertainty

bool made_here(const FitRequest& request) {
    std::error_code none;
    return fs::exists(request.stack / scan::configuration_name, none);
}

fs::path configuration_file(const FitRequest& request) {
    if (request.configuration) {
        return *request.configuration;
    }
    if (!made_here(request)) {
        throw InputError({.where = {.file = "command line"},
                          .key = "",
                          .found = fmt::format("{}, which has no stack.toml", request.stack.string()),
                          .expected = "a folder of a stack of vkfv, or --config with images of another instrument",
                          .remedy = "Give --config C.toml, a configuration that makes stacks like these images."});
    }
    return request.stack / scan::configuration_name;
}

[[noreturn]] void refuse_stack(const FitRequest& request, std::string found, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = request.stack},
                      .key = "",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

// The mean of the pixels that lie in each of the model's.
Grid<float> reduced_to(const Grid<float>& image, ImageSize pixels) {
    const int across = image.columns / pixels.columns, along = image.rows / pixels.rows;
    Grid<double> sums(pixels.columns, pixels.rows);
    for (int row = 0; row < pixels.rows * along; ++row) {
        for (int column = 0; column < pixels.columns * across; ++column) {
            sums(column / across, row / along) += image(column, row);
        }
    }
    Grid<float> result(pixels.columns, pixels.rows);
    std::ranges::transform(sums.values, result.values.begin(),
                           [&](double sum) { return static_cast<float>(sum / (across * along)); });
    return result;
}

std::vector<double> statistics_of_own(const FitRequest& request, const Configuration& configuration,
                                      const StatisticsLayout& layout) {
    const auto positions = configuration.scan->positions();
    StackStatistics statistics(layout);
    for (int image = 0; image < layout.images; ++image) {
        const auto frame = scan::read_frame(request.stack, image, positions[static_cast<std::size_t>(image)]);
        if (frame.columns != layout.pixels.columns || frame.rows != layout.pixels.rows) {
            refuse_stack(
                request, fmt::format("images of {} x {} pixels", frame.columns, frame.rows),
                fmt::format("{} x {}, as the configuration makes them", layout.pixels.columns, layout.pixels.rows),
                "Leave detector.pixels as the stack has it.");
        }
        statistics.add(image, frame);
    }
    if (fs::exists(request.stack / scan::image_path(layout.images))) {
        refuse_stack(request, fmt::format("more than {} images", layout.images), "as many as the configuration makes",
                     "Leave [scan] as the stack has it.");
    }
    return statistics.values();
}

// Photographs of whole multiples of the model's pixels are reduced to them.
std::vector<double> statistics_of_images(const FitRequest& request, const StatisticsLayout& layout) {
    const scan::ImageSeries series(request.stack);
    if (series.size() != layout.images) {
        refuse_stack(request, fmt::format("{} images", series.size()),
                     fmt::format("{}, as many as the configuration makes", layout.images),
                     "Give [scan] as many positions as there are images.");
    }
    StackStatistics statistics(layout);
    for (int image = 0; image < layout.images; ++image) {
        const auto grey = topography::grey(series.read(request.descending ? layout.images - 1 - image : image));
        const ImageSize pixels = layout.pixels;
        const int times = grey.columns / pixels.columns;
        if (times < 1 || grey.columns != times * pixels.columns || grey.rows != times * pixels.rows) {
            refuse_stack(
                request, fmt::format("images of {} x {} pixels", grey.columns, grey.rows),
                fmt::format("the {} x {} of the configuration, or a whole multiple", pixels.columns, pixels.rows),
                "Give detector.pixels a whole part of the images' size.");
        }
        statistics.add(image, reduced_to(grey, pixels));
    }
    return statistics.values();
}

void require_request(const FitRequest& request, const Configuration& base) {
    const auto least = static_cast<int>(statistics::least_seeds(request.keys.size()));
    if (request.replicates < least) {
        throw InputError({.where = {.file = "command line"},
                          .key = "--replicates",
                          .found = fmt::format("{} for {} parameters", request.replicates, request.keys.size()),
                          .expected = fmt::format("at least {}", least),
                          .remedy = "Give more, or free fewer parameters."});
    }
    std::error_code none;
    if (fs::equivalent(base.output_directory, request.stack, none)) {
        throw InputError({.where = {.file = "command line"},
                          .key = "--out",
                          .found = base.output_directory.string(),
                          .expected = "a folder other than the stack's",
                          .remedy = "Name another."});
    }
    if (!made_here(request) && base.diffraction.any() && !base.camera) {
        throw InputError({.where = {.file = base.file},
                          .key = "diffraction",
                          .found = "images that are blurred only when they are evaluated",
                          .expected = "images as they are taken, to compare photographs with",
                          .remedy = "Give diffraction.model = \"waves\" or \"none\", or a [camera]."});
    }
}

// Throws InputError if the configuration refuses the start or the first steps beside it, before hours are spent.
void require_first_places(const ModelStacks& model, std::size_t parameters) {
    std::vector<double> place(parameters, 0.0);
    (void)model.configuration(place, 0);
    for (double& one : place) {
        for (const double step : {-moment_search_step, moment_search_step}) {
            one = step;
            (void)model.configuration(place, 0);
        }
        one = 0;
    }
}

// Tells, before the first stack is traced, how many stacks and how much of the disk the fit will take, and refuses it
// where they do not fit. One stack of images is there at a time.
void forecast_of(const Configuration& base, const FitRequest& request, const fs::path& folder) {
    const auto bytes = static_cast<std::uint64_t>(static_cast<double>(image_bytes(base.instrument.detector_pixels)) *
                                                  static_cast<double>(base.scan->positions().size()));
    const auto free = free_bytes(folder);
    spdlog::info("At most {} stacks of {} images are traced, {} of them to begin with. One at a time takes up to {} of "
                 "the disk, which has {} free; only statistics are kept",
                 most_stacks(request.keys.size(), request.replicates), base.scan->positions().size(),
                 request.replicates, bytes_text(bytes), bytes_text(free));
    if (bytes > free) {
        throw RunError(fmt::format("a stack takes {}, and {} has {} free. Choose another --out", bytes_text(bytes),
                                   folder.string(), bytes_text(free)));
    }
}

} // namespace of_fit
} // namespace

double Fit::enlargement() const {
    return describes() ? 1 : std::sqrt(search.fit.misfit);
}

std::vector<FittedParameter> Fit::fitted() const {
    using of_fit::unknown;
    std::vector<FittedParameter> result;
    result.reserve(parameters.size());
    const auto& fit = search.fit;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        const FreeParameter& parameter = parameters[k];
        FittedParameter one{.parameter = parameter,
                            .determined = fit.determined[k],
                            .estimate = unknown,
                            .standard_uncertainty = unknown,
                            .low = unknown,
                            .high = unknown,
                            .bound = unknown,
                            .uncertainty_ratio = unknown};
        if (one.determined) {
            const double place = search.place[k] + fit.change[k], slope = parameter.slope(place);
            const double deviation = std::sqrt(fit.covariance(k, k));
            const double factor =
                boost::math::quantile(boost::math::students_t(fit.degrees_of_freedom), 0.975) * enlargement();
            one.estimate = parameter.value(place);
            one.standard_uncertainty = std::abs(slope) * deviation * enlargement();
            one.low = parameter.value(place - factor * deviation);
            one.high = parameter.value(place + factor * deviation);
            one.told = search.settled && deviation * enlargement() <= of_fit::told_share * parameter.known_width(place);
            if (fit.bound.rows > k && fit.bound(k, k) > 0) {
                one.bound = std::abs(slope) * std::sqrt(fit.bound(k, k));
                one.uncertainty_ratio = deviation / std::sqrt(fit.bound(k, k));
            }
        }
        result.push_back(std::move(one));
    }
    return result;
}

double Fit::correlation(std::size_t first, std::size_t second) const {
    const auto& fit = search.fit;
    return fit.determined[first] && fit.determined[second]
               ? fit.covariance(first, second) /
                     std::sqrt(fit.covariance(first, first) * fit.covariance(second, second))
               : of_fit::unknown;
}

double Fit::covariance(std::size_t first, std::size_t second) const {
    const auto& fit = search.fit;
    const auto slope = [&](std::size_t k) { return parameters[k].slope(search.place[k] + fit.change[k]); };
    return fit.determined[first] && fit.determined[second]
               ? slope(first) * slope(second) * fit.covariance(first, second) * enlargement() * enlargement()
               : of_fit::unknown;
}

FitResult fit(const FitRequest& request, Progress& progress) {
    const auto file = of_fit::configuration_file(request);
    const Configuration base = load_configuration(file, request.overrides, Needs::stack);
    Fit found{.program = request.program,
              .stack = request.stack.string(),
              .title = request.configuration ? file.stem().string() : request.stack.stem().string(),
              .first_seed = base.trace.seed,
              .replicates = request.replicates,
              .positions = base.scan->positions(),
              .parameters = free_parameters(base, request.keys, request.starts)};
    of_fit::require_request(request, base);
    constexpr int least_window = 4; // pixels, for a sharpness within a square
    found.layout = {.images = static_cast<int>(found.positions.size()),
                    .pixels = base.instrument.detector_pixels,
                    .window = std::max(least_window, base.topography.window_px),
                    .brightness = of_fit::made_here(request)};
    enter_stage("statistics of the stack");
    found.measured = of_fit::made_here(request) ? of_fit::statistics_of_own(request, base, found.layout)
                                                : of_fit::statistics_of_images(request, found.layout);
    ResultFolder results(base.output_directory);
    ModelStacks model(base, file, request.overrides, found.parameters, found.layout, results, progress);
    of_fit::require_first_places(model, found.parameters.size());
    of_fit::forecast_of(base, request, results.path());
    const double images = static_cast<double>(found.positions.size());
    const int most = most_stacks(found.parameters.size(), request.replicates);
    const CountedWork work(most * images);
    const WarningsOnce warnings_once; // each stack would give them again
    const auto begun = std::chrono::steady_clock::now();
    bool told = false;
    const auto statistics_at = [&](const std::vector<double>& place, int seed) {
        auto statistics = model.statistics(place, seed);
        if (!told && model.stacks() >= request.replicates && model.traced() > 0) { // those kept took no time
            told = true;
            const std::chrono::duration<double> past = std::chrono::steady_clock::now() - begun;
            spdlog::info("{} stacks took {:.3g} s; the others take at most {:.3g} s", model.traced(), past.count(),
                         past.count() / model.traced() * (most - model.stacks()));
        }
        return statistics;
    };
    try {
        found.search = search_moments(found.parameters, found.measured, statistics_at, request.replicates);
    } catch (const std::domain_error&) {
        throw RunError(
            "the model's stacks do not differ from seed to seed, so nothing tells how far a measured stack may "
            "be from them. Give [specimen.roughness] or [specimen.reflectance] a texture, or fewer rays");
    }
    found.stacks = model.stacks();
    leave_out_work((most - found.stacks) * images);
    found.devices.assign(model.devices().begin(), model.devices().end());
    std::erase(found.devices, std::string());
    FitResult result{.document = fit_json(found), .folder = results.path()};
    results.write("fit.json", json_text(result.document) + "\n");
    results.write("fit.html", fit_page(found, base.canonical));
    results.write_checksums();
    return result;
}

std::string summary(const FitResult& result) {
    const auto& document = result.document;
    std::string text;
    for (const auto& remark : document.at("remarks")) {
        text += remark.get<std::string>() + "\n";
    }
    for (const auto& parameter : document.at("parameters")) {
        const std::string unit = parameter.at("unit");
        const auto number = [&](const char* key) {
            const auto& value = parameter.at(key);
            return value.is_null() || !std::isfinite(value.get<double>()) ? std::string("-")
                                                                          : fmt::format("{:.5g}", value.get<double>());
        };
        text +=
            fmt::format("  {:<40} {}{}, u = {}, 95 % within {} to {}\n", parameter.at("key").get<std::string>() + ":",
                        number("estimate"), unit.empty() ? "" : " " + unit, number("standard_uncertainty"),
                        number("low"), number("high"));
    }
    return text + not_traceable + "\n";
}

} // namespace vkfv::measurement
