#include "measurement/judgement/expectation.hpp"

#include "camera/camera.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/image/camera_images.hpp"
#include "measurement/image/exposure.hpp"
#include "measurement/judgement/slopes.hpp"
#include "measurement/scene/assembly.hpp"
#include "optics/instrument/image_quality.hpp"
#include "specimen/description.hpp"
#include "surface/filter.hpp"
#include "topography/axial_average.hpp"
#include "topography/noise/noise_gain.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/interface/traced_instrument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace vkfv::measurement {

namespace {

constexpr int least_sample_side = 36, most_sample_side = 48;             // pixels
constexpr std::uint64_t fewest_sample_rays = 32, most_sample_rays = 256; // for each pixel
constexpr std::uint64_t rays_of_sample = 50'000; // at each of two heights, half a second on two cores
constexpr std::uint64_t rays_of_forward_probe = 100'000;

struct Sample {
    trace::Image image;
    trace::Image defocused; // the focal plane is higher by `defocus`, mm
    double defocus = 0;
    std::vector<bool> in_focus; // whether a pixel's surface is within the focus
    double rays_per_pixel = 0;
    double pitch = 0;
};

double rays_per_pixel_of(const Configuration& configuration) {
    return static_cast<double>(trace::launched_rays(configuration.trace, configuration.instrument)) /
           static_cast<double>(configuration.instrument.detector_pixels.count());
}

// The configuration with the middle of its detector alone, traced backward on the host.
Configuration sampled(const Configuration& configuration) {
    Configuration part = configuration;
    auto& instrument = part.instrument;
    const ImageSize whole = instrument.detector_pixels;
    const int side = std::clamp(3 * configuration.topography.window_px, least_sample_side, most_sample_side);
    const auto affordable = rays_of_sample / static_cast<std::uint64_t>(side * side);
    const bool backward = configuration.trace.estimator == trace::Estimator::backward;
    const auto wanted =
        backward ? static_cast<std::uint64_t>(std::llround(rays_per_pixel_of(configuration))) : most_sample_rays;
    const auto each = std::clamp(std::min(wanted, affordable), fewest_sample_rays, most_sample_rays);
    instrument.detector_pixels = {.columns = std::min(whole.columns, side), .rows = std::min(whole.rows, side)};
    instrument.detector_width *= static_cast<double>(instrument.detector_pixels.columns) / whole.columns;
    instrument.turned = true;
    instrument.single_scatter = false;
    part.trace.estimator = trace::Estimator::backward;
    part.trace.directed_scatter = false;
    part.trace.waves.reset();
    part.trace.device = "host";
    part.trace.rays = each * instrument.detector_pixels.count();
    return part;
}

std::optional<Sample> sample_of(const Configuration& configuration, const specimen::Specimen& specimen,
                                double curve_deviation) {
    if (configuration.trace.nonsequential) {
        return std::nullopt;
    }
    const Configuration part = sampled(configuration);
    const ImageSize pixels = part.instrument.detector_pixels;
    Sample sample;
    try {
        sample.pitch = assemble_for_figures(part).first_order.pixel_pitch;
        const auto grid = PixelGrid::centred(pixels, sample.pitch);
        const auto truth =
            specimen::truth(specimen, pixels.columns, pixels.rows, grid.x0, grid.y0, grid.pitch_x, grid.pitch_y);
        std::vector<double> heights;
        std::ranges::copy_if(truth.height.values, std::back_inserter(heights),
                             [](double height) { return std::isfinite(height); });
        if (heights.empty()) {
            return std::nullopt;
        }
        const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
        std::ranges::nth_element(heights, middle);
        const double height = *middle;
        constexpr double share_of_deviation = 0.5; // texture is above noise there, and below its maximum
        sample.defocus = share_of_deviation * curve_deviation;
        const std::array heights_of_focus = {height, height + sample.defocus};
        const auto instrument = assemble_silently(part, specimen, heights_of_focus);
        const auto tracer = trace::make_host_tracer(instrument, specimen, part.trace);
        sample.image = tracer->expose(heights_of_focus[0], 0);
        sample.defocused = tracer->expose(heights_of_focus[1], 1);
        sample.rays_per_pixel = static_cast<double>(sample.image.rays) / static_cast<double>(pixels.count());
        for (const double one : truth.height.values) {
            sample.in_focus.push_back(std::abs(one - height) <= 0.5 * curve_deviation);
        }
    } catch (const InputError&) { // light cannot be traced backward
        return std::nullopt;
    }
    return sample;
}

double mean_where(const Grid<double>& values, const std::vector<bool>& chosen, double power = 1) {
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < values.values.size(); ++k) {
        if (chosen[k] && std::isfinite(values.values[k])) {
            sum += std::pow(values.values[k], power);
            count += 1;
        }
    }
    return count > 0 ? sum / count : Expectation::unknown;
}

