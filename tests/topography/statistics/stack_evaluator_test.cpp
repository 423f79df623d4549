#include "topography/topography.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "topography/compare.hpp"
#include "topography/peak_method.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

// A focus stack made without any optics of vkfv: a random texture in which every point of height h is spread,
// in the image at z, by a Gaussian of standard deviation 0.2 |z - h|; Poisson noise from `counts` counts a
// pixel.
struct SyntheticStack {
    std::vector<Grid<float>> images;
    std::vector<double> z;
    HeightMap truth;
};

constexpr int pixels = 48;
constexpr double pitch = 0.002;
constexpr double amplitude = 0.0025;

SyntheticStack make_stack(double counts, unsigned seed) {
    constexpr int images = 31;
    constexpr double step = 0.0008;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    SyntheticStack stack;
    stack.truth = {.height = Grid<double>(pixels, pixels), .x0 = 0.01, .y0 = -0.02, .pitch_x = pitch, .pitch_y = pitch};
    Grid<double> texture(pixels, pixels);
    for (int j = 0; j < pixels; ++j)
        for (int i = 0; i < pixels; ++i) {
            // Waves have whole periods either way, so that mirror images are opposite and the transposed is orthogonal.
            stack.truth.height(i, j) = amplitude * std::sin(2 * pi * i / 48.0) * std::cos(2 * pi * (j - 5.5) / 24.0);
            texture(i, j) = std::max(0.05, 1 + 0.3 * normal(random));
        }
    for (int k = 0; k < images; ++k) {
        const double z = (k - (images - 1) / 2.0) * step;
        Grid<double> blurred(pixels, pixels);
        for (int j = 0; j < pixels; ++j)
            for (int i = 0; i < pixels; ++i) {
                // The blur is 0.3 pixels at focus: the pixel's own width.
                const double sigma = std::hypot(0.3, 0.2 * std::abs(z - stack.truth.height(i, j)) / pitch);
                const int radius = static_cast<int>(std::ceil(3 * sigma));
                std::vector<double> weights;
                for (int d = -radius; d <= radius; ++d)
                    weights.push_back(std::exp(-0.5 * d * d / (sigma * sigma)));
                const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
                for (int dj = -radius; dj <= radius; ++dj)
                    for (int di = -radius; di <= radius; ++di)
                        // Light past the border stays on it: no border pixel is darker for want of texture.
                        blurred(std::clamp(i + di, 0, pixels - 1), std::clamp(j + dj, 0, pixels - 1)) +=
                            texture(i, j) * weights[static_cast<std::size_t>(di + radius)] *
                            weights[static_cast<std::size_t>(dj + radius)] / (total * total);
            }
        Grid<float> image(pixels, pixels);
        for (std::size_t p = 0; p < image.values.size(); ++p)
            image.values[p] = static_cast<float>(std::poisson_distribution<int>(counts * blurred.values[p])(random));
        stack.images.push_back(std::move(image));
        stack.z.push_back(z);
    }
    return stack;
}

Topography evaluate(const SyntheticStack& stack, const TopographyOptions& options = {}) {
    return reconstruct(stack.images, stack.z, stack.truth.x0, stack.truth.y0, pitch, options);
}

