#include "topography/persistence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vkfv::topography {
namespace {

// The value that a standard normal variable exceeds with this probability.
double normal_exceeded_with(double probability) {
    double low = -10, high = 10;
    constexpr int halvings = 50;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(middle / std::numbers::sqrt2) > probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

// The value over its mean that a chi-square variable of so many degrees of freedom exceeds with the probability with
// which a standard normal variable exceeds `normal` (E. B. Wilson and M. M. Hilferty, "The distribution of chi-square",
// 1931).
double chi_square_exceeded_as(double normal, double degrees) {
    const double variance = 2 / (9 * degrees);
    const double root = 1 - variance + normal * std::sqrt(variance);
    return root * root * root;
}

} // namespace

PersistenceLimit::PersistenceLimit(const IndependentImages& independent, const std::vector<double>& neighbour_weights,
                                   bool curves_averaged, int images, double rate, std::optional<double> strong_texture,
                                   double least_energy)
    : independent_(independent), strong_texture_(strong_texture), least_energy_(least_energy) {
    for (int at = 0; at < images; ++at) {
        const auto shares = axial_shares(neighbour_weights, at, images);
        kept_.push_back(std::accumulate(shares.begin(), shares.end(), 0.0, [](double sum, const Share& share) {
            return sum + static_cast<double>(share.weight) * static_cast<double>(share.weight);
        }));
    }
    mean_kept_ = std::accumulate(kept_.begin(), kept_.end(), 0.0) / images;
    if (!curves_averaged && neighbour_weights.size() == 2) {
        const double sum = neighbour_weights[0] + 2 * neighbour_weights[1];
        weight_ = neighbour_weights[0] / sum;
        weight_beside_ = neighbour_weights[1] / sum;
    }
    // The largest value of the curve is chosen among as many places as there are means that share few images.
    const double places = std::max(1.0, images * kept_[kept_.size() / 2]);
    normal_ = normal_exceeded_with(rate / places);
}

bool PersistenceLimit::tells() const {
    // The ratio is 1 / f for images that are all alike. Texture that comes into focus has two thirds of this where
    // images are averaged, and nine tenths where two neighbours alone are compared, whose f is 3 / 8. Compression takes
    // some of it away: where the stack's own strong texture is known, a tenth below it is for its scatter.
    constexpr double whole = 0.9, of_averaged = 0.66, of_neighbours = 0.95, below_strong = 0.9;
    const double kept = kept_[kept_.size() / 2];
    const double of_texture = 3 * kept < 1 ? of_averaged : of_neighbours;
    const double of_strong = strong_texture_ ? below_strong * std::lerp(kept, 1.0, *strong_texture_) : of_texture;
    return independent_.deviation > 0 && independent_.largest * kept < whole &&
           (independent_.mean + beyond_chance(1)) * kept < std::min(of_texture, of_strong);
}

double PersistenceLimit::beyond_chance(double window_share) const {
    const double wider = 1 / std::sqrt(window_share);
    const double relative = independent_.deviation / independent_.mean * wider;
    return std::max(independent_.mean * (chi_square_exceeded_as(normal_, 2 / (relative * relative)) - 1),
                    wider * (independent_.largest - independent_.mean));
}

double PersistenceLimit::least_ratio() const {
    return !kept_.empty() && tells() ? independent_.mean + beyond_chance(1) : 0;
}

double PersistenceLimit::scale_of_chance(const focus::f64::CurveRecord& curve, double independent) const {
    if (weight_ == 0 || curve.at == 0 || curve.at + 1 == static_cast<int>(kept_.size())) {
        return independent;
    }
    // The record has the sum of the two neighbours' measures, by its bend, and the sum of their squares, by f E.
    const double sum = 2 * curve.largest - curve.bend, largest = weight_ * curve.largest;
    const double beside = weight_beside_ * weight_beside_;
    const double squares = std::max((independent - largest * largest) / beside, 0.5 * sum * sum);
    const double product = std::max(0.0, 0.5 * (sum * sum - squares));
    return std::min(independent, 2 * std::sqrt(largest * largest * beside * squares + std::pow(beside * product, 2)));
}

double PersistenceLimit::all_alike(const focus::f64::CurveRecord& curve) const {
    if (weight_ == 0 || curve.at == 0 || curve.at + 1 == static_cast<int>(kept_.size())) {
        return curve.alone;
    }
    const double mean = weight_ * curve.largest + weight_beside_ * (2 * curve.largest - curve.bend);
    return mean * mean;
}

bool PersistenceLimit::exceeded_by(const focus::f64::CurveRecord& curve, double window_share) const {
    if (kept_.empty()) {
        return true;
    }
    const double kept = kept_[static_cast<std::size_t>(curve.at)];
    const double joint = curve.joint * curve.joint, alone = curve.alone, independent = kept * alone;
    if (!tells()) {
        constexpr double persistent = 0.25, alike = 0.5;
        // Chance makes patterns of a window alike by half in one place of twenty, where one image is far stronger than
        // its neighbours: this counts only if the stack's strong texture is alike by as much.
        const bool strong_alike = strong_texture_ && *strong_texture_ >= alike;
        return alone >= least_energy_ &&
               (joint - independent >= persistent * (alone - independent) ||
                (strong_alike && joint - independent >= alike * (all_alike(curve) - independent)));
    }
    const double images = static_cast<double>(kept_.size());
    const double mean = independent_.mean, beyond = beyond_chance(window_share);
    const double chance = scale_of_chance(curve, independent);
    const double beyond_independent = joint - independent - (mean - 1) * chance; // its mean is 0 for noise
    const double here = beyond_independent / (1 - mean * kept);
    const double passing = std::max(0.0, alone - here);
    const bool by_chance = beyond_independent <= beyond * chance && here <= passing;
    if (by_chance || !(here > 0)) {
        return false;
    }
    const double everywhere =
        (curve.joint_squares / images - mean * mean_kept_ * curve.alone_sum / images) / (1 - mean * mean_kept_);
    // If the same pattern persisted everywhere, this is the deviation of noise of energy N and of its product with the
    // pattern.
    const double noise = std::min(kept * passing, chance);
    return here - everywhere > beyond * std::sqrt(noise * noise + 2 * std::max(0.0, everywhere) * noise);
}

} // namespace vkfv::topography