// The blur that images have before their noise counts, for an image of this many pixels; none: the light is not
// blurred.
std::optional<optics::Diffraction> blur_of(const Configuration& configuration, const optics::Instrument& instrument,
                                           ImageSize pixels) {
    if (!configuration.trace.waves && !(configuration.camera && configuration.diffraction.airy)) {
        return std::nullopt;
    }
    return optics::Diffraction(
        optics::AiryPattern(instrument.first_order.numerical_aperture, configuration.instrument.spectrum),
        pixels.columns, pixels.rows, instrument.first_order.pixel_pitch);
}

// Light of mean 1 whose pixels have independent noise of this standard deviation.
Grid<float> noise_image(ImageSize pixels, double share) {
    std::mt19937 random(1); // the same numbers everywhere
    Grid<float> image(pixels.columns, pixels.rows);
    for (float& value : image.values) {
        double sum = 0; // sum of twelve uniform numbers, normal but for its farthest tails
        for (int k = 0; k < 12; ++k) {
            sum += static_cast<double>(random()) / 4294967296.0;
        }
        value = static_cast<float>(1 + share * (sum - 6));
    }
    return image;
}

// The focus measure of noise whose variance is 1 over the brightness, after the blur: N_1 and g^2 of the header.
struct NoiseOfMeasure {
    double energy = 0;
    double gain_square = 0;
    double grain = 1; // number of pixels that share the measure's response to noise
    double kept = 1;  // share of the pixels' variance left by the blur
};

// blurred: the noise is of the light, so that the blur acts on it; otherwise it comes after the blur, as a camera's.
NoiseOfMeasure noise_of(const topography::TopographyOptions& options, const Configuration& configuration,
                        const optics::Instrument& instrument, bool blurred) {
    constexpr double share = 0.05;
    constexpr ImageSize pixels = ImageSize::square(96);
    const topography::FocusWindow window(options.window_px, options.window_shape);
    const auto blur = blurred ? blur_of(configuration, instrument, pixels) : std::nullopt;
    auto image = noise_image(pixels, share);
    if (blur) {
        image = blur->apply(image);
    }
    double variance = 0;
    topography::NoiseCorrelation correlation;
    std::array<std::array<double, 5>, 9> covariance{};
    for (int row = 4; row + 4 < pixels.rows; ++row) {
        for (int column = 4; column + 4 < pixels.columns; ++column) {
            const double here = image(column, row) - 1;
            variance += here * here;
            for (int dy = 0; dy <= 4 && blur; ++dy) {
                for (int dx = -4; dx <= 4; ++dx) {
                    covariance[static_cast<std::size_t>(dx + 4)][static_cast<std::size_t>(dy)] +=
                        here * (image(column + dx, row + dy) - 1);
                }
            }
        }
    }
    for (int dy = 0; dy <= 4 && blur; ++dy) {
        for (int dx = -4; dx <= 4; ++dx) {
            if (dx != 0 || dy != 0) {
                correlation.set(dx, dy,
                                covariance[static_cast<std::size_t>(dx + 4)][static_cast<std::size_t>(dy)] / variance);
            }
        }
    }
    const double count = static_cast<double>(pixels.columns - 8) * (pixels.rows - 8);
    const auto measure = topography::focus_measure({image}, options.focus_measure.value(), window);
    double square = 0;
    for (int row = 4; row + 4 < pixels.rows; ++row) {
        for (int column = 4; column + 4 < pixels.columns; ++column) {
            square += static_cast<double>(measure(column, row)) * measure(column, row);
        }
    }
    const double window_pixels = window.pixels(pixels.columns, pixels.rows, pixels.columns / 2, pixels.rows / 2);
    const double gain = topography::noise_gain(options.focus_measure.value(), window_pixels, correlation);
    NoiseOfMeasure noise{.energy = square / variance,
                         .gain_square = gain * gain,
                         .grain = 1,
                         .kept = variance / count / (share * share)};
    noise.grain = std::clamp(noise.gain_square * window_pixels / noise.energy, 1.0, window_pixels);
    return noise;
}

