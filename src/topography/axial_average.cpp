#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vkfv::topography {
namespace {

// Of images first, first + 1, ...
struct Shares {
    int first = 0;
    std::vector<double> values;

    int end() const { return first + static_cast<int>(values.size()); }
    double operator[](int image) const { return values[static_cast<std::size_t>(image - first)]; }
};

Shares shares_at(const std::vector<double>& weights, int at, int images) {
    const int radius = static_cast<int>(weights.size()) - 1;
    const int first = std::max(0, at - radius), last = std::min(images - 1, at + radius);
    Shares shares{.first = first, .values = {}};
    double total = 0;
    for (int image = first; image <= last; ++image) {
        shares.values.push_back(weights[static_cast<std::size_t>(std::abs(image - at))]);
        total += shares.values.back();
    }
    for (double& share : shares.values)
        share /= total;
    return shares;
}

double overlap(const Shares& a, const Shares& b) {
    double sum = 0;
    for (int image = std::max(a.first, b.first); image < std::min(a.end(), b.end()); ++image)
        sum += a[image] * b[image];
    return sum;
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
    const Shares exact = shares_at(weights, at, images);
    std::vector<Share> shares;
    for (int image = exact.first; image < exact.end(); ++image)
        shares.push_back({image, static_cast<float>(exact[image])});
    return shares;
}

std::vector<double> averaged_positions(const std::vector<double>& weights, int images) {
    const int radius = static_cast<int>(weights.size()) - 1;
    std::vector<double> positions;
    for (int at = 0; at < images; ++at)
        positions.push_back(at);
    for (int average = 1; average <= 2; ++average) {
        const std::vector<double> before = positions;
        // Elsewhere weights and places are symmetric.
        for (int at = 0; at < images; ++at)
            if (at < average * radius || at >= images - average * radius) {
                const Shares shares = shares_at(weights, at, images);
                double& position = positions[static_cast<std::size_t>(at)] = 0;
                for (int image = shares.first; image < shares.end(); ++image)
                    position += shares[image] * before[static_cast<std::size_t>(image)];
            }
    }
    return positions;
}

std::vector<double> averaged_variances(const std::vector<double>& weights, int images) {
    const int radius = static_cast<int>(weights.size()) - 1;
    // From twice the radius on, the ends are not felt; the other end mirrors this one.
    const int different = std::min(2 * radius + 1, (images + 1) / 2);
    const int reached = std::min(different + radius, images);
    std::vector<Shares> shares;
    for (int at = 0; at < reached; ++at)
        shares.push_back(shares_at(weights, at, images));
    std::vector<double> covariances(static_cast<std::size_t>(reached) * static_cast<std::size_t>(reached));
    const auto covariance = [&](int i, int j) -> double& {
        return covariances[static_cast<std::size_t>(i) * static_cast<std::size_t>(reached) +
                           static_cast<std::size_t>(j)];
    };
    for (int i = 0; i < reached; ++i)
        for (int j = 0; j <= i; ++j)
            covariance(i, j) = covariance(j, i) =
                overlap(shares[static_cast<std::size_t>(i)], shares[static_cast<std::size_t>(j)]);
    std::vector<double> variances(static_cast<std::size_t>(images));
    for (int at = 0; at < images; ++at) {
        const int alike = std::min({at, images - 1 - at, different - 1});
        double& variance = variances[static_cast<std::size_t>(at)];
        if (alike < at) {
            variance = variances[static_cast<std::size_t>(alike)];
            continue;
        }
        const Shares& curve = shares[static_cast<std::size_t>(at)];
        for (int i = curve.first; i < curve.end(); ++i)
            for (int j = curve.first; j < curve.end(); ++j)
                variance += curve[i] * curve[j] * covariance(i, j);
    }
    return variances;
}

} // namespace vkfv::topography