TEST(Reconstruct, FindsTheHeightsOfASyntheticStack) {
    const SyntheticStack stack = make_stack(300, 1);
    for (const std::string& measure : focus_measure_names()) {
        const Topography topography = evaluate(stack, {.focus_measure = focus_measure_from_name(measure)});
        EXPECT_EQ(topography.height.x0, stack.truth.x0);
        EXPECT_EQ(topography.height.pitch_y, pitch);
        const Deviation deviation = compare(topography.height, stack.truth);
        // Magnitudes let the second maximum count that light from beside brings where the surface is steepest: 48 of
        // the 2304 points have one above most_rival.
        const bool gathers_magnitudes_of_gradients = measure == "gradient-and-curvature";
        EXPECT_GT(deviation.measured_share, gathers_magnitudes_of_gradients ? 0.975 : 0.98) << measure;
        EXPECT_GT(deviation.correlation, 0.95) << measure;
        // The window averages the heights over 14 um of waves of 96 and 48 um: sinc(14/96) sinc(14/48) = 0.84
        // for a focus measure with equal weights, nearer 1 as sharp pixels weigh more.
        EXPECT_GT(deviation.sq_measured / deviation.sq_true, 0.8) << measure;
        EXPECT_LT(deviation.sq_measured / deviation.sq_true, 1.1) << measure;
        // Correlation, ratio and deviation are bound by the law of cosines.
        const double ratio = deviation.sq_measured / deviation.sq_true;
        EXPECT_NEAR(deviation.rms / deviation.sq_true, std::sqrt(1 + ratio * ratio - 2 * deviation.correlation * ratio),
                    1e-9)
            << measure;
        RecordProperty(measure + "_correlation", std::to_string(deviation.correlation));
        RecordProperty(measure + "_sq_ratio", std::to_string(deviation.sq_measured / deviation.sq_true));
        RecordProperty(measure + "_rms_um", std::to_string(deviation.rms * um_per_mm));
    }
}

TEST(Reconstruct, HeightsAreNotMirroredOrTransposed) {
    const SyntheticStack stack = make_stack(300, 2);
    const HeightMap height = evaluate(stack).height;
    HeightMap mirrored_x = stack.truth, mirrored_y = stack.truth, transposed = stack.truth, negative = stack.truth;
    for (int j = 0; j < pixels; ++j)
        for (int i = 0; i < pixels; ++i) {
            mirrored_x.height(i, j) = stack.truth.height(pixels - 1 - i, j);
            mirrored_y.height(i, j) = stack.truth.height(i, pixels - 1 - j);
            transposed.height(i, j) = stack.truth.height(j, i);
            negative.height(i, j) = -stack.truth.height(i, j);
        }
    EXPECT_GT(compare(height, stack.truth).correlation, 0.95);
    // The truth correlates with its transposed by 0 and with the others by less than -0.99.
    for (const HeightMap& twin : {mirrored_x, mirrored_y, transposed, negative})
        EXPECT_LT(compare(height, twin).correlation, 0.3);
}

TEST(Reconstruct, HeightsFromShuffledFramesDoNotCorrelateWithTheTruth) {
    // The limits are off, which would leave no heights. One shuffle maps heights to other heights by chance, with a
    // correlation of some 0.5: the mean over 100 shuffles is 0 to 0.5 / sqrt(100) = 0.05, and 0.1 is two of these. The
    // seed is fixed.
    SyntheticStack stack = make_stack(300, 3);
    std::mt19937 random(1);
    double sum = 0;
    int compared = 0;
    constexpr int shuffles = 100;
    for (int k = 0; k < shuffles; ++k) {
        std::shuffle(stack.images.begin(), stack.images.end(), random);
        const Deviation deviation =
            compare(evaluate(stack, {.smoothing_steps = 3, .false_peak_rate = 1, .most_rival = 1}).height, stack.truth);
        if (std::isfinite(deviation.correlation)) {
            sum += deviation.correlation;
            ++compared;
        }
    }
    EXPECT_GT(compared, shuffles / 2) << "without heights nothing is compared";
    EXPECT_LT(std::abs(sum / compared), 0.1);
}