struct Texture {
    double energy = Expectation::unknown; // S
    double error = Expectation::unknown;  // its standard error
};

// variance: relative variance of the sample's pixels.
Texture texture_of_image(const trace::Image& image, const Sample& sample, const topography::TopographyOptions& options,
                         const NoiseOfMeasure& noise, const std::optional<optics::Diffraction>& blur, double variance) {
    const topography::FocusWindow window(options.window_px, options.window_shape);
    Grid<float> light(image.flux.columns, image.flux.rows);
    std::ranges::copy(image.flux.values, light.values.begin());
    // The light is divided by its mean, since squares of small numbers of watts leave a float's range.
    const double mean =
        std::accumulate(light.values.begin(), light.values.end(), 0.0) / static_cast<double>(light.values.size());
    if (!(mean > 0)) {
        return {};
    }
    for (float& value : light.values) {
        value = static_cast<float>(value / mean);
    }
    if (blur) {
        light = blur->apply(light);
    }
    const auto measure = topography::focus_measure({light}, options.focus_measure.value(), window);
    double sum = 0, squares = 0, count = 0;
    for (std::size_t k = 0; k < measure.values.size(); ++k) {
        if (sample.in_focus[k]) {
            const double square = static_cast<double>(measure.values[k]) * measure.values[k];
            sum += square;
            squares += square * square;
            count += 1;
        }
    }
    if (!(count > 0)) {
        return {};
    }
    const double found = sum / count;
    const double windows =
        std::max(1.0, count / window.pixels(light.columns, light.rows, light.columns / 2, light.rows / 2));
    const double scatter = std::sqrt(std::max(0.0, squares / count - found * found) / windows);
    constexpr double of_model = 0.1; // share of the noise's energy; magnitudes are added as energies
    return {.energy = found - variance * noise.energy,
            .error = std::hypot(scatter, of_model * variance * noise.energy)};
}

// The deviation w of a focus curve whose texture fades as S(z) = S(0) exp(-z^2 / w^2). Fine waves fade sooner than the
// waves that the planned deviation, by the optics, is for. The result stays within a factor of the planned one, since a
// sample is small.
double faded_deviation(double planned, double defocus, const Texture& in_focus, const Texture& out_of_focus) {
    constexpr double least = 0.4, most = 1.0;
    const double left = out_of_focus.energy / in_focus.energy;
    const double found = left > 0 && left < 1 ? defocus / std::sqrt(-std::log(left)) : left > 0 ? planned : 0.0;
    return std::clamp(found, least * planned, most * planned);
}

// The relative variance of a pixel by the rays of an image.
double variance_by_rays(const Configuration& configuration, const specimen::Specimen& specimen,
                        const std::optional<Sample>& sample, double variance_of_sample, Expectation& expected) {
    if (configuration.trace.estimator == trace::Estimator::backward && sample) {
        expected.detected_rays = rays_per_pixel_of(configuration);
        return variance_of_sample * sample->rays_per_pixel / expected.detected_rays;
    }
    const auto positions = configuration.scan->positions();
    const double height = positions[positions.size() / 2];
    const auto instrument = assemble_silently(configuration, specimen, positions);
    const auto rays = trace::launched_rays(configuration.trace, configuration.instrument);
    const auto pixels = static_cast<double>(configuration.instrument.detector_pixels.count());
    if (sample && !configuration.trace.directed_scatter) {
        double sent_out = 0;
        const auto traced = trace::as_traced(instrument, configuration.trace);
        for (const auto* light : traced.lights()) {
            sent_out +=
                light->flux * light->aimed_share() * light->splitter_reflectance * light->splitter_transmittance;
        }
        expected.detected_rays = static_cast<double>(rays) * expected.light_per_pixel / sent_out;
        return 1 / expected.detected_rays;
    }
    auto options = configuration.trace;
    options.device = "host";
    options.waves.reset();
    options.rays = std::min(options.rays, rays_of_forward_probe);
    const auto image = trace::make_host_tracer(instrument, specimen, options)->expose(height, 0);
    const double more = static_cast<double>(rays) / static_cast<double>(image.rays);
    expected.detected_rays = more * static_cast<double>(image.detected) / pixels;
    expected.light_per_pixel = std::accumulate(image.flux.values.begin(), image.flux.values.end(), 0.0) / pixels;
    const double noise = 1 / signal_to_noise(image);
    return noise * noise / more;
}

