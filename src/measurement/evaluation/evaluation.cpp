#include "measurement/evaluation/evaluation.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/mathematics/units.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface_files/surface_file.hpp"
#include "topography/device_focus_planes.hpp"
#include "topography/flatness.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <iterator>
#include <limits>
#include <vector>

namespace vkfv::measurement {

namespace {

// The time of the object's life is added to the seconds when it ends.
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

// The median of the finite values; NaN without any.
double median_of(const Grid<double>& grid) {
    std::vector<double> values;
    std::ranges::copy_if(grid.values, std::back_inserter(values), [](double value) { return std::isfinite(value); });
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

std::string text_of(const char* treatment, const topography::Deviation& deviation) {
    // A flat true surface has no ratio.
    const std::string ratio =
        deviation.sq_true > 0 ? fmt::format(" (ratio {:.3f})", deviation.sq_measured / deviation.sq_true) : "";
    return fmt::format("{:<30} Sq measured {:.4f} um, true {:.4f} um{}, RMS deviation {:.4f} um, correlation {:.4f}\n",
                       treatment, deviation.sq_measured * um_per_mm, deviation.sq_true * um_per_mm, ratio,
                       deviation.rms * um_per_mm, deviation.correlation);
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

std::string uncertainty_text(const Evaluation& evaluation) {
    std::string text = fmt::format("standard uncertainty of a height {:.3g} um, of it the images' noise {:.3g} um",
                                   evaluation.height_uncertainty * um_per_mm, evaluation.height_noise * um_per_mm);
    if (evaluation.beyond_uncertainty) {
        text += fmt::format("; {:.1f} % of the points are more than {:g} times theirs from the truth",
                            100 * evaluation.beyond_uncertainty.value(), coverage_factor);
    }
    return text;
}

struct Reason {
    topography::PointState state;
    std::string sentence;
};

// A sentence for each reason that kept at least a twentieth of the points out, with a remedy.
std::vector<std::string> reasons_of(const Evaluation& evaluation) {
    using topography::PointState;
    const auto& options = evaluation.options;
    const auto& state = evaluation.topography.state.values;
    const std::vector<Reason> reasons = {
        {PointState::no_peak, "have their largest focus value at an end of the scan, or no maximum: scan further"},
        {PointState::by_chance,
         fmt::format(
             "have focus curves no better than by chance: their images' noise is {:.2g} % of the brightness. More "
             "light or rays, finer steps, more texture or a larger topography.window_px help; "
             "topography.false_peak_rate = 1 shows them",
             100 * evaluation.topography.stack.image_noise)},
        {PointState::low_contrast,
         fmt::format("have less contrast than topography.least_contrast = {:g}", options.least_contrast)},
        {PointState::dark, "have less than a hundredth of the mean brightness around them: light them"},
        {PointState::poor_fit, fmt::format("are further from a Gaussian than topography.most_fit_residual = {:g}",
                                           options.most_fit_residual)},
        {PointState::many_peaks,
         fmt::format(
             "have a second maximum above topography.most_rival = {:g} of the first{}, or more than "
             "topography.most_peaks = {}: a larger topography.window_px helps, or texture that light can resolve",
             options.most_rival,
             evaluation.topography.stack.rivalled() ? ", as most of this stack's curves, or noise that could hide it"
                                                    : "",
             options.most_peaks)}};
    constexpr double least_share = 0.05;
    std::vector<std::string> found;
    for (const auto& [which, sentence] : reasons) {
        const double share = static_cast<double>(std::ranges::count(state, which)) / static_cast<double>(state.size());
        if (share >= least_share) {
            found.push_back(fmt::format("{:.1f} % {}", 100 * share, sentence));
        }
    }
    return found;
}

std::string measured_text(double share) {
    return fmt::format("measured {:.1f} % of the points", 100 * share);
}

// The text is empty unless chance lets through more than twice the share that was asked for. A rate of 1 is one that no
// random order has told.
std::string chance_text(const Evaluation& evaluation) {
    const double rate = evaluation.topography.stack.limit.rate;
    return rate < 1 && rate > 2 * evaluation.options.false_peak_rate
               ? fmt::format("with the images in random order {:.2g} % would pass: so few images tell no more",
                             100 * rate)
               : std::string();
}

// The grid is fine enough to show how curves differ over the field. Values of long stacks are thinned out, so that
// curves take 32 MB at most.
topography::CurveGrid curve_grid(int images) {
    constexpr int a_side = 64, most_values = 2048;
    return images > 0 ? topography::CurveGrid{.columns = a_side,
                                              .rows = a_side,
                                              .every = (images + most_values - 1) / most_values}
                      : topography::CurveGrid();
}

} // namespace

topography::FocusPlanesMaker focus_planes_for(EvaluateOn evaluate_on, std::shared_ptr<const vulkan::Device> traces) {
    if (evaluate_on == EvaluateOn::host ||
        (evaluate_on == EvaluateOn::automatic && (!traces || vulkan::is_software(traces->report())))) {
        return topography::make_host_focus_planes;
    }
    return topography::device_focus_planes(traces ? std::move(traces) : std::make_shared<const vulkan::Device>());
}

topography::FocusPlanesMaker focus_planes_for_files(EvaluateOn evaluate_on, const std::string& device_selector,
                                                    std::size_t images) {
    if (evaluate_on == EvaluateOn::host || (evaluate_on == EvaluateOn::automatic && device_selector == "host")) {
        return topography::make_host_focus_planes;
    }
    const vulkan::DeviceOptions device{device_selector == "host" ? std::string() : device_selector};
    if (evaluate_on == EvaluateOn::device) {
        return topography::device_focus_planes(std::make_shared<const vulkan::Device>(device));
    }
    // The device is opened once, for images with and without diffraction.
    return [device, images, opened = std::make_shared<std::shared_ptr<const vulkan::Device>>()](
               const topography::FocusPlanesPlan& stack) {
        constexpr std::size_t worth_a_device = 30'000'000; // values: opening a device takes half a second
        const auto pixels = static_cast<std::size_t>(stack.plan.columns) * static_cast<std::size_t>(stack.plan.rows);
        const auto without = [](const std::exception& reason) {
            spdlog::debug("evaluated on the host, to the same bits: {}", reason.what());
        };
        try {
            if (images * pixels >= worth_a_device && vulkan::is_hardware(device.selector)) {
                if (!*opened) {
                    *opened = std::make_shared<const vulkan::Device>(device);
                }
                return topography::device_focus_planes(*opened)(stack);
            }
        } catch (const DeviceError& none) {
            without(none);
        } catch (const RunError& failed) { // for example, too little memory
            without(failed);
        }
        return topography::make_host_focus_planes(stack);
    };
}

std::optional<Flat> read_flat(const Configuration& configuration, ImageSize pixels, double pitch) {
    const auto& file = configuration.flatness_file;
    if (file.empty()) {
        return std::nullopt;
    }
    constexpr double tolerance = 1e-3; // share of a pitch; files round theirs
    auto flat = surface::read_surface(file).map;
    if (flat.columns() != pixels.columns || flat.rows() != pixels.rows ||
        std::abs(flat.pitch_x - pitch) > tolerance * pitch || std::abs(flat.pitch_y - pitch) > tolerance * pitch) {
        throw InputError({configuration.places.at("topography.flatness_file"), "topography.flatness_file",
                          fmt::format("{}: {} x {} points, {:.6g} x {:.6g} um apart", file.string(), flat.columns(),
                                      flat.rows(), flat.pitch_x * um_per_mm, flat.pitch_y * um_per_mm),
                          fmt::format("the stack's grid, {} x {} points, {:.6g} um apart", pixels.columns, pixels.rows,
                                      pitch * um_per_mm),
                          "Measure the flat with the same instrument."});
    }
    // The polynomial is unknown where the flat was not measured.
    constexpr double least_share = 0.9;
    const double measured = surface::height_parameters(flat).measured_share;
    if (!(measured >= least_share)) {
        throw InputError(
            {configuration.places.at("topography.flatness_file"), "topography.flatness_file",
             fmt::format("{}: {:.0f} % of the points measured", file.string(), 100 * measured),
             fmt::format("at least {:.0f} %", 100 * least_share),
             "Give the flat texture and light enough to be measured, and scan as far as the field curves."});
    }
    const double band = configuration.band.s_filter;
    const double s_filter = band > 0 ? band : configuration.topography.window_px * pitch;
    const double deviation = topography::flatness_deviation(flat, s_filter);
    return Flat{.file = file, .heights = std::move(flat), .deviation = deviation, .s_filter = s_filter};
}

StackEvaluation::StackEvaluation(const topography::TopographyOptions& options, topography::FocusPlanesMaker make_planes,
                                 std::optional<optics::Diffraction> diffraction, int images)
    : evaluator_(options, make_planes, curve_grid(images)), diffraction_(std::move(diffraction)) {
    evaluation_.options = options;
    if (images > 0) {
        frames_.emplace(images);
    }
    if (diffraction_) {
        diffracted_ = std::make_unique<StackEvaluation>(options, std::move(make_planes), std::nullopt, images);
        diffracted_->frames_.reset(); // the report's images are those without diffraction
    }
}

void StackEvaluation::add(topography::Channels image, double z, std::optional<double> reading) {
    const Stopwatch stopwatch(evaluation_.seconds);
    if (frames_ && columns_ == 0) {
        spdlog::info("focus is measured by {}", name_of(evaluation_.options.focus_measure.value()));
    }
    if (!image.empty()) {
        columns_ = image.front().columns;
        rows_ = image.front().rows;
    }
    if (frames_ && !image.empty()) {
        frames_->add(image.size() == 1 ? image.front() : topography::grey(image), z);
    }
    if (diffraction_) {
        diffracted_->add({diffraction_->apply(image.front())}, z, reading);
    }
    evaluator_.add(std::move(image), z, reading);
}

void StackEvaluation::reconstruct(double x0, double y0, double pitch, const KnownErrors& errors) {
    auto frames = std::async(std::launch::async, [&] { return frames_ ? frames_->finish() : report::Frames(); });
    evaluation_.topography = evaluator_.finish(x0, y0, pitch);
    auto noise = std::async(std::launch::async, [&] { return median_of(evaluation_.topography.height_noise); });
    if (const auto& flat = errors.flat) {
        auto corrected = topography::correct_flatness(std::move(evaluation_.topography.height), flat->heights);
        evaluation_.topography.height = std::move(corrected.heights);
        evaluation_.flatness = {.file = flat->file,
                                .deviation = flat->deviation,
                                .s_filter = flat->s_filter,
                                .polynomial_peak_to_valley = corrected.polynomial_peak_to_valley};
    } else if (const auto& design = errors.design) {
        evaluation_.field_curvature =
            topography::add_curvature(evaluation_.topography.height_uncertainty, evaluation_.topography.height,
                                      [&](double x, double y) { return -design->height(x, y); });
    }
    if (errors.hidden_uncertainty > 0) {
        for (double& uncertainty : evaluation_.topography.height_uncertainty.values) {
            uncertainty = std::hypot(uncertainty, errors.hidden_uncertainty);
        }
    }
    evaluation_.height_uncertainty = median_of(evaluation_.topography.height_uncertainty);
    evaluation_.height_noise = noise.get();
    evaluation_.frames = frames.get();
}

Evaluation StackEvaluation::finish(KnownTruth known, const topography::Band& band, const KnownErrors& errors,
                                   const std::optional<dimensions::Feature>& feature) {
    if (diffracted_) {
        evaluation_.diffracted = std::make_shared<Evaluation>(diffracted_->finish(known, band, errors, feature));
    }
    surface::HeightMap& truth = known.heights;
    {
        const Stopwatch stopwatch(evaluation_.seconds);
        reconstruct(truth.x0, truth.y0, truth.pitch_x, errors);
        const auto& measured = evaluation_.topography.height;
        auto& levelled = evaluation_.levelled;
        auto whole_truth = std::async(std::launch::async, [&] { return surface::remove_form(truth, band.form); });
        levelled.pair = topography::levelled_pair(measured, truth, {.form = band.form});
        const auto& deviation = levelled.deviation.emplace(topography::deviation_map(levelled.pair));
        auto beyond = std::async(std::launch::async, [&] {
            return topography::share_beyond(deviation, evaluation_.topography.height_uncertainty, coverage_factor);
        });
        evaluation_.deviation = topography::compare(levelled.pair, deviation);
        evaluation_.beyond_uncertainty = beyond.get();
        levelled.truth = whole_truth.get();
        evaluation_.band = band;
        if (band.limited()) {
            evaluation_.filtered = topography::compared_pair(measured, truth, band);
        }
        if (feature) {
            evaluation_.dimensions = standard_dimensions(
                *feature, measured, known.undistorted,
                FocusEffects{.pull = &evaluation_.topography.brightness_pull,
                             .window = {evaluation_.options.window_px, evaluation_.options.window_shape}});
            if (errors.hidden_uncertainty > 0) {
                for (auto& dimension : evaluation_.dimensions) {
                    dimension.measured.standard_error = surface::undefined;
                }
            }
        }
        evaluation_.truth = std::move(truth);
        evaluation_.mapping = known.mapping;
    }
    return std::move(evaluation_);
}

Evaluation StackEvaluation::finish(double pitch, const surface::Form& form, const KnownErrors& errors) {
    evaluation_.band.form = form;
    {
        const Stopwatch stopwatch(evaluation_.seconds);
        const auto grid = PixelGrid::centred(columns_, rows_, pitch);
        reconstruct(grid.x0, grid.y0, pitch, errors);
        evaluation_.levelled.pair.measured = surface::remove_form(evaluation_.topography.height, form);
    }
    return std::move(evaluation_);
}

Verdict verdict_of(const Evaluation& evaluation) {
    constexpr double nearly_all = 0.9;
    const double measured = surface::height_parameters(evaluation.topography.height).measured_share;
    Verdict verdict{.measurable = measured >= nearly_all ? Verdict::Measurable::yes
                                  : measured > 0         ? Verdict::Measurable::partly
                                                         : Verdict::Measurable::no,
                    .sentences = {measured_text(measured)}};
    for (const std::string& reason : reasons_of(evaluation)) {
        verdict.sentences.push_back(reason);
    }
    if (std::string chance = chance_text(evaluation); !chance.empty()) {
        verdict.sentences.push_back(std::move(chance));
    }
    if (measured > 0) {
        verdict.sentences.push_back(uncertainty_text(evaluation));
    }
    return verdict;
}

std::string summary(const Evaluation& evaluation) {
    const double measured = surface::height_parameters(evaluation.topography.height).measured_share;
    std::string text = measured_text(measured) + "\n";
    for (const std::string& reason : reasons_of(evaluation)) {
        text += "  " + reason + "\n";
    }
    if (const std::string chance = chance_text(evaluation); !chance.empty()) {
        text += chance + "\n";
    }
    if (!(measured > 0)) {
        return text;
    }
    if (evaluation.flatness) {
        text +=
            fmt::format("field curvature removed by the flat: a polynomial of {:.3g} um peak to valley; z_FLT of the "
                        "flat is {:.3g} um (S-filter {:g} um)\n",
                        evaluation.flatness->polynomial_peak_to_valley * um_per_mm,
                        evaluation.flatness->deviation * um_per_mm, evaluation.flatness->s_filter * um_per_mm);
    }
    constexpr double worth_a_flat = 0.5; // share of the uncertainty; a smaller curvature does not matter
    if (evaluation.field_curvature && *evaluation.field_curvature > worth_a_flat * evaluation.height_uncertainty) {
        text +=
            fmt::format("the field is curved by {:.3g} um peak to valley, by the instrument's design: the heights hold "
                        "this, and their uncertainty counts it. A flat takes it off (topography.flatness_file)\n",
                        *evaluation.field_curvature * um_per_mm);
    }
    if (evaluation.deviation) {
        text +=
            text_of(evaluation.band.form == surface::Form() ? "levelled:"
                                                            : ("form " + form_name(evaluation.band.form) + ":").c_str(),
                    *evaluation.deviation);
    }
    text += uncertainty_text(evaluation) + "\n";
    if (evaluation.filtered) {
        text += text_of(band_text(evaluation.band).c_str(), evaluation.filtered->deviation);
    }
    text += dimensions_text(evaluation.dimensions);
    if (evaluation.diffracted) {
        text += "with diffraction: " + summary(*evaluation.diffracted);
    }
    return text;
}

} // namespace vkfv::measurement