TEST(Reconstruct, NoiseWithoutTextureIsNotMeasured) {
    SyntheticStack stack = make_stack(300, 4);
    std::mt19937 random(40);
    std::poisson_distribution<int> poisson(300);
    for (auto& image : stack.images)
        for (float& value : image.values)
            value = static_cast<float>(poisson(random));
    const auto measured = [&](FocusMeasure measure, double smoothing_steps, double rate) {
        const auto topography =
            evaluate(stack, {.focus_measure = measure, .smoothing_steps = smoothing_steps, .false_peak_rate = rate});
        return std::count_if(topography.height.height.values.begin(), topography.height.height.values.end(),
                             [](double z) { return std::isfinite(z); });
    };
    // At a rate of at most 1e-3, 2.3 of 2304 pixels pass; neighbouring windows share pixels, so that false peaks come
    // in groups of some ten: 1 % is two groups.
    for (const std::string& measure : focus_measure_names())
        for (const double smoothing_steps : {0.0, 3.0})
            EXPECT_LE(measured(focus_measure_from_name(measure), smoothing_steps, 1e-3), pixels * pixels / 100)
                << measure;
    // The wrong twin: without the test for significance many of the same pixels get a height.
    EXPECT_GT(measured(FocusMeasure::modified_laplacian, 0, 1), pixels * pixels / 10);
}

TEST(Reconstruct, PeaksBeyondTheScanAreNotMeasured) {
    const SyntheticStack stack = make_stack(300, 5);
    // The scan has only images from 3 um above the highest point on.
    std::vector<Grid<float>> images;
    std::vector<double> z;
    for (std::size_t k = 0; k < stack.z.size(); ++k)
        if (stack.z[k] > amplitude + 0.003) {
            images.push_back(stack.images[k]);
            z.push_back(stack.z[k]);
        }
    ASSERT_GE(images.size(), 5u);
    const Topography topography = reconstruct(images, z, 0, 0, pitch, {.smoothing_steps = 1});
    const auto measured = std::count_if(topography.height.height.values.begin(), topography.height.height.values.end(),
                                        [](double h) { return std::isfinite(h); });
    EXPECT_LT(measured, pixels * pixels / 50);
}

// A stack whose texture of standard deviation `contrast`, beside noise of 1, is in focus at image `at` everywhere, and
// fades as a Gaussian of standard deviation `depth` images.
SyntheticStack level_stack(int images, double at, double depth, double contrast) {
    constexpr double brightness = 100;
    std::mt19937 random(17);
    std::normal_distribution<double> normal;
    Grid<double> texture(pixels, pixels);
    for (double& value : texture.values)
        value = contrast * normal(random);
    SyntheticStack stack;
    for (int k = 0; k < images; ++k) {
        Grid<float> image(pixels, pixels);
        const double share = std::exp(-0.5 * std::pow((k - at) / depth, 2));
        for (std::size_t p = 0; p < image.values.size(); ++p)
            image.values[p] = static_cast<float>(brightness + share * texture.values[p] + normal(random));
        stack.images.push_back(std::move(image));
        stack.z.push_back(k); // heights in images
    }
    return stack;
}

struct MeanHeight {
    double mean = 0;
    double measured_share = 0;
};

MeanHeight mean_height(const Topography& topography) {
    MeanHeight result;
    for (const double height : topography.height.height.values)
        if (std::isfinite(height)) {
            result.mean += height;
            result.measured_share += 1;
        }
    result.mean /= result.measured_share;
    result.measured_share /= static_cast<double>(topography.height.height.values.size());
    return result;
}

// The averages have more noise at the ends of the scan, whose energy must not outweigh texture in its middle.
TEST(Reconstruct, TextureWeakerThanTheNoiseIsMeasuredInTheMiddleOfALongScan) {
    for (const auto measure : {FocusMeasure::modified_laplacian, FocusMeasure::wavelet}) {
        const auto found = mean_height(evaluate(level_stack(61, 30.4, 6, 0.8), {.focus_measure = measure}));
        EXPECT_GT(found.measured_share, 0.9) << name_of(measure);
        EXPECT_NEAR(found.mean, 30.4, 0.3) << name_of(measure);
    }
}

