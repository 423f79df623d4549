#include "measurement/evaluation/existing_stack.hpp"

#include "core/threads/read_ahead.hpp"
#include "measurement/evaluation/brightness_warnings.hpp"
#include "measurement/evaluation/noise_warnings.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/light_way.hpp"
#include "measurement/scene/phase_limits.hpp"
#include "measurement/scene/stage_figures.hpp"
#include "report/declared_figures.hpp"
#include "scan/repair.hpp"
#include "scan/store.hpp"
#include "specimen/kinds.hpp"
#include "topography/stack_faults.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <random>
#include <sstream>
#include <string>

namespace vkfv::measurement {

namespace {

// The images' numbers in their order, or in a random order by Fisher and Yates's shuffle. The shuffle uses the
// generator's bits alone, so that a seed means the same order with every standard library.
std::vector<int> order_of_images(std::size_t count, const Shuffle& shuffle) {
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    if (shuffle) {
        std::mt19937_64 random(*shuffle);
        for (std::size_t last = count; last > 1; --last) {
            std::swap(order[last - 1], order[random() % last]);
        }
    }
    return order;
}

// The first line of the identity that the overrides change, as "key = value" with the new value.
std::optional<std::string> changed_line(const Configuration& configuration, const Configuration& overridden) {
    if (configuration.identity == overridden.identity) {
        return std::nullopt;
    }
    std::istringstream before(configuration.identity), after(overridden.identity);
    std::string line, other;
    while (std::getline(after, other) && std::getline(before, line) && line == other) {
    }
    return other;
}

// The configuration of a stack with its overrides, which must leave the images as they are.
Configuration configuration_of(const OwnStack& stack) {
    const auto file = stack.folder / "stack.toml";
    auto configuration = load_configuration(file, stack.overrides, Needs::stack);
    if (const auto line = changed_line(load_configuration(file, {}, Needs::stack), configuration)) {
        throw InputError(
            {.where = {.file = "command line", .line = 0, .column = 0, .byte_offset = {}},
             .key = "",
             .found = *line,
             .expected = "the value that the images were traced with, in " + file.string(),
             .remedy = "Set keys of [topography], [diffraction] and [output] alone; vkfv stack traces other images."});
    }
    return configuration;
}

// All work that follows is sized by stack.toml, so the images must be those that it claims. The first is checked by its
// pixels, the last by its name.
void refuse_other_images(const std::filesystem::path& folder, const Configuration& configuration,
                         const std::vector<double>& positions) {
    const auto first = scan::read_frame(folder, 0, positions.front());
    const ImageSize claimed = configuration.instrument.detector_pixels;
    const auto refuse = [&](const std::filesystem::path& file, std::string found, std::string expected) {
        refuse_file(file, "", std::move(found), std::move(expected),
                    "stack.toml is not that of these images: copy the one that was written with them, or give the "
                    "images alone, in a folder without it.");
    };
    if (first.columns != claimed.columns || first.rows != claimed.rows) {
        refuse(folder / scan::image_path(0), fmt::format("{} x {} pixels", first.columns, first.rows),
               fmt::format("{} x {}, as stack.toml claims", claimed.columns, claimed.rows));
    }
    const int last = static_cast<int>(positions.size()) - 1;
    if (!std::filesystem::exists(folder / scan::image_path(last))) {
        refuse(folder / scan::image_path(last), "no such file",
               fmt::format("the last of {} images, as stack.toml claims", positions.size()));
    }
}

bool any_negative(const topography::Channels& image) {
    return std::ranges::any_of(image, [](const Grid<float>& channel) {
        return std::ranges::any_of(channel.values, [](float value) { return value < 0; });
    });
}

// The images of another instrument, each registered to the one in the middle if the configuration asks for it.
class LaidImages {
  public:
    LaidImages(const scan::ImageSeries& series, const FrameCorrection& correction, topography::Registration what)
        : series_(series), correction_(correction) {
        if (what == topography::Registration::none) {
            return;
        }
        std::vector<topography::ImageTransform> steps(1);
        Grid<float> before = topography::grey(corrected(0));
        for (int image = 1; image < series.size(); ++image) {
            Grid<float> next = topography::grey(corrected(image));
            if (next.columns != before.columns || next.rows != before.rows) {
                return; // the evaluation refuses this image
            }
            steps.push_back(topography::registered(before, next, what));
            before = std::move(next);
        }
        transforms_ = topography::in_common_frame(steps);
        const auto& first = transforms_.front();
        const auto& last = transforms_.back();
        spdlog::info("images laid over each other: from the first to the last ({:.2f}, {:.2f}) pixels, scale {:.5f}",
                     last.shift_x - first.shift_x, last.shift_y - first.shift_y, last.scale / first.scale);
    }