// The relative variance of a pixel by the camera, in the sample's light.
double variance_by_camera(const Configuration& configuration, const Sample& sample, Expectation& expected) {
    const camera::Camera camera(configuration.camera.value(), configuration.instrument.spectrum);
    const auto& options = camera.options();
    const double seconds =
        options.control == camera::ExposureControl::time
            ? options.exposure_time
            : camera.time_to(options.saturation, brightest_flux(sample.image.flux, sample.image.standard_error));
    const auto light = camera.light_of(sample.image.flux, sample.image.standard_error, seconds);
    expected.light_electrons = light.mean;
    return std::pow(light.camera_noise / light.mean, 2);
}

struct CurveShape {
    double width = 0;     // w, steps
    double smoothing = 0; // s, steps
};

// Sets the noise of a height and A / sqrt(rho(0) N) of the header. step: mm.
void expect_height_noise(const CurveShape& curve, double texture_energy, double variance, const NoiseOfMeasure& noise,
                         double step, Expectation& expected) {
    const double width_square = curve.width * curve.width + 2 * curve.smoothing * curve.smoothing;
    const double top_square = texture_energy * curve.width * curve.width / width_square;
    const auto weights = topography::axial_weights(curve.smoothing);
    const int radius = static_cast<int>(weights.size()) - 1;
    double total = 0;
    for (int k = -radius; k <= radius; ++k) {
        total += weights[static_cast<std::size_t>(std::abs(k))];
    }
    const auto a = [&](int k) {
        return std::abs(k) <= radius ? weights[static_cast<std::size_t>(std::abs(k))] / total : 0.0;
    };
    std::vector<double> rho; // by distance
    for (int d = 0; d <= 2 * radius + 2 * (radius + 1); ++d) {
        double sum = 0;
        for (int k = -radius; k <= radius; ++k) {
            sum += a(k) * a(k + d);
        }
        rho.push_back(sum);
    }
    const double noise_energy = rho.front() * variance * noise.energy;
    const double share = top_square / (top_square + noise_energy);
    double slope = 0;
    for (int k = -radius - 1; k <= radius + 1; ++k) {
        for (int l = -radius - 1; l <= radius + 1; ++l) {
            const double c = 0.25 * (a(k - 1) - a(k + 1)) * (a(l - 1) - a(l + 1));
            const double r = rho[static_cast<std::size_t>(std::abs(k - l))];
            slope += c * (r + 0.5 * (1 - share) / share * r * r / rho.front());
        }
    }
    expected.texture_over_noise = std::sqrt(top_square / noise_energy);
    expected.height_noise =
        step * std::sqrt(variance * noise.gain_square * width_square * width_square / top_square * slope);
}

// The standard deviation (mm) of the surface within a window from the window's mean. It is that of a normal
// distribution with the same median, so that steps do not count.
double relief_in_windows(const surface::HeightMap& heights, double window) {
    constexpr double deviations_a_median = 1.4826;
    const auto smooth = surface::gaussian_low_pass(heights, 2 * window);
    std::vector<double> deviations;
    for (std::size_t k = 0; k < heights.height.values.size(); ++k) {
        const double deviation = std::abs(heights.height.values[k] - smooth.height.values[k]);
        if (std::isfinite(deviation)) {
            deviations.push_back(deviation);
        }
    }
    if (deviations.empty()) {
        return 0;
    }
    const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
    std::ranges::nth_element(deviations, middle);
    return deviations_a_median * *middle;
}

double lateral_resolution_of(const topography::TopographyOptions& options, const Configuration& configuration,
                             const optics::FirstOrder& first_order) {
    constexpr double airy = 0.61;
    const double width = options.window_px * first_order.pixel_pitch;
    const double radius =
        airy * configuration.instrument.spectrum.reference_um * mm_per_um / first_order.numerical_aperture;
    return std::max(radius, period_of_half_in_window(options.window_shape, width));
}

} // namespace

