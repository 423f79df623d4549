#include "measurement/calibration/standards.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/evaluation/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_standards { // files of a unity build share the unnamed namespace

// True if a length is shorter than another by more than rounding: a groove that is as deep as was asked, but for the
// last digit, must not be told to be shallower.
bool is_less(double length, double than) {
    constexpr double slack = 1e-9;
    return length < (1 - slack) * than;
}

} // namespace of_standards
} // namespace

std::string um(double mm) {
    constexpr double least = 1e-6; // um, the shortest length that keys take: sums that should be 0 leave less
    const double length = mm * um_per_mm;
    return fmt::format("{:.9g}", std::abs(length) < least ? 0.0 : length);
}

std::string printed(const Conditions& conditions, double contrast, std::uint32_t print_seed) {
    constexpr double mean = 0.5;
    // A grain of one and a half pixels, or of the resolution of the optics where that is coarser.
    const double grain = 1.5 * std::max(conditions.pitch, conditions.resolution);
    return fmt::format("[specimen.material]\nscatter = \"lambertian\"\n"
                       "[specimen.reflectance]\nkind = \"noise\"\npitch_um = {}\ncorrelation_length_um = {}\n"
                       "mean = {}\nstandard_deviation = {}\nseed = {}\n",
                       um(grain / 3), um(grain), mean, contrast * mean, print_seed);
}

std::string standard_of(const Conditions& conditions, const std::string& kind, const std::string& keys,
                        double facet_pitch) {
    constexpr double margin = 1.1;
    const double side = margin * conditions.longer_field() + 2 * conditions.blur;
    return fmt::format("[specimen]\nkind = \"{}\"\nsize_mm = {:.9g}\n{}{}", kind, side,
                       facet_pitch > 0 ? "pitch_um = " + um(facet_pitch) + "\n" : "representation = \"analytic\"\n",
                       keys);
}

Groove groove_of(const Conditions& conditions, double depth, double field_share) {
    constexpr double windows = 12, thirds = 3, deviations = 2;
    const double slope = conditions.cone_slope();
    const double blurred = 0.5 * conditions.window + deviations * conditions.curve_deviation * slope;
    const double wished = std::max(windows * conditions.window, thirds * (depth * slope + blurred));
    const double width = std::min(wished, field_share * conditions.field());
    const double clear = width / thirds - blurred; // from what the middle third sees to the wall
    return {.width = width, .depth = of_standards::is_less(clear, depth * slope) ? clear / slope : depth};
}

void remark_shallower(const Conditions& conditions, const Groove& deepest, double wished,
                      std::vector<std::string>& remarks) {
    if (of_standards::is_less(deepest.depth, wished)) {
        remarks.push_back(fmt::format(
            "The deepest groove is {:.3g} µm deep, {:.0f} % of the scan less four standard deviations of a focus "
            "curve: the walls of a deeper one that the field holds would cut the light cone of its bottom.",
            deepest.depth * um_per_mm, 100 * deepest.depth / conditions.usable_range()));
    }
}

std::string groove_standard(const Conditions& conditions, const Groove& groove, std::uint32_t print_seed) {
    // Steep walls stay clear of the thirds of the levels that ISO 5436-1 leaves out.
    const double wall = std::max(conditions.pitch, std::min(groove.depth, groove.width / 8));
    return standard_of(conditions, "groove",
                       fmt::format("width_um = {}\ndepth_um = {}\nwall_um = {}\n", um(groove.width), um(groove.depth),
                                   um(wall)),
                       conditions.pitch) +
           printed(conditions, usual_contrast, print_seed);
}

std::string sinusoid_standard(const Conditions& conditions, double amplitude, double period, std::uint32_t print_seed,
                              double angle) {
    return standard_of(conditions, "sinusoid",
                       fmt::format("amplitude_um = {}\nperiod_um = {}\n", um(amplitude), um(period)),
                       0.5 * conditions.pitch) +
           printed(conditions, usual_contrast, print_seed) + placed_at(0, 0, conditions.middle(), angle);
}

std::string placed_at(double x, double y, double z, double rotation, double tilt_x, double tilt_y) {
    const auto degrees = [](double angle) { return fmt::format("{:.9g}", angle / radians_per_degree); };
    return fmt::format("[specimen.placement]\nx_um = {}\ny_um = {}\nz_um = {}\nrotation_deg = {}\ntilt_x_deg = {}\n"
                       "tilt_y_deg = {}\n",
                       um(x), um(y), um(z), degrees(rotation), degrees(tilt_x), degrees(tilt_y));
}

std::vector<TomlOverride> repetition(const Conditions& conditions, int k) {
    return {{conditions.camera ? "camera.noise_seed" : "trace.seed",
             fmt::format("{}", conditions.seed + static_cast<std::uint32_t>(k)), origin_of_standards}};
}

const StandardDimension* dimension(const TrialResult& result, const std::string& name) {
    const auto found = std::ranges::find_if(
        result.dimensions, [&](const StandardDimension& one) { return one.measured.name.starts_with(name); });
    return found == result.dimensions.end() || !std::isfinite(found->measured.value) ? nullptr : &*found;
}

double uncertainty_of(const StandardDimension& dimension) {
    double square = 0;
    for (const double part :
         {dimension.measured.standard_error, dimension.brightness_uncertainty, dimension.window_uncertainty}) {
        square += std::isfinite(part) ? part * part : 0;
    }
    return std::sqrt(square);
}

double median_of(std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty()) {
        return surface::undefined;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

double common_offset(const TrialResult& result) {
    std::vector<double> deviations = result.heights.height.values;
    for (std::size_t k = 0; k < deviations.size(); ++k) {
        deviations[k] -= result.truth.height.values[k];
    }
    return median_of(std::move(deviations));
}

PointShares point_shares(const Conditions& conditions, const TrialResult& result, double offset) {
    PointShares shares;
    double measured = 0;
    for (std::size_t k = 0; k < result.heights.height.values.size(); ++k) {
        const double truth = result.truth.height.values[k];
        if (!(std::abs(truth - conditions.middle()) <= 0.5 * conditions.usable_range())) {
            continue;
        }
        shares.points += 1;
        const double off = result.heights.height.values[k] - truth - offset;
        if (std::isfinite(off)) {
            const bool right = std::abs(off) <= coverage_factor * result.uncertainty.values[k];
            shares.right += right ? 1 : 0;
            shares.wrong += right ? 0 : 1;
            shares.deviation += off * off;
            measured += 1;
        }
    }
    shares.right /= shares.points;
    shares.wrong /= shares.points;
    shares.deviation = std::sqrt(shares.deviation / measured);
    return shares;
}

Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
    const auto count = static_cast<double>(x.size());
    Line line;
    if (x.size() < 3) {
        return line;
    }
    double mean_x = 0, mean_y = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        mean_x += x[k] / count;
        mean_y += y[k] / count;
    }
    double xx = 0, xy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
    line.slope = xy / xx;
    line.offset = mean_y - line.slope * mean_x;
    line.degrees_of_freedom = count - 2;
    double squares = 0;
    line.farthest = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double off = y[k] - line.offset - line.slope * x[k];
        squares += off * off;
        line.farthest = std::max(line.farthest, std::abs(off));
    }
    line.scatter = std::sqrt(squares / line.degrees_of_freedom);
    line.slope_uncertainty = line.scatter / std::sqrt(xx);
    return line;
}

} // namespace vkfv::measurement