// The means at the ends stand for places further inside, and blunt a curve less: uncorrected, that would shift heights
// by up to 0.9 and 0.2 images in the first two cases. Every peak method is corrected for the places that it finds
// itself.
TEST(Reconstruct, HeightsNearAnEndAreThoseOfTheMiddle) {
    const auto height = [](const SyntheticStack& stack, const std::string& method) {
        const auto found = mean_height(evaluate(stack, {.focus_measure = FocusMeasure::modified_laplacian,
                                                        .peak = peak_method_from_name(method),
                                                        .smoothing_steps = 3}));
        EXPECT_GT(found.measured_share, 0.99);
        return found.mean;
    };
    const std::vector<std::pair<double, double>> most = {{6, 0.15}, {9, 0.06}, {12, 0.05}, {18, 0.02}};
    for (const auto& [from_end, bias] : most) {
        EXPECT_NEAR(height(level_stack(41, from_end, 5, 10), "gaussian"), from_end, bias);
        const auto above = level_stack(41, 40 - from_end, 5, 10);
        for (const auto& method : peak_method_names()) {
            if (from_end < 12 || method == "gaussian") {
                EXPECT_NEAR(height(above, method), 40 - from_end, method == "centre-of-gravity" ? 1.5 * bias : bias)
                    << from_end << " " << method;
            }
        }
    }
}

// Encoders that read the places of the images give the same heights; encoders that read 1.5 k + 2 give heights that
// follow, near an end too, and with readings that jitter a height is a mean.
TEST(Reconstruct, HeightsAreThoseOfTheReadings) {
    const auto stack = level_stack(41, 34, 5, 10);
    const auto by = [&](const std::function<std::optional<double>(int)>& reading) {
        StackEvaluator evaluator({.focus_measure = FocusMeasure::modified_laplacian, .smoothing_steps = 3});
        for (int k = 0; k < 41; ++k)
            evaluator.add({stack.images[static_cast<std::size_t>(k)]}, k, reading(k));
        return mean_height(evaluator.finish(0, 0, 1)).mean;
    };
    const double plain = by([](int) { return std::nullopt; });
    EXPECT_NEAR(by([](int k) { return k; }), plain, 1e-9);
    EXPECT_NEAR(by([](int k) { return 1.5 * k + 2; }), 1.5 * plain + 2, 1e-9);
    EXPECT_NEAR(by([](int k) { return k + (k % 2 == 0 ? 0.1 : -0.1); }), plain, 0.02);
    EXPECT_GT(std::abs(by([](int k) { return k < 20 ? k : k + 1; }) - plain), 0.9);
}

TEST(Reconstruct, FollowsTheScanAndNotTheUnitOfLight) {
    SyntheticStack stack = make_stack(300, 6);
    const HeightMap before = evaluate(stack).height;
    for (double& z : stack.z)
        z += 0.125;
    for (auto& image : stack.images)
        for (float& value : image.values)
            value *= 0x1p-30f; // exact
    const HeightMap after = evaluate(stack).height;
    for (std::size_t k = 0; k < before.height.values.size(); ++k) {
        EXPECT_EQ(std::isnan(before.height.values[k]), std::isnan(after.height.values[k]));
        if (!std::isnan(before.height.values[k])) {
            EXPECT_NEAR(after.height.values[k], before.height.values[k] + 0.125, 1e-15);
        }
    }
}