double period_of_half_in_window(topography::WindowShape shape, double width) {
    constexpr double widths_of_box = 1.66, widths_of_gaussian = 1.07;
    return width * (shape == topography::WindowShape::box ? widths_of_box : widths_of_gaussian);
}

double Expectation::image_noise() const {
    return std::hypot(ray_noise, camera_noise);
}

Expectation expect(const Configuration& configuration, const optics::Instrument& instrument,
                   const specimen::Specimen& specimen, double hidden_uncertainty) {
    Expectation expected;
    const auto& first_order = instrument.first_order;
    const auto options = evaluation_options(configuration, instrument);
    const double step = configuration.scan->z_step;
    expected.curve_deviation = focus_curve_deviation(configuration, first_order);
    expected.lateral_resolution = lateral_resolution_of(options, configuration, first_order);
    expect_slopes(configuration, instrument, specimen, expected);

    const auto sample = sample_of(configuration, specimen, expected.curve_deviation);
    double variance_of_sample = Expectation::unknown;
    if (sample) {
        const double mean = mean_where(sample->image.flux, sample->in_focus);
        expected.light_per_pixel = mean;
        variance_of_sample = mean_where(sample->image.standard_error, sample->in_focus, 2) / (mean * mean);
    }
    double variance = variance_by_rays(configuration, specimen, sample, variance_of_sample, expected);
    const auto of_light = noise_of(options, configuration, instrument, true);
    const auto noise = configuration.camera ? noise_of(options, configuration, instrument, false) : of_light;
    // Waves spread the light of each path over the Airy pattern, which lowers the noise of a pixel.
    variance *= of_light.kept;
    expected.ray_noise = std::sqrt(variance);
    if (!sample || !(expected.light_per_pixel > 0)) {
        return expected;
    }
    if (configuration.camera) {
        const double of_camera = variance_by_camera(configuration, *sample, expected);
        expected.camera_noise = std::sqrt(of_camera);
        variance += of_camera;
    }
    const auto blur =
        blur_of(configuration, instrument, {.columns = sample->image.flux.columns, .rows = sample->image.flux.rows});
    const Texture texture =
        texture_of_image(sample->image, *sample, options, of_light, blur, variance_of_sample * of_light.kept);
    expected.texture = std::sqrt(std::max(0.0, texture.energy) / noise.energy);
    expected.texture_error = std::sqrt(texture.error / noise.energy);
    if (!(texture.energy > 0)) {
        return expected;
    }
    const Texture fading =
        texture_of_image(sample->defocused, *sample, options, of_light, blur, variance_of_sample * of_light.kept);
    expected.curve_deviation = faded_deviation(expected.curve_deviation, sample->defocus, texture, fading);
    expect_height_noise({.width = expected.curve_deviation / step, .smoothing = options.smoothing_steps.value_or(0)},
                        texture.energy, variance, noise, step, expected);
    const ImageSize pixels = configuration.instrument.detector_pixels;
    constexpr int most_points = 256; // a side
    const ImageSize looked_at{.columns = std::min(pixels.columns, most_points),
                              .rows = std::min(pixels.rows, most_points)};
    const auto grid = PixelGrid::centred(looked_at, first_order.pixel_pitch);
    const auto heights =
        specimen::truth(specimen, looked_at.columns, looked_at.rows, grid.x0, grid.y0, grid.pitch_x, grid.pitch_y);
    const topography::FocusWindow window(options.window_px, options.window_shape);
    const double window_pixels =
        window.pixels(2 * options.window_px, 2 * options.window_px, options.window_px, options.window_px);
    const double airy_pixels = std::pow(0.61 * configuration.instrument.spectrum.reference_um * mm_per_um /
                                            first_order.numerical_aperture / first_order.pixel_pitch,
                                        2);
    const double grain =
        std::min(window_pixels, configuration.trace.waves ? std::max(noise.grain, airy_pixels) : noise.grain);
    const double by_relief = relief_in_windows(heights, options.window_px * first_order.pixel_pitch) *
                             std::sqrt(1 + 2 * grain / window_pixels);
    const double curved = configuration.flatness_file.empty() ? std::max(std::abs(first_order.field_curvature),
                                                                         std::abs(first_order.field_curvature_corner)) /
                                                                    std::sqrt(12.0)
                                                              : 0;
    expected.height_uncertainty =
        std::hypot(std::hypot(expected.height_noise, by_relief), std::hypot(curved, hidden_uncertainty));
    return expected;
}

