#include "core/messages/error.hpp"
#include "core/threads/parallel_rows.hpp"
#include "topography/hidden_levels.hpp"
#include "topography/noise/curve_noise.hpp"
#include "topography/places_of_maxima.hpp"
#include "topography/texture_place.hpp"
#include "topography/topography.hpp"
#include "topography/uncertainty/height_uncertainty.hpp"
#include "topography/uncertainty/texture_grain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace vkfv::topography {
namespace {

constexpr int most_peak_range_steps = 100; // 202 curves in memory
constexpr double dark = 0.01;              // share of the stack's mean brightness
constexpr int wide_places_a_side = 8;

void require(bool good, std::string key, std::string found, std::string expected, std::string remedy) {
    if (!good)
        throw InputError({.where = {},
                          .key = std::move(key),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
}

// The options' ranges are checked before anything is built from them.
const TopographyOptions& checked(const TopographyOptions& options) {
    require(options.window_px >= 3 && options.window_px % 2 == 1, "topography.window_px",
            fmt::format("{}", options.window_px), "an odd number of at least 3",
            "Give the width of the focus window in pixels.");
    require(options.peak_range_steps >= 1 && options.peak_range_steps <= most_peak_range_steps,
            "topography.peak_range_steps", fmt::format("{}", options.peak_range_steps),
            fmt::format("an integer in [1, {}]", most_peak_range_steps),
            "Give the half width of the range around the maximum in steps of the scan.");
    require(options.smoothing_steps.value_or(0) >= 0 && options.smoothing_steps.value_or(0) <= most_smoothing_steps,
            "topography.smoothing_steps", fmt::format("{}", options.smoothing_steps.value_or(0)),
            fmt::format("a number in [0, {:g}]", most_smoothing_steps),
            "Give the average's standard deviation in steps of the scan.");
    require(options.false_peak_rate > 0 && options.false_peak_rate <= 1, "topography.false_peak_rate",
            fmt::format("{}", options.false_peak_rate), "a number in (0, 1]",
            "Give the share of points that may pass by chance; 1 for no such limit.");
    require(options.most_rival > 0 && options.most_rival <= 1, "topography.most_rival",
            fmt::format("{}", options.most_rival), "a number in (0, 1]",
            "Give the second maximum's share of the largest; 1 for no such limit.");
    require(options.least_contrast >= 0, "topography.least_contrast", fmt::format("{}", options.least_contrast),
            "a number >= 0", "Give it in standard deviations of the focus curve's noise.");
    require(options.most_fit_residual > 0, "topography.most_fit_residual", fmt::format("{}", options.most_fit_residual),
            "a number > 0", "Give it as a share of the focus curve's maximum.");
    require(options.most_peaks >= 1, "topography.most_peaks", fmt::format("{}", options.most_peaks), "an integer >= 1",
            "Give how many peaks a focus curve may have.");
    return options;
}

// Standard deviation of a single image's noise over its brightness. The variances of the channels are added, as their
// energies are: that is the noise of the measure if the channels' noises agree, as after demosaicing, and an upper
// bound of it if not.
double relative_noise(double brightness, const NoiseModel& model) {
    return brightness > 0 ? std::sqrt(model.variance(brightness)) / brightness : 0;
}

// Width of the wide windows: five windows, for a fifth of the noise, but not so wide that a single step of the specimen
// would lie in most of them. 0: there is no room for a window at least twice as wide.
int wide_window(int window_px, int columns, int rows) {
    constexpr int widening = 5, most_of_the_image = 6;
    const int most = std::min(widening * window_px, std::min(columns, rows) / most_of_the_image);
    return most >= 2 * window_px ? most - (most + 1) % 2 : 0;
}

double mean_of(const Grid<float>& grid) {
    return std::accumulate(grid.values.begin(), grid.values.end(), 0.0) / static_cast<double>(grid.values.size());
}

// True if a twenty-fifth or more of the measured points, or more than twice the accepted rate, would be measured by
// chance: the others cannot be told from them. A user who sets a high rate accepts twice as much.
bool mostly_by_chance(const Topography& topography, double chance_rate, double accepted_rate) {
    const double most = std::max(0.04, 2 * accepted_rate);
    const auto& states = topography.state.values;
    const auto measured = static_cast<double>(std::ranges::count(states, PointState::measured));
    return chance_rate * static_cast<double>(states.size()) >= most * measured;
}

void leave_out_chance(Topography& topography) {
    auto& states = topography.state.values;
    for (std::size_t k = 0; k < states.size(); ++k) {
        if (states[k] == PointState::measured) {
            states[k] = PointState::by_chance;
            topography.height.height.values[k] = topography.height_noise.values[k] =
                std::numeric_limits<double>::quiet_NaN();
        }
    }
}

// Relative standard uncertainty of the width of the curves, by which maxima near an end of the scan are moved
// (places_of_maxima.hpp). The width is found from the same images: for curves three images from an end it is a tenth
// less than for the same curves in the middle of the scan. Gradients also respond to coarser texture, whose curves have
// longer flanks: for them it is a fifth less.
double width_uncertainty_of(FocusMeasure measure) {
    return measure == FocusMeasure::gradient_and_curvature ? 0.2 : 0.1;
}

// A maximum near an end of the scan, which the end moves.
struct NearEnd {
    double found = std::numeric_limits<double>::quiet_NaN(); // found place, in steps of the scan; NaN: no end moves it
    PlacesByWidth::Width width{};                            // width by this point's curve alone
};

// Mean widths of the curves within twice the window's reach, whose noise is partly independent. NaN where no end moves
// a maximum.
Grid<double> widths_around(const Grid<NearEnd>& points, int reach) {
    Grid<double> result(points.columns, points.rows, std::numeric_limits<double>::quiet_NaN());
    if (std::ranges::all_of(points.values, [](const NearEnd& point) { return std::isnan(point.found); })) {
        return result;
    }
    parallel_rows(points.columns, points.rows, [&](int from, int end) {
        struct Sum {
            double weight = 0, product = 0;
            void add(double more, double of_products) {
                weight += more;
                product += of_products;
            }
        };
        std::vector<Sum> columns(static_cast<std::size_t>(points.columns));
        for (int row = from; row < end; ++row) {
            for (int column = 0; column < points.columns; ++column) {
                Sum& sum = columns[static_cast<std::size_t>(column)] = {};
                for (int y = std::max(0, row - reach); y <= std::min(points.rows - 1, row + reach); ++y) {
                    const NearEnd& point = points(column, y);
                    sum.add(point.width.weight, point.width.weight * point.width.logarithm);
                }
            }
            for (int column = 0; column < points.columns; ++column) {
                if (std::isnan(points(column, row).found)) {
                    continue;
                }
                Sum around;
                for (int x = std::max(0, column - reach); x <= std::min(points.columns - 1, column + reach); ++x) {
                    const Sum& sum = columns[static_cast<std::size_t>(x)];
                    around.add(sum.weight, sum.product);
                }
                result(column, row) = around.weight > 0 ? around.product / around.weight : 0;
            }
        }
    });
    return result;
}

// The assumption where the probes show nothing: texture of the noise's own spectrum, which fades as the stack's curves
// do.
TextureAndNoise assumed(double gain, double curve_width) {
    TextureAndNoise result;
    result.alone = gain / 2;
    result.share = 1;
    result.bend_variance = 1; // so large that noise is little beside it
    for (int image = 0; image == 0 || image < 3 * curve_width; ++image) {
        result.energy.push_back(curve_width > 0 ? std::exp(-std::pow(image / curve_width, 2)) : 1);
        result.beside.push_back(gain);
    }
    return result;
}

// Heights by the readings at these places of the scan (in steps): averages of the readings around each, moved from the
// position of the average (`averaged`) to the place.
std::vector<double> readings_at(const std::vector<double>& places, const std::vector<AveragedPoint>& averaged,
                                const std::vector<double>& readings, const std::vector<double>& weights) {
    const auto images = static_cast<int>(readings.size());
    const double step = (readings.back() - readings.front()) / (images - 1);
    std::vector<double> result;
    for (int at = 0; at < images; ++at) {
        const auto point = static_cast<std::size_t>(at);
        const auto shares = twice_averaged(weights, at, images);
        result.push_back(std::inner_product(shares.begin(), shares.end(), readings.begin(), 0.0) +
                         step * (places[point] - averaged[point].position));
    }
    return result;
}

} // namespace

StackEvaluator::StackEvaluator(const TopographyOptions& options, FocusPlanesMaker make_planes, CurveGrid curve_grid)
    : options_(checked(options)), measure_(options.focus_measure.value_or(where_noise_counts)),
      window_(options.window_px, options.window_shape),
      axial_weights_(axial_weights(options.smoothing_steps.value_or(0))),
      neighbour_weights_(axial_weights_.size() > 1 ? axial_weights_ : std::vector<double>{1, 0.5}),
      energy_weights_(axial_weights_.size() > 1 ? axial_weights_ : std::vector<double>{1, 0.25}),
      make_planes_(std::move(make_planes)), curve_grid_(curve_grid) {}

void StackEvaluator::check(const Channels& image, double z) const {
    const std::string which = fmt::format("image {}", z_.size());
    require(!image.empty() && image[0].columns > 0 && image[0].rows > 0, which, "no pixels", "at least one pixel",
            "Check the image.");
    for (const Grid<float>& channel : image)
        require(std::all_of(channel.values.begin(), channel.values.end(), [](float v) { return std::isfinite(v); }),
                which, "a value that is not finite", "finite values", "Take or trace the image anew.");
    if (z_.empty())
        return;
    require(image[0].columns == columns_ && image[0].rows == rows_, which,
            fmt::format("{} x {} pixels", image[0].columns, image[0].rows),
            fmt::format("{} x {} as the images before", columns_, rows_), "Use images of one size only.");
    require(image.size() == channels_, which, fmt::format("{} channels", image.size()),
            fmt::format("{} as the images before", channels_), "Use images of one kind only.");
    require(z > z_.back(), which, fmt::format("z = {} mm after {} mm", z, z_.back()), "ascending z",
            "Order the images by z.");
    if (z_.size() >= 2) {
        constexpr double tolerance = 0.01; // share of a step: far below the noise of any height
        const double expected = z_[0] + static_cast<double>(z_.size()) * (z_[1] - z_[0]);
        require(std::abs(z - expected) <= tolerance * (z_[1] - z_[0]), which, fmt::format("z = {} mm", z),
                fmt::format("z = {} mm, equidistant", expected), "Use a stack with one step.");
    }
}

void StackEvaluator::begin(const Channels& first) {
    columns_ = first[0].columns;
    rows_ = first[0].rows;
    channels_ = first.size();
    double sum = 0;
    for (const Grid<float>& channel : first)
        sum = std::accumulate(channel.values.begin(), channel.values.end(), sum);
    const double mean = sum / static_cast<double>(first[0].values.size() * channels_);
    if (mean > 0)
        scale_ = std::exp2(static_cast<float>(-std::clamp(std::ilogb(mean), -100, 100)));
    const int radius = static_cast<int>(axial_weights_.size()) - 1;
    focus::f64::FocusPlan plan{};
    plan.columns = columns_;
    plan.rows = rows_;
    plan.channels = static_cast<int>(channels_);
    plan.measure = static_cast<int>(measure_);
    plan.window_radius = window_.radius();
    plan.peak = static_cast<int>(options_.peak);
    plan.peak_range = options_.peak_range_steps;
    probes_.emplace(columns_, rows_, measure_, window_);
    brightness_.emplace(columns_, rows_, options_.window_px);
    if (const int wide = wide_window(options_.window_px, columns_, rows_); wide > 0 && options_.most_rival < 1)
        wide_.emplace(columns_, rows_, measure_, FocusWindow(wide, options_.window_shape), wide_places_a_side);
    for (const int row : curve_grid_.rows_of(rows_))
        for (const int column : curve_grid_.columns_of(columns_))
            curve_pixels_.push_back(static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns_) +
                                    static_cast<std::uint32_t>(column));
    // An image is judged once the averaged curve is known over the range after it; the images around it are needed
    // until then.
    planes_ = make_planes_({.plan = plan,
                            .window = window_,
                            .images_averaged = radius > 0,
                            .images_kept = radius + neighbours() + 2 * plan.peak_range + 1,
                            .curves_kept = 2 * neighbours() + 1,
                            .averaged_curves_kept = 2 * plan.peak_range + 1,
                            .gathered_pixels = curve_pixels_});
}

void StackEvaluator::add(Channels image, double z, std::optional<double> reading) {
    check(image, z);
    if (z_.empty())
        begin(image);
    for (Grid<float>& channel : image)
        for (float& value : channel.values)
            value *= scale_;
    probes_->add(image);
    brightness_->add(image);
    if (wide_)
        wide_->add(image);
    planes_->take(static_cast<int>(z_.size()), std::move(image));
    z_.push_back(z);
    if (reading) {
        readings_.push_back(*reading);
    }
    advance(false);
}

// Takes all steps that the images at hand allow, each as soon as possible, so that no plane is needed that has left its
// ring.
void StackEvaluator::advance(bool all_taken) {
    const int radius = static_cast<int>(axial_weights_.size()) - 1;
    const int images = static_cast<int>(z_.size());
    const auto average = [&](bool all_measured) {
        while (averaged_ < (all_measured ? measured_ : measured_ - neighbours())) {
            planes_->average(averaged_, axial_shares(axial_weights_, averaged_, measured_));
            planes_->average_alone(averaged_, axial_shares(energy_weights_, averaged_, measured_));
            if (radius == 0)
                planes_->measure_joint(averaged_, axial_shares(neighbour_weights_, averaged_, measured_));
            if (curve_grid_.columns > 0 && averaged_ % curve_grid_.every == 0)
                planes_->gather(averaged_);
            ++averaged_;
            while (followed_ < averaged_ - options_.peak_range_steps) {
                planes_->follow(followed_, averaged_);
                ++followed_;
            }
        }
    };
    while (measured_ < (all_taken ? images : images - radius)) {
        planes_->measure(measured_, axial_shares(axial_weights_, measured_, images));
        planes_->measure_alone(measured_);
        ++measured_;
        average(false);
    }
    if (!all_taken)
        return;
    average(true);
    for (; followed_ < averaged_; ++followed_)
        planes_->follow(followed_, averaged_);
}

FocusCurves StackEvaluator::curves_of(const StackSummary& stack, const std::vector<focus::f64::CurveRecord>& records,
                                      const std::function<double(double)>& height_at) const {
    FocusCurves result{.columns = curve_grid_.columns_of(columns_), .rows = curve_grid_.rows_of(rows_)};
    const std::size_t points = result.columns.size() * result.rows.size();
    if (points == 0)
        return result;
    const int images = static_cast<int>(z_.size());
    for (int image = 0; image < images; image += curve_grid_.every)
        result.z.push_back(height_at(image));
    const std::size_t heights = result.z.size();
    result.values.resize(points * heights);
    result.peaks.resize(points);
    result.fits.resize(points);
    parallel_bands(static_cast<int>(result.rows.size()), 1, [&](int first, int end) {
        for (auto row = static_cast<std::size_t>(first); row < static_cast<std::size_t>(end); ++row)
            for (std::size_t column = 0; column < result.columns.size(); ++column) {
                const std::size_t point = result.index(column, row);
                std::vector<double> curve(heights);
                for (std::size_t k = 0; k < heights; ++k) {
                    const float value = stack.gathered[k * points + point];
                    curve[k] = result.values[point * heights + k] = value;
                }
                const auto& record = records[point];
                result.peaks[point] =
                    record.found != 0 ? height_at(record.at + record.offset) : std::numeric_limits<double>::quiet_NaN();
                if (record.found != 0 && curve_grid_.every == 1)
                    result.fits[point] = fit_of(options_.peak, curve, record.at, options_.peak_range_steps);
            }
    });
    return result;
}

// Figures of the stack as a whole, including the limits that a curve must exceed to be measured.
StackFigures StackEvaluator::judge_stack() const {
    const int images = static_cast<int>(z_.size());
    StackFigures figures;
    figures.smoothing_steps = options_.smoothing_steps.value_or(0);
    figures.curve_width_steps = probes_->curve_width();
    if (wide_)
        figures.rivalled_share = wide_->share_with_rival(axial_weights_, options_.most_rival);
    if (options_.false_peak_rate < 1) {
        figures.limit =
            limit_of(probes_->by_chance(axial_weights_, options_.false_peak_rate), options_.false_peak_rate, images);
    }
    if (options_.false_peak_rate < 1) {
        // Points whose windows overlap pass together: with a third of the rate, a patch of them is rare too.
        constexpr double share_of_rate = 1.0 / 3;
        const bool averaged = axial_weights_.size() > 1;
        // If even strong texture does not persist, persistence is no evidence for a point.
        constexpr double least_persistence = 0.25;
        const auto of_strong = probes_->persistence_of_strong_texture(neighbour_weights_, averaged);
        if (!of_strong || of_strong->share >= least_persistence) {
            const auto limit_by = [&](const IndependentImages& independent, double least_energy) {
                return PersistenceLimit(independent, neighbour_weights_, averaged, images,
                                        share_of_rate * options_.false_peak_rate,
                                        of_strong ? std::optional(of_strong->correlation) : std::nullopt, least_energy);
            };
            const auto independent = probes_->independent_images(neighbour_weights_, averaged);
            figures.persistence = limit_by(independent, 0);
            if (!figures.persistence.tells()) {
                figures.persistence = limit_by(independent, probes_->least_energy());
            }
        }
    }
    if (options_.false_peak_rate < 1 && images > few_images) {
        const auto curves = probes_->some_curves();
        figures.whole = mean_evidence(curves, images_in_order(images));
        figures.limit_of_whole = limit_of_stack(curves, options_.false_peak_rate);
    }
    return figures;
}

PointState StackEvaluator::judge(const focus::f64::CurveRecord& curve, const focus::f64::SingleRecord& single,
                                 const PointNoise& noise_here, const StackFigures& figures) const {
    const auto& [noise, averaging, window_share] = noise_here;
    if (curve.found == 0) {
        return PointState::no_peak;
    }
    const int images = static_cast<int>(z_.size());
    if (options_.false_peak_rate < 1 && !(figures.limit.exceeded_by(evidence(curve, single, images)) &&
                                          figures.persistence.exceeded_by(curve, window_share))) {
        return PointState::by_chance;
    }
    const double rise = curve.largest - curve.sum / images;
    if (!(rise >= options_.least_contrast * noise * averaging)) {
        return PointState::low_contrast;
    }
    if (curve.residual > options_.most_fit_residual) {
        return PointState::poor_fit;
    }
    // The prominence of the largest of many maxima of noise is the range of normal values. Averages fill the valley
    // between two maxima, single images hide it in their noise: either may show it.
    const double by_noise = 2 * noise * std::sqrt(2 * std::log(static_cast<double>(images)));
    // Where most wider windows, which have less noise, have a second maximum, a point must be able to show that it has
    // none.
    const bool hidden = figures.rivalled() && by_noise * averaging > options_.most_rival * rise;
    const bool rivalled =
        options_.most_rival < 1 &&
        (hidden || curve.rival > std::max(options_.most_rival * rise, by_noise * averaging) ||
         single.rival > std::max(options_.most_rival * focus::f64::single_rise(single, images), by_noise));
    return rivalled || focus::f64::count_peaks(curve, images) > options_.most_peaks ? PointState::many_peaks
                                                                                    : PointState::measured;
}

namespace {

// Interpolates linearly between a curve's points; at: a place, in points.
template <class ValueOf>
double between(double at, int points, const ValueOf& value_of) {
    const auto before = static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor(at)), 0, points - 2));
    const double here = value_of(before);
    return here + (at - static_cast<double>(before)) * (value_of(before + 1) - here);
}