TEST(Reconstruct, RejectsWhatItCannotEvaluate) {
    const auto rejects = [](const TopographyOptions& options) { EXPECT_THROW(StackEvaluator{options}, InputError); };
    rejects({.window_px = 4});
    rejects({.window_px = 1});
    rejects({.peak_range_steps = 0});
    rejects({.smoothing_steps = -1});
    rejects({.smoothing_steps = not_measured});
    rejects({.false_peak_rate = 0});
    rejects({.least_contrast = -1});
    rejects({.most_fit_residual = 0});
    rejects({.most_peaks = 0});

    const Grid<float> image(8, 8, 1.0f);
    const auto stack = [&](std::vector<double> z, const Grid<float>& last) {
        StackEvaluator evaluator({});
        for (std::size_t k = 0; k < z.size(); ++k)
            evaluator.add(k + 1 == z.size() ? last : image, z[k]);
        evaluator.finish(0, 0, pitch);
    };
    EXPECT_NO_THROW(stack({0, 1, 2}, image));
    EXPECT_THROW(stack({0, 1}, image), InputError);
    EXPECT_THROW(stack({}, image), InputError);
    EXPECT_THROW(stack({0, 1, 1}, image), InputError);
    EXPECT_THROW(stack({0, 1, 2.5}, image), InputError);
    EXPECT_THROW(stack({0, 1, 2}, Grid<float>(8, 7, 1.0f)), InputError);
    EXPECT_THROW(stack({0}, Grid<float>()), InputError);
    StackEvaluator coloured({});
    coloured.add(Channels{image, image, image}, 0);
    EXPECT_THROW(coloured.add(image, 1), InputError);
    Grid<float> broken = image;
    broken(3, 3) = std::numeric_limits<float>::infinity();
    EXPECT_THROW(stack({0, 1, 2}, broken), InputError);
}

// Checks that the evaluator asks for its planes in order, and only for images that are still kept.
class WatchedPlanes final : public FocusPlanes {
  public:
    explicit WatchedPlanes(const FocusPlanesPlan& plan) : plan_(plan), planes_(make_host_focus_planes(plan)) {}
    void take(int image, Channels channels) override {
        EXPECT_EQ(image, taken_++);
        planes_->take(image, std::move(channels));
    }
    void measure(int image, std::span<const Share> shares) override {
        EXPECT_EQ(image, measured_++);
        for (const Share& share : shares) {
            EXPECT_LT(share.image, taken_);
            EXPECT_GE(share.image, taken_ - plan_.images_kept);
        }
        planes_->measure(image, shares);
    }
    void measure_alone(int image) override {
        EXPECT_EQ(image, measured_ - 1);
        EXPECT_GE(image, taken_ - plan_.images_kept);
        planes_->measure_alone(image);
    }
    void average(int image, std::span<const Share> shares) override {
        EXPECT_EQ(image, averaged_++);
        for (const Share& share : shares) {
            EXPECT_LT(share.image, measured_);
            EXPECT_GE(share.image, measured_ - plan_.curves_kept);
        }
        planes_->average(image, shares);
    }
    void average_alone(int image, std::span<const Share> shares) override {
        EXPECT_EQ(image, averaged_ - 1);
        for (const Share& share : shares) {
            EXPECT_LT(share.image, measured_);
            EXPECT_GE(share.image, measured_ - plan_.curves_kept);
        }
        planes_->average_alone(image, shares);
    }
    void measure_joint(int image, std::span<const Share> shares) override {
        EXPECT_EQ(image, averaged_ - 1);
        EXPECT_FALSE(plan_.images_averaged);
        for (const Share& share : shares) {
            EXPECT_LT(share.image, taken_);
            EXPECT_GE(share.image, taken_ - plan_.images_kept);
        }
        planes_->measure_joint(image, shares);
    }
    void gather(int image) override {
        EXPECT_EQ(image, averaged_ - 1);
        planes_->gather(image);
    }
    void follow(int image, int images) override {
        EXPECT_EQ(image, followed_++);
        EXPECT_EQ(images, averaged_);
        const int range = plan_.plan.peak_range;
        EXPECT_GE(std::max(0, image - range), averaged_ - plan_.averaged_curves_kept);
        EXPECT_GE(std::max(0, image - range), taken_ - plan_.images_kept);
        planes_->follow(image, images);
    }
    StackSummary summary() override {
        EXPECT_EQ(followed_, taken_);
        summed_up_ = true;
        return planes_->summary();
    }
    void visit_records(const RecordTask& task) override {
        EXPECT_TRUE(summed_up_);
        planes_->visit_records(task);
    }

  private:
    FocusPlanesPlan plan_;
    std::unique_ptr<FocusPlanes> planes_;
    int taken_ = 0, measured_ = 0, averaged_ = 0, followed_ = 0;
    bool summed_up_ = false;
};