std::vector<Warning> warnings_of(const Configuration& configuration, const Expectation& expected) {
    constexpr double most_of_camera = 1.0 / 3;
    constexpr double deviations = 3;
    constexpr double least_texture = 0.01;
    std::vector<Warning> warnings;
    const bool forward = configuration.trace.estimator == trace::Estimator::forward;
    const bool may_turn = forward && !configuration.trace.nonsequential && !std::isnan(expected.texture);
    const std::string rays = std::to_string(configuration.trace.rays);
    const auto noise_warning = [&](const char* code, double share, double wanted, const std::string& what) {
        return Warning{.code = code,
                       .key = "trace.rays",
                       .value = rays,
                       .works = rays_for_noise(configuration, share, wanted),
                       .sentence = fmt::format("{} {}", what, remedy_of_noise(configuration, share, wanted))};
    };
    const double by_rays = expected.ray_noise;
    const double height_share = expected.height_noise / expected.curve_deviation;
    if (by_rays > noise_limits::most_of_image) {
        const std::string rays_a_pixel = forward
                                             ? fmt::format("{:.2g} rays a pixel are detected", expected.detected_rays)
                                             : fmt::format("{:.3g} rays a pixel are launched", expected.detected_rays);
        const std::string what = fmt::format("The images' noise will be {:.0f} % of their brightness, since {}: more "
                                             "noise than image.",
                                             100 * by_rays, rays_a_pixel);
        warnings.push_back(noise_warning("few-rays", by_rays, noise_limits::good_of_image, what));
        if (may_turn) {
            warnings.push_back(
                {.code = "forward-wastes-rays",
                 .key = "trace.estimator",
                 .value = "\"forward\"",
                 .works = "\"backward\"",
                 .sentence = fmt::format(
                     "Forward, {:.2g} of {:.3g} rays find a pixel: nearly all the work is for light "
                     "that nobody sees. Paths that start at the detector see it all.",
                     expected.detected_rays,
                     static_cast<double>(trace::launched_rays(configuration.trace, configuration.instrument)))});
        }
    } else if (configuration.camera && by_rays > most_of_camera * expected.camera_noise) {
        const double ratio = by_rays / expected.camera_noise;
        warnings.push_back(
            noise_warning("ray-noise-above-camera", ratio, most_of_camera,
                          fmt::format("The rays' noise will be {:.2g} of the camera's: above a third the "
                                      "images are noisier than the camera's.",
                                      ratio)));
    } else if (!configuration.camera && height_share > noise_limits::most_of_curve_width) {
        warnings.push_back(noise_warning(
            "ray-noise-without-camera", height_share, noise_limits::good_of_curve_width,
            fmt::format("The images' noise will be {:.2g} % of their brightness and scatter the heights by {:.2g} um, "
                        "{:.0f} % of their focus curves' width. Without [camera] it is the noise of the rays alone, "
                        "which no instrument has.",
                        100 * by_rays, expected.height_noise * um_per_mm, 100 * height_share)));
    }
    // Configured texture exists, even if the sample's noise hides it.
    const bool textured =
        configuration.specimen->roughness || configuration.specimen->reflectance || configuration.light_field;
    if (textured) {
        return warnings;
    }
    if (expected.texture < least_texture || (expected.texture < deviations * expected.texture_error &&
                                             expected.texture_error < deviations * least_texture)) {
        warnings.push_back(
            {.code = "no-texture",
             .key = "specimen.roughness.noise_um",
             .value = {},
             .works = "0.1",
             .sentence = fmt::format(
                 "The specimen shows no texture: within {:.2g} % its images are as bright everywhere, and where "
                 "nothing "
                 "is seen, focus is not. Give it [specimen.roughness], a pattern of reflectance, or project one "
                 "([illumination.field]).",
                 100 * std::max(expected.texture, expected.texture_error))});
    }
    return warnings;
}

} // namespace vkfv::measurement