    topography::Channels read(int image) const { return laid(corrected(image), image); }

    // Reads the image as read() does. `faults` gets the image before any correction, as the camera gave it.
    topography::Channels read(int image, topography::StackFaultsFinder& faults) const {
        auto channels = series_.read(image);
        faults.add(channels);
        return laid(correction_.corrected(std::move(channels), series_.name(image)), image);
    }

    // The shift in pixels and the scale of each image, in the images' order.
    nlohmann::ordered_json json() const {
        auto rows = nlohmann::ordered_json::array();
        for (const auto& transform : transforms_) {
            rows.push_back({transform.shift_x, transform.shift_y, transform.scale});
        }
        return rows;
    }

  private:
    topography::Channels corrected(int image) const {
        return correction_.corrected(series_.read(image), series_.name(image));
    }

    topography::Channels laid(topography::Channels channels, int image) const {
        return transforms_.empty() ? channels
                                   : topography::resampled(channels, transforms_[static_cast<std::size_t>(image)]);
    }

    const scan::ImageSeries& series_;
    const FrameCorrection& correction_;
    std::vector<topography::ImageTransform> transforms_; // empty: images are not registered
};

// A sentence for each fault that is large enough to matter: its effect on the heights, and a remedy.
std::vector<std::string> sentences_of(const topography::StackFaults& faults, topography::Registration registration) {
    constexpr double least_flicker = 0.01, least_saturated = 0.001, least_wander = 1; // pixel
    std::vector<std::string> sentences;
    if (faults.flicker >= least_flicker) {
        sentences.push_back(fmt::format(
            "The light flickers by {:.2g} % from image to image. Focus is contrast relative to brightness, so heights "
            "stay, but use a steady lamp and a fixed exposure",
            100 * faults.flicker));
    }
    if (faults.exposure_step != 0) {
        sentences.push_back(fmt::format(
            "The brightness changes by {:.2g} % at image {} and stays so: the exposure or the lamp was changed within "
            "the stack. The noise changes with it: fix exposure, gain and light",
            100 * faults.exposure_step, faults.step_image));
    }
    if (faults.saturated_share >= least_saturated) {
        sentences.push_back(fmt::format("{:.2g} % of the pixels are saturated: texture is not seen there. Expose less",
                                        100 * faults.saturated_share));
    }
    if (registration == topography::Registration::none &&
        std::max(faults.wander, faults.corner_wander) >= least_wander) {
        const bool scaled = faults.corner_wander >= least_wander;
        sentences.push_back(fmt::format(
            "The image wanders by {:.2g} pixels within the stack{}: --set "
            "topography.registration=\"{}\" lays the images over each other",
            faults.wander,
            scaled ? fmt::format(" and its scale changes by {:.2g} %", 100 * (faults.scale - 1)) : std::string(),
            scaled ? "shift-and-scale" : "shift"));
    }
    return sentences;
}

// Images of an instrument that vkfv does not know are read twice. This first time, their focus curves and noise settle
// the options.
void settle(topography::TopographyOptions& options, const LaidImages& images, const std::vector<int>& order) {
    if (options.settled()) {
        return;
    }
    std::optional<topography::FocusProbes> probes;
    int columns = 0, rows = 0;
    bool of_one_size = true;
    read_ahead(
        static_cast<int>(order.size()), [&](int place) { return images.read(order[static_cast<std::size_t>(place)]); },
        [&](int, const topography::Channels& channels) {
            if (!probes) {
                columns = channels.front().columns;
                rows = channels.front().rows;
                probes.emplace(columns, rows, options.focus_measure.value_or(topography::where_noise_is_low),
                               topography::FocusWindow(options.window_px, options.window_shape));
            }
            of_one_size = of_one_size && channels.front().columns == columns && channels.front().rows == rows;
            if (of_one_size) {
                probes->add(channels);
            }
        });
    if (of_one_size) {
        probes->settle(options);
    } else { // the evaluation refuses the image of another size
        options.focus_measure = options.focus_measure.value_or(topography::where_noise_counts);
    }
}

} // namespace

EvaluatedStack evaluate_own_stack(const OwnStack& stack) {
    const auto configuration = configuration_of(stack);
    const auto positions = configuration.scan->positions();
    refuse_other_images(stack.folder, configuration, positions);
    const auto specimen = make_specimen(configuration);
    const auto instrument = assemble_instrument(configuration, specimen, positions);
    const ImageSize pixels = configuration.instrument.detector_pixels;
    std::vector<Warning> warnings =
        plan_warnings(configuration, instrument, relief_of(specimen, pixels, instrument.first_order.pixel_pitch));
    KnownErrors errors{.flat = read_flat(configuration, pixels, height_pitch(instrument, configuration)),
                       .design = optics::field_curvature(instrument.first_order)};
    std::vector<Warning> of_phase;
    if (configuration.trace.waves) {
        const PhaseLimits limits = phase_limits(configuration.instrument, instrument, specimen);
        errors.hidden_uncertainty = limits.height_uncertainty();
        of_phase = warnings_of(limits);
    }
    log_warnings(warnings);
    log_warnings(of_phase);
    // The log has the instrument's warnings already. Their order is the one of the run that traced the stack.
    append(warnings, instrument.warnings);
    const auto order = order_of_images(positions.size(), stack.shuffle);
    StackEvaluation evaluation(
        evaluation_options(configuration, instrument),
        focus_planes_for_files(configuration.evaluate_on, configuration.trace.device, positions.size()),
        diffraction_of_evaluation(configuration, instrument), static_cast<int>(positions.size()));
    read_ahead(
        static_cast<int>(positions.size()),
        [&](int place) {
            const int image = order[static_cast<std::size_t>(place)];
            return scan::read_frame(stack.folder, image, positions[static_cast<std::size_t>(image)]);
        },
        [&](int place, Grid<float> values) {
            const double z = positions[static_cast<std::size_t>(place)];
            evaluation.add({std::move(values)}, z, reading_of(configuration, z, place));
        });
    auto source = stack_source(configuration, instrument);
    source.ledger = configuration.trace.estimator == trace::Estimator::backward
                        ? light_way(configuration, instrument, specimen, positions)
                        : scan::mean_ledger(stack.folder);
    auto origin = run_of(stack.folder);
    std::vector<Warning> of_waves = warnings_of_run(stack.folder), of_camera;
    std::ranges::copy_if(of_waves, std::back_inserter(of_camera),
                         [](const Warning& warning) { return !warning.code.ends_with("-waves"); });
    std::erase_if(of_waves, [](const Warning& warning) { return !warning.code.ends_with("-waves"); });
    for (const auto& further : {of_waves, of_phase, of_camera}) {
        append(warnings, further);
    }
    std::error_code none; // a destination that does not exist yet is another folder
    if (!std::filesystem::equivalent(stack.destination, stack.folder, none)) {
        origin = {{"stack", stack.folder.string()},
                  {"images", positions.size()},
                  {"rays_per_image", trace::launched_rays(configuration.trace, configuration.instrument)},
                  {"seed", configuration.trace.seed}};
    }
    if (scan::was_repaired(stack.folder)) {
        origin["repaired"] = true;
    }
    auto evaluated = evaluation.finish(truth_on_pixels(instrument, configuration, specimen), configuration.band, errors,
                                       specimen::feature_of(*configuration.specimen));
    auto found = warnings_of_noise(configuration, evaluated);
    append(found, warnings_of_brightness(evaluated));
    log_warnings(found);
    append(warnings, found);
    return {.evaluation = std::move(evaluated),
            .warnings = std::move(warnings),
            .origin = std::move(origin),
            .source = std::move(source),
            .files = topography_files(configuration)};
}

EvaluatedStack evaluate_images(const scan::ImageSeries& series, const ForeignStack& stack) {
    const auto configuration = topography_configuration(stack.overrides);
    const auto order = order_of_images(static_cast<std::size_t>(series.size()), stack.shuffle);
    const auto at_place = [&](int place) {
        // Heights ascend, whichever way the instrument went.
        return stack.z_step > 0 ? place : series.size() - 1 - place;
    };
    const FrameCorrection correction(stack.corrections);
    const LaidImages images(series, correction, configuration.registration);
    auto options = configuration.topography;
    settle(options, images, order);
    StackEvaluation evaluation(
        options, focus_planes_for_files(configuration.evaluate_on, configuration.trace.device, order.size()),
        std::nullopt, series.size());
    spdlog::info("{} images, {} to {}", series.size(), series.name(0), series.name(series.size() - 1));
    KnownErrors errors;
    bool negative = false;
    topography::StackFaultsFinder finder(series.size());
    read_ahead(
        series.size(), [&](int place) { return images.read(order[static_cast<std::size_t>(at_place(place))], finder); },
        [&](int place, topography::Channels channels) {
            if (place == 0) {
                errors.flat = read_flat(configuration, {channels.front().columns, channels.front().rows}, stack.pitch);
            }
            negative = negative || any_negative(channels);
            evaluation.add(std::move(channels), stack.z_start + at_place(place) * stack.z_step);
        });
    std::vector<Warning> warnings;
    const auto warn = [&](const char* code, const std::string& sentence) {
        warnings.push_back({.code = code, .key = {}, .value = {}, .works = {}, .sentence = sentence});
    };
    if (negative && !stack.corrections.dark) { // noise of an image reaches below an offset that was subtracted
        warn("negative-light",
             fmt::format(
                 "{}: there are pixels below zero. Focus is contrast relative to brightness: give the images without "
                 "any background subtracted.",
                 stack.images.string()));
    }
    const topography::StackFaults faults = finder.finish();
    if (!stack.shuffle) { // a random order has faults of its own
        for (const auto& sentence : sentences_of(faults, configuration.registration)) {
            warn("image-fault", fmt::format("{}: {}.", stack.images.string(), sentence));
        }
    }
    log_warnings(warnings);
    auto origin = report::as_declared("results", {{"stack", stack.images.string()},
                                                  {"images", series.size()},
                                                  {"first_image", series.name(0)},
                                                  {"last_image", series.name(series.size() - 1)},
                                                  {"z_start", stack.z_start},
                                                  {"z_step", stack.z_step},
                                                  {"pitch", stack.pitch}});
    if (stack.corrections.dark) {
        origin["dark"] = stack.corrections.dark->string();
    }
    if (stack.corrections.flat_field) {
        origin["flat_field"] = stack.corrections.flat_field->string();
    }
    if (stack.corrections.dark || stack.corrections.flat_field) {
        origin["dead_pixels"] = correction.dead_pixels();
    }
    if (!stack.shuffle) {
        origin["image_faults"] = {{"flicker", faults.flicker},
                                  {"exposure_step", faults.exposure_step},
                                  {"saturated_share", faults.saturated_share},
                                  {"wander_pixels", faults.wander},
                                  {"scale", faults.scale}};
    }
    if (configuration.registration != topography::Registration::none) {
        origin["registration"] = images.json();
    }
    return {.evaluation = evaluation.finish(stack.pitch, configuration.band.form, errors),
            .warnings = std::move(warnings),
            .origin = std::move(origin),
            .source = {},
            .files = {.date_of_images = series.stated().date}};
}

} // namespace vkfv::measurement