TEST(Reconstruct, HoldsFewImagesHoweverLongTheStack) {
    // No plane is asked for that has left its ring, and the rings do not grow with the stack.
    std::mt19937 random(2);
    for (const int images : {3, 4, 9, 200})
        for (const double smoothing : {0.0, 0.5, 2.0})
            for (const int range : {1, 4}) {
                int kept = 0;
                StackEvaluator evaluator(
                    {.peak_range_steps = range, .smoothing_steps = smoothing, .false_peak_rate = 1},
                    [&](const FocusPlanesPlan& plan) {
                        kept = plan.images_kept + plan.curves_kept + plan.averaged_curves_kept;
                        return std::make_unique<WatchedPlanes>(plan);
                    });
                for (int k = 0; k < images; ++k) {
                    Grid<float> image(5, 4);
                    for (float& value : image.values)
                        value = 1 + static_cast<float>(random() % 100);
                    evaluator.add(image, 0.001 * k);
                }
                EXPECT_EQ(evaluator.finish(0, 0, pitch).height.columns(), 5);
                EXPECT_LE(kept, 4 * std::max(1, static_cast<int>(std::ceil(3 * smoothing))) + 4 * range + 3);
            }
}

TEST(Reconstruct, AnImageAtATimeGivesWhatTheWholeStackGives) {
    // The truth is the definition, with all curves in memory and no ring: a wrong index anywhere would show.
    const SyntheticStack stack = make_stack(300, 7);
    const TopographyOptions options{.focus_measure = FocusMeasure::standard_deviation,
                                    .peak = PeakMethod::gaussian_fit,
                                    .peak_range_steps = 2,
                                    .smoothing_steps = 0.6,
                                    .place_by_texture = false};
    const Topography streamed = evaluate(stack, options);
    const int images = static_cast<int>(stack.images.size());
    const auto weights = axial_weights(*options.smoothing_steps);
    const auto averaged = [&](const std::vector<Grid<float>>& planes, int at) {
        Grid<float> mean(pixels, pixels);
        for (const Share& share : axial_shares(weights, at, images))
            for (std::size_t p = 0; p < mean.values.size(); ++p)
                mean.values[p] += share.weight * planes[static_cast<std::size_t>(share.image)].values[p];
        return mean;
    };
    std::vector<Grid<float>> curves, smooth;
    for (int k = 0; k < images; ++k)
        curves.push_back(focus_measure({averaged(stack.images, k)}, FocusMeasure::standard_deviation,
                                       FocusWindow(options.window_px, WindowShape::box)));
    for (int k = 0; k < images; ++k)
        smooth.push_back(averaged(curves, k));
    struct Scene {
        const std::vector<Grid<float>>& curves;
        std::size_t pixel;
        double curve_value(int image) const { return curves[static_cast<std::size_t>(image)].values[pixel]; }
    };
    focus::f64::FocusPlan plan{};
    plan.peak = focus::f64::PEAK_GAUSSIAN_FIT;
    plan.peak_range = 2;
    int compared = 0;
    for (std::size_t p = 0; p < streamed.height.height.values.size(); ++p) {
        const Scene scene{smooth, p};
        int at = 0;
        for (int k = 1; k < images; ++k)
            if (scene.curve_value(k) > scene.curve_value(at))
                at = k;
        const int range = std::min({2, at, images - 1 - at});
        const auto fit = focus::f64::locate_peak(scene, plan, at, range);
        const double height = streamed.height.height.values[p];
        if (std::isnan(height))
            continue;
        ASSERT_EQ(fit.found, 1);
        // The images are scaled by a power of two; curves differ in their float32 sums' last digits, over curvatures of
        // the peak of some 0.02: 1e-5 steps of 0.8 um.
        EXPECT_NEAR(height, stack.z[0] + 0.0008 * (at + fit.offset), 1e-5 * 0.0008);
        const double place = std::clamp(at + fit.offset, 0.0, images - 1.0);
        const auto before = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(images) - 2);
        const double share = place - static_cast<double>(before);
        const double blended =
            (1 - share) * stack.images[before].values[p] + share * stack.images[before + 1].values[p];
        EXPECT_NEAR(streamed.all_in_focus[0].values[p], blended, 1e-3 * blended);
        ++compared;
    }
    EXPECT_GT(compared, pixels * pixels / 2);
}