// Maps of so many points, none of which is measured. place: their positions.
Topography nothing_measured(int columns, int rows, surface::HeightMap place) {
    Topography result;
    place.height = Grid<double>(columns, rows, std::numeric_limits<double>::quiet_NaN());
    result.height = std::move(place);
    result.contrast = result.fit_residual = Grid<double>(columns, rows);
    result.height_noise = result.height.height;
    result.peaks = Grid<std::uint16_t>(columns, rows);
    result.state = Grid<PointState>(columns, rows, PointState::measured);
    return result;
}

} // namespace

Topography StackEvaluator::finish(double x0, double y0, double pitch) {
    require(z_.size() >= 3, "stack", fmt::format("{} images", z_.size()), "at least 3 images",
            "A peak needs an image on either side: widen the scan.");
    // The probes are evaluated while the planes are finished.
    auto noise_of_probes = std::async(std::launch::async, [this] { return probes_->noise(); });
    auto correlation_of_probes = std::async(std::launch::async, [this] { return probes_->noise_correlation(); });
    auto levels_of_probes = std::async(std::launch::async, [this] { return probes_->levels(axial_weights_); });
    auto figures_of_probes = std::async(std::launch::async, [this] { return judge_stack(); });
    advance(true);
    StackSummary stack = planes_->summary();

    const int images = static_cast<int>(z_.size());
    const std::vector<AveragedPoint> points = averaged_points(axial_weights_, images);
    const double brightness = mean_of(stack.brightness) / images;
    const Grid<float> brightness_around = window_mean(stack.brightness, window_); // sum over all images
    Topography result =
        nothing_measured(columns_, rows_, {.height = {}, .x0 = x0, .y0 = y0, .pitch_x = pitch, .pitch_y = pitch});
    const NoiseModel noise_model = noise_of_probes.get();
    const NoiseCorrelation correlation = correlation_of_probes.get();
    const double gain = noise_gain(measure_, 1, correlation);
    const PeakFinder finder{.method = options_.peak, .range = options_.peak_range_steps};
    StackFigures figures = figures_of_probes.get();
    const std::vector<double> places = places_of_maxima(axial_weights_, images, figures.curve_width_steps, finder);
    const PlacesByWidth by_width(axial_weights_, images, figures.curve_width_steps, finder);
    const double step = (z_.back() - z_.front()) / (images - 1);
    const auto read =
        readings_.empty() ? std::vector<double>() : readings_at(places, points, readings_, axial_weights_);
    const auto height_at = [&](double at) {
        return read.empty() ? z_.front() + step * between(at, images, [&](std::size_t point) { return places[point]; })
                            : between(at, images, [&](std::size_t point) { return read[point]; });
    };
    Grid<NearEnd> near_ends(columns_, rows_);
    const double whole_window =
        window_.pixels(4 * window_.radius(), 4 * window_.radius(), 2 * window_.radius(), 2 * window_.radius());
    const auto found = probes_->texture_and_noise(axial_weights_, noise_model, correlation);
    const CurveNoise curve_noise(found.value_or(assumed(gain * gain / whole_window, figures.curve_width_steps)),
                                 axial_weights_, finder, images);
    std::vector<focus::f64::CurveRecord> of_curves(curve_pixels_.size());
    const auto judge_point = [&](std::size_t pixel, const focus::f64::CurveRecord& curve,
                                 const focus::f64::SingleRecord& single) {
        const int row = static_cast<int>(pixel / static_cast<std::size_t>(columns_));
        const int column = static_cast<int>(pixel % static_cast<std::size_t>(columns_));
        const double pixels = window_.pixels(columns_, rows_, column, row);
        const double averaging = std::sqrt(points[static_cast<std::size_t>(curve.at)].variance);
        const double here = brightness_around(column, row) / images;
        // The noise of a single image's measure.
        const double image_noise = relative_noise(here, noise_model) * gain / std::sqrt(pixels);
        const double rise = curve.largest - curve.sum / images;
        result.contrast(column, row) = rise / (image_noise * averaging);
        result.fit_residual(column, row) = curve.residual;
        if (const auto place = std::ranges::lower_bound(curve_pixels_, pixel);
            place != curve_pixels_.end() && *place == pixel) {
            of_curves[static_cast<std::size_t>(place - curve_pixels_.begin())] = curve;
        }
        result.peaks(column, row) = static_cast<std::uint16_t>(focus::f64::count_peaks(curve, images));
        PointState& state = result.state(column, row);
        state = here > dark * brightness
                    ? judge(curve, single, {image_noise, averaging, pixels / whole_window}, figures)
                    : PointState::dark;
        if (state == PointState::measured) {
            const double found = curve.at + curve.offset;
            result.height.height(column, row) = height_at(found);
            if (by_width.feels_an_end(found)) {
                const double bend = curve.largest > 0 ? curve.bend / curve.largest : 0;
                near_ends(column, row) = {
                    .found = found,
                    .width = by_width.width(curve.at, curve.offset, curvature_at_maximum(bend, curve.offset))};
            }
            result.height_noise(column, row) =
                step * curve_noise.place(curve, std::pow(relative_noise(here, noise_model), 2), pixels / whole_window);
        }
    };
    planes_->visit_records(judge_point);
    // Heights near an end are corrected by the width of the curves around them, whose uncertainty gives that of the
    // height.
    const Grid<double> widths = widths_around(near_ends, 2 * window_.radius());
    Grid<double> end_uncertainty(columns_, rows_);
    const double wider = std::log(1 + width_uncertainty_of(measure_));
    const double step_of_heights = readings_.empty() ? step : (readings_.back() - readings_.front()) / (images - 1);
    for (std::size_t pixel = 0; pixel < widths.values.size(); ++pixel) {
        if (const double width = widths.values[pixel]; !std::isnan(width)) {
            const double found = near_ends.values[pixel].found, place = by_width.place(found, width);
            result.height.height.values[pixel] +=
                step_of_heights * (place - between(found, images, [&](std::size_t point) { return places[point]; }));
            end_uncertainty.values[pixel] = step_of_heights * (by_width.place(found, width + wider) - place);
        }
    }
    const auto freed = std::async(std::launch::async, [planes = std::move(planes_)]() mutable { planes.reset(); });
    result.curves = curves_of(stack, of_curves, height_at);
    for (std::size_t point = 0; point < curve_pixels_.size() && point < result.curves.peaks.size(); ++point) {
        if (const std::size_t pixel = curve_pixels_[point]; !std::isnan(widths.values[pixel])) {
            result.curves.peaks[point] = result.height.height.values[pixel];
        }
    }
    for (Grid<float>& channel : stack.all_in_focus)
        for (float& value : channel.values)
            value /= scale_;
    result.all_in_focus = std::move(stack.all_in_focus);
    const double rate = options_.false_peak_rate;
    if (rate < 1 && images > few_images &&
        (mostly_by_chance(result, std::max(rate, figures.limit.rate), rate) ||
         !figures.limit_of_whole.exceeded_by(figures.whole)))
        leave_out_chance(result);
    if (options_.place_by_texture)
        place_by_texture(result.height.height, result.all_in_focus, measure_, window_);
    if (options_.repair_outliers)
        repair_outliers(result);
    result.height_uncertainty =
        height_uncertainty(result.height.height, result.height_noise, options_.window_px, options_.window_shape,
                           grain_correlation(result.all_in_focus, measure_, window_));
    const HiddenLevels levels(levels_of_probes.get(), result.height.height, step, window_.radius());
    Grid<double> heights_in_steps = result.height.height;
    for (double& height : heights_in_steps.values) {
        height = (height - z_.front()) / step;
    }
    const double width = figures.curve_width_steps; // 0 of curves without a form
    result.brightness_pull = brightness_->pull(
        heights_in_steps, width > 0 ? std::hypot(width, figures.smoothing_steps) : 0, step_of_heights);
    double measured_pixels = 0;
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            const double pull = result.brightness_pull.at(column, row);
            double& uncertainty = result.height_uncertainty(column, row);
            uncertainty = std::sqrt(uncertainty * uncertainty + std::pow(end_uncertainty(column, row), 2) +
                                    levels.variance(column, row) + pull * pull);
            if (std::isfinite(result.height.height(column, row))) {
                measured_pixels += 1;
                figures.brightness_pull += pull * pull;
            }
        }
    }
    figures.brightness_pull = measured_pixels > 0 ? std::sqrt(figures.brightness_pull / measured_pixels) : 0;
    figures.hidden_relief = levels.mean_deviation();
    figures.image_noise = relative_noise(brightness, noise_model);
    figures.noise_correlation = correlation;
    result.stack = figures;
    return result;
}

Topography reconstruct(std::span<const Grid<float>> stack, std::span<const double> z, double x0, double y0,
                       double pitch, const TopographyOptions& options) {
    if (stack.size() != z.size())
        throw std::invalid_argument("reconstruct: as many heights as images are needed");
    TopographyOptions settled = options;
    if (!stack.empty() && !settled.settled()) {
        FocusProbes probes(stack[0].columns, stack[0].rows, options.focus_measure.value_or(where_noise_is_low),
                           FocusWindow(options.window_px, options.window_shape));
        for (const auto& image : stack) {
            probes.add({image});
        }
        probes.settle(settled);
    }
    StackEvaluator evaluator(settled);
    for (std::size_t k = 0; k < stack.size(); ++k)
        evaluator.add(stack[k], z[k]);
    return evaluator.finish(x0, y0, pitch);
}

} // namespace vkfv::topography
