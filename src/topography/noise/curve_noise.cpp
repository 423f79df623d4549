#include "topography/noise/curve_noise.hpp"

#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>

namespace vkfv::topography {
namespace {

// Ends of the tables by the texture's share of the energy and by the bend; and the offset of their second column, in
// steps.
constexpr double least_share = 0.02, least_bend = 1e-4, most_bend = 8, far_offset = 0.45;

struct CurveValues {
    const std::vector<double>& values;
    double curve_value(int at) const { return values[static_cast<std::size_t>(at)]; }
};

// The number of values on either side of the largest one that the method takes.
int range_of(const PeakFinder& finder) {
    return finder.method == PeakMethod::gaussian || finder.method == PeakMethod::parabola ? 1 : finder.range;
}

// The place of the maximum near the value `at`, in steps from it. None if the method finds no maximum.
std::optional<double> place_of(const std::vector<double>& values, int at, const PeakFinder& finder) {
    focus::f64::FocusPlan plan{};
    plan.peak = static_cast<int>(finder.method);
    const int last = static_cast<int>(values.size()) - 1;
    const auto fit =
        focus::f64::locate_peak(CurveValues{values}, plan, at, std::min({range_of(finder), at, last - at}));
    return fit.found ? std::optional(fit.offset) : std::nullopt;
}

// The derivatives of a maximum's place by the values around it, for the Gaussian exp(-curvature (x - offset)^2 / 2),
// normalised to its value at 0.
std::vector<double> derivatives(double curvature, double offset, const PeakFinder& finder) {
    const int range = range_of(finder);
    std::vector<double> values;
    for (int x = -range; x <= range; ++x) {
        values.push_back(std::exp(-0.5 * curvature * (x * x - 2 * x * offset)));
    }
    std::vector<double> result(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double little = 1e-5 * std::min(1.0, curvature) * values[k], value = values[k];
        values[k] = value + little;
        const auto above = place_of(values, range, finder);
        values[k] = value - little;
        const auto below = place_of(values, range, finder);
        values[k] = value;
        result[k] = above && below ? (*above - *below) / (2 * little) : 0;
    }
    return result;
}

double bend_of_index(int index, int count) {
    return least_bend * std::pow(most_bend / least_bend, static_cast<double>(index) / (count - 1));
}

// The curvature c, in 1 / steps^2, of the Gaussian through a curve's largest value and both its neighbours. bend: twice
// the largest value less both neighbours, over the largest, so 2 - 2 exp(-c / 2) cosh(c offset). offset: steps from the
// largest value to the Gaussian's maximum. Fixed-point iteration.
double curvature_of(double bend, double offset) {
    double curvature = bend;
    const double rest = std::max(1e-3, 1 - bend / 2);
    for (int step = 0; step < 4; ++step) {
        curvature = -2 * std::log(rest / std::cosh(std::min(curvature, most_bend) * offset));
    }
    return std::clamp(curvature, least_bend, most_bend);
}

} // namespace

CurveNoise::CurveNoise(const TextureAndNoise& found, const std::vector<double>& axial_weights, const PeakFinder& finder,
                       int images)
    : found_(found), most_((images - 1) / std::sqrt(12.0)) {
    const int radius = static_cast<int>(axial_weights.size()) - 1, range = range_of(finder);
    std::vector<double> weights; // normalised to the sum 1, from -radius
    for (const Share& share : axial_shares(axial_weights, 2 * radius, 4 * radius + 1)) {
        weights.push_back(static_cast<double>(share.weight));
    }
    const auto taps = static_cast<int>(weights.size());
    std::vector<double> shared(weights.size()); // autocorrelation rho of the weights
    for (int lag = 0; lag < taps; ++lag) {
        for (int k = 0; k + lag < taps; ++k) {
            shared[static_cast<std::size_t>(lag)] +=
                weights[static_cast<std::size_t>(k)] * weights[static_cast<std::size_t>(k + lag)];
        }
    }
    kept_ = shared[0];
    const int reach = radius + std::max(range, 1), side = 2 * reach + 1, points = 2 * std::max(range, 1) + 1;
    std::vector<double> energy(static_cast<std::size_t>(side));
    for (int k = 0; k < side; ++k) {
        energy[static_cast<std::size_t>(k)] = found.energy_at(k - reach);
    }
    std::vector<double> beside(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int k = 0; k < side; ++k) {
        for (int l = std::max(0, k - taps + 1); l < std::min(side, k + taps); ++l) {
            const double distance = std::sqrt(0.5 * ((k - reach) * (k - reach) + (l - reach) * (l - reach)));
            beside[static_cast<std::size_t>(k * side + l)] = found.beside_at(distance);
        }
    }
    std::vector<std::array<std::vector<double>, 2>> slopes;
    for (int k = 0; k < bends; ++k) {
        const double curvature = bend_of_index(k, bends);
        slopes.push_back({derivatives(curvature, 0, finder), derivatives(curvature, far_offset, finder)});
    }
    for (int index = 0; index < shares; ++index) {
        OfShare here{.share = least_share + (1 - least_share) * index / (shares - 1)};
        std::vector<double> texture(static_cast<std::size_t>(side)), noise = texture, value = texture;
        for (int k = 0; k < side; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const double whole = here.share * energy[at] + 1 - here.share;
            value[at] = std::sqrt(whole);
            texture[at] = whole > 0 ? std::sqrt(here.share * energy[at] / whole) : 0;
            noise[at] = whole > 0 ? std::sqrt((1 - here.share) / whole) : 0;
        }
        // The averaged curve's values at -range ... range, and their covariances over v.
        std::vector<double> averaged(static_cast<std::size_t>(points)),
            covariance(static_cast<std::size_t>(points * points));
        // half: the covariances of an averaged value at x with the single ones, from which `covariance` is averaged.
        std::vector<double> half(static_cast<std::size_t>(points * side));
        for (int x = 0; x < points; ++x) {
            for (int tap = 0; tap < taps; ++tap) {
                const int k = x + tap;
                averaged[static_cast<std::size_t>(x)] +=
                    weights[static_cast<std::size_t>(tap)] * value[static_cast<std::size_t>(k)];
                for (int l = std::max(0, k - taps + 1); l < std::min(side, k + taps); ++l) {
                    const double rho = shared[static_cast<std::size_t>(std::abs(k - l))];
                    const auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>(l);
                    half[static_cast<std::size_t>(x * side + l)] +=
                        weights[static_cast<std::size_t>(tap)] *
                        (rho * beside[static_cast<std::size_t>(k * side + l)] * texture[a] * texture[b] +
                         rho * rho / kept_ * found.alone * noise[a] * noise[b]);
                }
            }
        }
        for (int x = 0; x < points; ++x) {
            for (int y = 0; y < points; ++y) {
                for (int tap = 0; tap < taps; ++tap) {
                    covariance[static_cast<std::size_t>(x * points + y)] +=
                        weights[static_cast<std::size_t>(tap)] * half[static_cast<std::size_t>(x * side + y + tap)];
                }
            }
        }
        const auto of = [&](const std::vector<double>& slope) {
            const int first = (points - static_cast<int>(slope.size())) / 2;
            double sum = 0;
            for (int x = 0; x < static_cast<int>(slope.size()); ++x) {
                for (int y = 0; y < static_cast<int>(slope.size()); ++y) {
                    sum += slope[static_cast<std::size_t>(x)] * slope[static_cast<std::size_t>(y)] *
                           covariance[static_cast<std::size_t>((x + first) * points + y + first)];
                }
            }
            return std::max(0.0, sum);
        };
        const auto middle = static_cast<std::size_t>(points / 2);
        here.largest = averaged[middle];
        here.bend = (2 * averaged[middle] - averaged[middle - 1] - averaged[middle + 1]) / averaged[middle];
        for (int k = 0; k < bends; ++k) {
            const auto at = static_cast<std::size_t>(k);
            here.place[at] = {of(slopes[at][0]), of(slopes[at][1])};
        }
        by_share_.push_back(here);
    }
    simulate(axial_weights, finder);
    // The noise energy is N = (1 - q) F^2, and the averaged curve's largest value is L(q) F.
    const double whole = found.variance * kept_ * found.noise_energy / std::max(1e-6, 1 - found.share);
    bend_variance_ = found.bend_variance;
    if (whole > 0) {
        const auto linear = at_share(found.share, [&](const OfShare& here) {
            const double largest = here.largest * here.largest * whole;
            return std::sqrt(found.variance / largest * place_variance(here, here.bend, 0.25));
        });
        const Simulated around = simulated_at(linear);
        const double ratio = unchosen(at_share(found.share, [](const OfShare& here) { return here.bend; }), around);
        bend_variance_ = ratio * ratio * std::max(0.0, bend_variance_ - around.bend_variance);
    }
}

double CurveNoise::unchosen(double bend, const Simulated& found) {
    return bend > 0 ? bend / (bend + std::max(0.0, found.bend_bias)) : 1;
}

template <class ValueOf>
double CurveNoise::at_share(double share, const ValueOf& value_of) const {
    const double at = std::clamp((share - least_share) / (1 - least_share), 0.0, 1.0) * (shares - 1);
    const auto before = std::min(static_cast<std::size_t>(at), by_share_.size() - 2);
    return std::lerp(value_of(by_share_[before]), value_of(by_share_[before + 1]), at - static_cast<double>(before));
}

double CurveNoise::share_of(double largest, double noise) const {
    const double ratio = noise / (largest * largest);
    const auto at = [&](const OfShare& here) { return (1 - here.share) / (here.largest * here.largest); };
    for (std::size_t k = by_share_.size() - 1; k > 0; --k) {
        const double above = at(by_share_[k]), below = at(by_share_[k - 1]);
        if (ratio <= below) {
            return std::lerp(by_share_[k].share, by_share_[k - 1].share,
                             std::clamp((ratio - above) / (below - above), 0.0, 1.0));
        }
    }
    return least_share;
}

double CurveNoise::place_variance(const OfShare& here, double bend, double offset) const {
    const double inside = std::clamp(std::abs(offset), 0.0, 0.5);
    const double curvature = curvature_of(std::max(bend, least_bend), inside);
    const double at = std::log(curvature / least_bend) / std::log(most_bend / least_bend) * (bends - 1);
    const auto before = static_cast<std::size_t>(std::clamp(at, 0.0, bends - 2.0));
    const double rest = at - static_cast<double>(before);
    const auto of = [&](std::size_t which) {
        const double a = here.place[before][which], b = here.place[before + 1][which];
        return a > 0 && b > 0 ? std::exp(std::lerp(std::log(a), std::log(b), rest)) : std::max(a, b);
    };
    const double middle = of(0), far = of(1);
    return std::max(0.0, middle + (far - middle) * inside * inside / (far_offset * far_offset));
}

double CurveNoise::place(const focus::f64::CurveRecord& curve, double variance, double window_share) const {
    if (!(variance > 0) || !(curve.largest > 0)) {
        return 0;
    }
    const double square = curve.largest * curve.largest;
    const double share = share_of(curve.largest, variance * kept_ * found_.noise_energy);
    const double scale = variance / (square * window_share);
    const double expected = at_share(share, [](const OfShare& here) { return here.bend; });
    const auto linear_of = [&](double bend) {
        return std::sqrt(
            scale * at_share(share, [&](const OfShare& here) { return place_variance(here, bend, curve.offset); }));
    };
    const Simulated around = simulated_at(linear_of(expected));
    const double ratio = unchosen(expected, around);
    const double believed =
        bend_variance_ > 0 ? bend_variance_ / (bend_variance_ + ratio * ratio * around.bend_variance) : 0;
    const double linear = linear_of(std::lerp(expected, ratio * curve.bend / curve.largest, believed));
    return std::min(linear * simulated_at(linear).factor, most_);
}

CurveNoise::Simulated CurveNoise::simulated_at(double linear) const {
    if (simulated_.empty()) {
        return {.linear = linear};
    }
    if (linear <= simulated_.front().linear) {
        Simulated result = simulated_.front();
        const double less = std::pow(linear / result.linear, 2);
        result.factor = 1 + (result.factor - 1) * less;
        result.bend_bias *= less;
        result.bend_variance *= less;
        return result;
    }
    if (linear >= simulated_.back().linear) { // the place cannot scatter further
        Simulated result = simulated_.back();
        result.factor *= result.linear / linear;
        return result;
    }
    const auto after = std::ranges::upper_bound(simulated_, linear, {}, &Simulated::linear);
    const auto before = after - 1;
    const double rest = std::log(linear / before->linear) / std::log(after->linear / before->linear);
    return {.linear = linear,
            .factor = std::lerp(before->factor, after->factor, rest),
            .bend_bias = std::lerp(before->bend_bias, after->bend_bias, rest),
            .bend_variance = std::lerp(before->bend_variance, after->bend_variance, rest)};
}

// Simulates a curve of the stack's own width many times, under noise that both averages along z have correlated.
void CurveNoise::simulate(const std::vector<double>& axial_weights, const PeakFinder& finder) {
    constexpr int samples = 400, most_reach = 200, levels = 12;
    const double bend = at_share(found_.share, [](const OfShare& here) { return here.bend; });
    if (!(bend > least_bend) || !(found_.share > least_share)) {
        return;
    }
    const double width = std::sqrt(found_.share / curvature_of(bend, 0));
    const int reach = std::clamp(static_cast<int>(std::ceil(2.5 * width)), 2, most_reach), count = 2 * reach + 1;
    const int images = 4 * static_cast<int>(axial_weights.size()) + 1;
    std::vector<double> kernel = twice_averaged(axial_weights, images / 2, images);
    std::erase(kernel, 0.0);
    std::mt19937_64 random(0);
    std::normal_distribution<double> normal;
    std::vector<std::vector<double>> noise;
    std::vector<double> places, white(static_cast<std::size_t>(count) + kernel.size());
    for (int sample = 0; sample < samples; ++sample) {
        std::ranges::generate(white, [&] { return normal(random); });
        std::vector<double>& here = noise.emplace_back(static_cast<std::size_t>(count));
        for (std::size_t k = 0; k < here.size(); ++k) {
            for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
                here[k] += kernel[tap] * white[k + tap];
            }
        }
        places.push_back((sample + 0.5) / samples - 0.5);
    }
    struct Found {
        double variance = 0;
        double bend = 0;
        double bend_variance = 0;
    };
    const auto found_at = [&](double strength) {
        double squares = 0, sum = 0, sum_squares = 0, count_found = 0;
        std::vector<double> values(static_cast<std::size_t>(count));
        for (std::size_t sample = 0; sample < noise.size(); ++sample) {
            for (int k = 0; k < count; ++k) {
                const double x = (k - reach - places[sample]) / width;
                values[static_cast<std::size_t>(k)] = std::sqrt(found_.share * std::exp(-x * x) + 1 - found_.share) +
                                                      strength * noise[sample][static_cast<std::size_t>(k)];
            }
            const auto top = std::ranges::max_element(values);
            const auto at = static_cast<int>(top - values.begin());
            if (const auto offset = at > 0 && at + 1 < count ? place_of(values, at, finder) : std::nullopt) {
                const double off = at - reach + *offset - places[sample];
                const double bend_here = (2 * *top - *(top - 1) - *(top + 1)) / *top;
                squares += off * off;
                sum += bend_here;
                sum_squares += bend_here * bend_here;
                count_found += 1;
            }
        }
        const double of = std::max(1.0, count_found), mean = sum / of;
        return Found{
            .variance = squares / of, .bend = mean, .bend_variance = std::max(0.0, sum_squares / of - mean * mean)};
    };
    constexpr double little = 1e-4;
    const Found without = found_at(0); // the place without noise, as methods have their own errors
    const double unit = std::sqrt(std::max(0.0, found_at(little).variance - without.variance)) / little;
    if (!(unit > 0)) {
        return;
    }
    double level = 0.02 * width;
    for (int k = 0; k < levels; ++k, level *= 1.6) {
        const Found here = found_at(level / unit);
        simulated_.push_back({.linear = level,
                              .factor = std::sqrt(std::max(0.0, here.variance - without.variance)) / level,
                              .bend_bias = here.bend - without.bend,
                              .bend_variance = std::max(0.0, here.bend_variance - without.bend_variance)});
    }
}

} // namespace vkfv::topography