TEST(Reconstruct, LimitsOfQualityTakePointsOut) {
    const SyntheticStack stack = make_stack(300, 8);
    const auto count = [&](const TopographyOptions& options, PointState state) {
        const Topography topography = evaluate(stack, options);
        for (std::size_t k = 0; k < topography.state.values.size(); ++k)
            EXPECT_EQ(topography.state.values[k] == PointState::measured,
                      std::isfinite(topography.height.height.values[k]));
        return std::ranges::count(topography.state.values, state);
    };
    const Topography all = evaluate(stack, {.smoothing_steps = 1, .false_peak_rate = 1, .most_rival = 1});
    // Half the points have less than the median.
    std::vector<double> contrasts = all.contrast.values, residuals = all.fit_residual.values;
    std::ranges::nth_element(contrasts, contrasts.begin() + pixels * pixels / 2);
    std::ranges::nth_element(residuals, residuals.begin() + pixels * pixels / 2);
    EXPECT_NEAR(count({.smoothing_steps = 1,
                       .false_peak_rate = 1,
                       .most_rival = 1,
                       .least_contrast = contrasts[pixels * pixels / 2]},
                      PointState::low_contrast),
                pixels * pixels / 2, pixels * pixels / 20); // some have no peak at all
    EXPECT_NEAR(count({.smoothing_steps = 1,
                       .false_peak_rate = 1,
                       .most_rival = 1,
                       .most_fit_residual = residuals[pixels * pixels / 2]},
                      PointState::poor_fit),
                pixels * pixels / 2, pixels * pixels / 20);
    EXPECT_EQ(
        count({.smoothing_steps = 1, .false_peak_rate = 1, .most_rival = 1, .most_peaks = 1}, PointState::many_peaks),
        std::ranges::count_if(all.peaks.values, [](int peaks) { return peaks > 1; }));
}

TEST(Reconstruct, RepairsOutliersOnlyWhenAsked) {
    SyntheticStack stack = make_stack(3000, 9);
    Topography topography = evaluate(stack);
    const double right = topography.height.height(20, 20);
    topography.height.height(20, 20) += 0.02;
    topography.height.height(30, 10) = not_measured;
    Topography repaired = topography;
    repair_outliers(repaired);
    EXPECT_EQ(repaired.state(20, 20), PointState::repaired);
    EXPECT_NEAR(repaired.height.height(20, 20), right, 0.001); // its neighbours' slope is 0.3 um a pixel at most
    EXPECT_TRUE(std::isnan(repaired.height.height(30, 10)));   // nothing is made up
    int changed = 0;
    for (std::size_t k = 0; k < repaired.state.values.size(); ++k) {
        const bool differs = repaired.height.height.values[k] != topography.height.height.values[k] &&
                             !std::isnan(topography.height.height.values[k]);
        EXPECT_EQ(differs, repaired.state.values[k] == PointState::repaired);
        changed += differs;
    }
    EXPECT_LT(changed, pixels * pixels / 50);
    const auto marked = [&](bool repair) {
        return std::ranges::count(evaluate(stack, {.smoothing_steps = 0, .repair_outliers = repair}).state.values,
                                  PointState::repaired);
    };
    EXPECT_EQ(marked(false), 0);
}

HeightMap wave(double scale, double offset, double tilt) {
    HeightMap map{.height = Grid<double>(60, 50), .x0 = 0, .y0 = 0, .pitch_x = pitch, .pitch_y = pitch};
    for (int j = 0; j < 50; ++j)
        for (int i = 0; i < 60; ++i)
            map.height(i, j) = scale * std::sin(2 * pi * i / 12.0) + offset + tilt * map.x(i);
    return map;
}

