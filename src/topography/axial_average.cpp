#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>

namespace vkfv::topography {
namespace {

// Shares of the images first, first + 1, ... in a mean.
struct Shares {
    int first = 0;
    std::vector<double> values;

    int end() const { return first + static_cast<int>(values.size()); }
    double operator[](int image) const { return values[static_cast<std::size_t>(image - first)]; }
};

Shares normalised(int first, int last, const std::function<double(int)>& weight) {
    Shares shares{.first = first, .values = {}};
    double total = 0;
    for (int image = first; image <= last; ++image) {
        shares.values.push_back(weight(image));
        total += shares.values.back();
    }
    for (double& share : shares.values)
        share /= total;
    return shares;
}

int radius_of(const std::vector<double>& weights) {
    return static_cast<int>(weights.size()) - 1;
}

Shares shares_at(const std::vector<double>& weights, int at, int images) {
    const int radius = radius_of(weights);
    return normalised(std::max(0, at - radius), std::min(images - 1, at + radius),
                      [&](int image) { return weights[static_cast<std::size_t>(std::abs(image - at))]; });
}

double noise_variance(const Shares& shares) {
    return std::inner_product(shares.values.begin(), shares.values.end(), shares.values.begin(), 0.0);
}

// The shares of an image's neighbours whose mean has the same noise everywhere: see even_shares().
Shares even_shares_at(const std::vector<double>& weights, int at, int images) {
    const int radius = radius_of(weights);
    if (radius == 0) {
        return {.first = at, .values = {1}};
    }
    const int most = std::max(0, images - 1 - 2 * radius);
    const int first = std::clamp(at - radius, 0, most), last = std::min(images - 1, first + 2 * radius);
    const double middle = 0.5 * (first + last);
    if (at == middle) {
        return shares_at(weights, at, images);
    }
    // The Gaussian of the weights; a smaller flatness of its exponent makes it wider.
    const auto about = [&](double centre, double flatness) {
        return normalised(first, last, [&](int image) {
            return std::pow(weights[1], flatness * (image - centre) * (image - centre));
        });
    };
    const double variance = noise_variance(about(middle, 1));
    double flat = 0, steep = 1;
    constexpr int halvings = 30; // more than a float's digits, to which the shares are rounded
    for (int halving = 0; halving < halvings; ++halving) {
        const double between = 0.5 * (flat + steep);
        (noise_variance(about(at, between)) < variance ? flat : steep) = between;
    }
    return about(at, steep);
}

std::vector<Share> in_float(const Shares& exact) {
    std::vector<Share> shares;
    for (int image = exact.first; image < exact.end(); ++image)
        shares.push_back({image, static_cast<float>(exact[image])});
    return shares;
}

// The shares of images in a point of the curve after both averages.
Shares twice_shares_at(const std::vector<double>& weights, int at, int images) {
    const int reach = 2 * radius_of(weights);
    const int first = std::max(0, at - reach), last = std::min(images - 1, at + reach);
    Shares result{.first = first, .values = std::vector<double>(static_cast<std::size_t>(last - first + 1))};
    const Shares curve = shares_at(weights, at, images);
    for (int point = curve.first; point < curve.end(); ++point) {
        const Shares averaged = shares_at(weights, point, images);
        for (int image = averaged.first; image < averaged.end(); ++image)
            result.values[static_cast<std::size_t>(image - first)] += curve[point] * averaged[image];
    }
    return result;
}

} // namespace

std::vector<double> axial_weights(double standard_deviation) {
    const int radius = static_cast<int>(std::ceil(3 * standard_deviation));
    std::vector<double> weights = {1};
    for (int d = 1; d <= radius; ++d)
        weights.push_back(std::exp(-0.5 * (d / standard_deviation) * (d / standard_deviation)));
    return weights;
}

std::vector<Share> axial_shares(const std::vector<double>& weights, int at, int images) {
    return in_float(shares_at(weights, at, images));
}

std::vector<Share> even_shares(const std::vector<double>& weights, int at, int images) {
    return in_float(even_shares_at(weights, at, images));
}

std::vector<double> twice_averaged(const std::vector<double>& weights, int at, int images) {
    const Shares shares = twice_shares_at(weights, at, images);
    std::vector<double> result(static_cast<std::size_t>(images));
    for (int image = shares.first; image < shares.end(); ++image) {
        result[static_cast<std::size_t>(image)] = shares[image];
    }
    return result;
}

std::vector<AveragedPoint> averaged_points(const std::vector<double>& weights, int images) {
    const int reach = 2 * radius_of(weights);
    std::vector<AveragedPoint> points;
    for (int at = 0; at < images; ++at) {
        // Where no end is felt, every point has the variance of the one before it.
        if (at > reach && at < images - reach) {
            points.push_back({static_cast<double>(at), points.back().variance});
            continue;
        }
        const Shares shares = twice_shares_at(weights, at, images);
        AveragedPoint point;
        for (int image = shares.first; image < shares.end(); ++image) {
            point.position += shares[image] * image;
            point.variance += shares[image] * shares[image];
        }
        if (at == reach && at < images - reach)
            point.position = at; // exact, without the sum's rounding, as at its neighbours
        points.push_back(point);
    }
    return points;
}

} // namespace vkfv::topography