TEST(Compare, LevelsBothAndUsesCommonPointsOnly) {
    HeightMap measured = wave(0.9e-3, 0.3, 0.05), truth = wave(1e-3, 0, -0.02);
    for (int j = 0; j < 50; ++j)
        for (int i = 0; i < 12; ++i) // one whole period
            measured.height(i, j) = not_measured;
    truth.height(30, 20) = not_measured;
    const Deviation deviation = compare(measured, truth);
    EXPECT_NEAR(deviation.measured_share, 48.0 / 60 - 1.0 / 3000, 1e-12);
    EXPECT_NEAR(deviation.correlation, 1, 1e-12);
    EXPECT_NEAR(deviation.sq_measured / deviation.sq_true, 0.9, 1e-12);
    EXPECT_NEAR(deviation.rms / deviation.sq_true, 0.1, 1e-12);
    const HeightMap map = deviation_map(measured, truth);
    EXPECT_TRUE(std::isnan(map.height(0, 0)));
    EXPECT_TRUE(std::isnan(map.height(30, 20)));
    EXPECT_NEAR(map.height(40, 7), -0.1 * (deviation.sq_true * std::sqrt(2.0)) * std::sin(2 * pi * 40 / 12.0), 2e-5);
}

TEST(Compare, TheLFilterRemovesWhatIsLongInBoth) {
    HeightMap measured = wave(1e-3, 0, 0), truth = wave(1e-3, 0, 0);
    for (int j = 0; j < 50; ++j)
        for (int i = 0; i < 60; ++i)
            measured.height(i, j) += 3e-3 * std::cos(2 * pi * j / 50.0);
    EXPECT_LT(compare(measured, truth).correlation, 0.5);
    // At an index of 40 um the high-pass keeps 1 - 2^-(40/24)^2 = 0.85 of waves of 24 um and 1 - 2^-(40/100)^2 = 0.105
    // of those of 100 um, 0.3e-3 mm; the correlation is 0.85 / hypot(0.85, 0.31).
    EXPECT_GT(compare(measured, truth, {.s_filter = 0, .l_filter = 0.04}).correlation, 0.9);
}

TEST(Compare, TheSFilterRemovesWhatIsShortInBoth) {
    HeightMap measured = wave(0, 0, 0), truth = measured;
    for (int j = 0; j < 50; ++j)
        for (int i = 0; i < 60; ++i) {
            truth.height(i, j) = 1e-3 * std::cos(2 * pi * j / 50.0);
            measured.height(i, j) = truth.height(i, j) + (i % 2 == 0 ? 2e-3 : -2e-3);
        }
    EXPECT_LT(compare(measured, truth).correlation, 0.5);
    // At an index of 24 um the filter keeps 2^-36 of waves of two points (4 um).
    const Deviation filtered = compare(measured, truth, {.s_filter = 0.024, .l_filter = 0});
    EXPECT_GT(filtered.correlation, 0.99); // a cut-off window at the border leaves some
    EXPECT_NEAR(filtered.sq_measured / filtered.sq_true, 1, 0.01);
}

TEST(Compare, NeedsOneGridAndSaysWhenNothingIsMeasured) {
    EXPECT_THROW(compare(wave(1, 0, 0), HeightMap{}), std::invalid_argument);
    HeightMap nothing = wave(1, 0, 0);
    std::fill(nothing.height.values.begin(), nothing.height.values.end(), not_measured);
    const Deviation deviation = compare(nothing, wave(1, 0, 0));
    EXPECT_EQ(deviation.measured_share, 0);
    EXPECT_TRUE(std::isnan(deviation.correlation));
    EXPECT_TRUE(std::isnan(deviation.rms));
    EXPECT_EQ(compare(wave(0, 0.1, 0), wave(1, 0, 0)).measured_share, 1);
}

} // namespace
} // namespace vkfv::topography
