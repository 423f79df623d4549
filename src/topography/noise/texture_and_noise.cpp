#include "topography/noise/texture_and_noise.hpp"

#include "core/threads/parallel_list.hpp"
#include "topography/focus_probes.hpp"
#include "topography/noise/focus_masks.hpp"
#include "topography/noise/quiet_images.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <random>

namespace vkfv::topography {
namespace {

// Responses of a patch to every channel's masks, in the window around its middle.
class WindowResponses {
  public:
    WindowResponses(FocusMeasure measure, const FocusWindow& window, int channels)
        : laplacian_(measure == FocusMeasure::modified_laplacian),
          deviation_(measure == FocusMeasure::standard_deviation), masks_(masks_of(measure)), channels_(channels),
          side_(2 * window.radius() + 1) {
        double total = 0;
        for (int row = 0; row < side_; ++row) {
            for (int column = 0; column < side_; ++column) {
                weights_.push_back(window.weights()[static_cast<std::size_t>(std::abs(row - window.radius()))] *
                                   window.weights()[static_cast<std::size_t>(std::abs(column - window.radius()))]);
                total += weights_.back();
            }
        }
        for (double& weight : weights_) {
            weight /= total;
        }
    }

    int patch_side() const { return side_ + 2 * mask_reach; }

    // patch: all channels, patch_side() squared pixels each.
    std::vector<double> of(const std::vector<double>& patch) const {
        const auto side = static_cast<std::size_t>(patch_side());
        std::vector<double> result;
        result.reserve(static_cast<std::size_t>(channels_) * masks_.size() * weights_.size());
        for (std::size_t channel = 0; channel < static_cast<std::size_t>(channels_); ++channel) {
            const double* pixels = patch.data() + channel * side * side;
            for (const Mask& mask : masks_) {
                append(pixels, mask, result);
            }
        }
        return result;
    }

    // What noise is weighed by: the responses, or the modified Laplacian's signs.
    std::vector<double> slopes(const std::vector<double>& responses) const {
        if (!laplacian_) {
            return responses;
        }
        std::vector<double> result(responses.size());
        for (std::size_t pixel = 0; pixel < weights_.size(); ++pixel) {
            const double whole = magnitude(responses, pixel);
            for (std::size_t channel = 0; channel < static_cast<std::size_t>(channels_) && whole > 0; ++channel) {
                const double share = of_channel(responses, channel, pixel) / whole;
                for (std::size_t mask = 0; mask < masks_.size(); ++mask) {
                    const std::size_t at = (channel * masks_.size() + mask) * weights_.size() + pixel;
                    result[at] = share * (responses[at] > 0 ? 1.0 : responses[at] < 0 ? -1.0 : 0.0);
                }
            }
        }
        return result;
    }

    // Window's mean of the product, summed over masks and channels: over the channels' number as the measure is.
    double product(const std::vector<double>& a, const std::vector<double>& b) const {
        double sum = 0;
        for (std::size_t field = 0; field < a.size(); field += weights_.size()) {
            for (std::size_t pixel = 0; pixel < weights_.size(); ++pixel) {
                sum += weights_[pixel] * a[field + pixel] * b[field + pixel];
            }
        }
        return sum / (laplacian_ ? std::sqrt(channels_) : channels_);
    }

    // Square of the measure.
    double energy(const std::vector<double>& responses) const {
        if (!laplacian_) {
            return product(responses, responses);
        }
        double sum = 0;
        for (std::size_t pixel = 0; pixel < weights_.size(); ++pixel) {
            sum += weights_[pixel] * magnitude(responses, pixel);
        }
        return sum * sum / channels_;
    }

  private:
    void append(const double* pixels, const Mask& mask, std::vector<double>& result) const {
        const int patch = patch_side(), taps = 2 * mask_reach + 1;
        std::vector<double> along(static_cast<std::size_t>(side_) * static_cast<std::size_t>(patch));
        for (int row = 0; row < patch; ++row) {
            for (int column = 0; column < side_; ++column) {
                double sum = 0;
                for (int tap = 0; tap < taps; ++tap) {
                    sum += mask.x[static_cast<std::size_t>(tap)] * pixels[row * patch + column + tap];
                }
                along[static_cast<std::size_t>(row * side_ + column)] = sum;
            }
        }
        const std::size_t first = result.size();
        double mean = 0;
        for (int row = 0; row < side_; ++row) {
            for (int column = 0; column < side_; ++column) {
                double sum = 0;
                for (int tap = 0; tap < taps; ++tap) {
                    sum += mask.y[static_cast<std::size_t>(tap)] *
                           along[static_cast<std::size_t>((row + tap) * side_ + column)];
                }
                mean += weights_[result.size() - first] * sum;
                result.push_back(sum);
            }
        }
        for (std::size_t k = first; deviation_ && k < result.size(); ++k) {
            result[k] -= mean;
        }
    }

    double of_channel(const std::vector<double>& responses, std::size_t channel, std::size_t pixel) const {
        double sum = 0;
        for (std::size_t mask = 0; mask < masks_.size(); ++mask) {
            sum += std::abs(responses[(channel * masks_.size() + mask) * weights_.size() + pixel]);
        }
        return sum;
    }
    double magnitude(const std::vector<double>& responses, std::size_t pixel) const {
        double squares = 0;
        for (std::size_t channel = 0; channel < static_cast<std::size_t>(channels_); ++channel) {
            squares += std::pow(of_channel(responses, channel, pixel), 2);
        }
        return std::sqrt(squares);
    }

    bool laplacian_, deviation_;
    std::vector<Mask> masks_;
    int channels_;
    int side_;
    std::vector<double> weights_;
};

// Two means around an image that share none, both near that of the weights: of its even and of its odd neighbours, or
// of the image and the one after it.
struct Halves {
    std::vector<Share> one, other;
};

std::vector<Share> every_second(const std::vector<Share>& shares, int parity) {
    std::vector<Share> half;
    float total = 0;
    for (const Share& share : shares) {
        if (share.image % 2 == parity) {
            half.push_back(share);
            total += share.weight;
        }
    }
    for (Share& share : half) {
        share.weight /= total;
    }
    return half;
}

std::vector<Halves> halves_at(const std::vector<double>& axial_weights, int at, int images) {
    std::vector<Halves> result;
    if (axial_weights.size() > 1) {
        const auto shares = axial_shares(axial_weights, at, images);
        result.push_back({.one = every_second(shares, 0), .other = every_second(shares, 1)});
        return result;
    }
    for (const int first : {at - 1, at}) {
        if (first >= 0 && first + 1 < images) {
            result.push_back({.one = {{first, 1.0f}}, .other = {{first + 1, 1.0f}}});
        }
    }
    return result;
}

// What the probes add up to at a distance from the maximum.
struct Sums {
    double energy = 0;
    double beside = 0;
    double places = 0;
};

} // namespace

double TextureAndNoise::between(const std::vector<double>& values, double distance) {
    const double last = static_cast<double>(values.size() - 1);
    const double at = std::min(std::abs(distance), last);
    const auto before = static_cast<std::size_t>(at);
    return before + 1 < values.size() ? std::lerp(values[before], values[before + 1], at - static_cast<double>(before))
                                      : values.back();
}

std::optional<TextureAndNoise> FocusProbes::texture_and_noise(const std::vector<double>& axial_weights,
                                                              const NoiseModel& model,
                                                              const NoiseCorrelation& correlation) const {
    constexpr std::size_t least_probes = 9, patches_a_probe = 4, white_patches = 1024, partners = 8;
    constexpr int most_offsets = 8; // on either side
    const WindowResponses responses(measure_, window_, channels_);
    const auto side = static_cast<std::size_t>(responses.patch_side());
    const std::size_t values = static_cast<std::size_t>(channels_) * side * side;
    std::vector<std::size_t> whole;
    for (std::size_t k = 0; k < probes_.size(); ++k) {
        if (probes_[k].columns == responses.patch_side() && probes_[k].rows == responses.patch_side()) {
            whole.push_back(k);
        }
    }
    if (whole.size() < least_probes || images_ < 3) {
        return std::nullopt;
    }
    const Scale scale = this->scale();
    const auto level_of = [&](const double* patch) {
        return std::accumulate(patch, patch + values, 0.0) / static_cast<double>(values);
    };

    // Responses to patches of noise of one deviation in every pixel.
    std::vector<std::vector<double>> noise;
    if (channels_ == 1 && !correlation.neighbours()) {
        std::mt19937_64 random(0);
        std::normal_distribution<double> normal;
        std::vector<double> patch(values);
        for (std::size_t k = 0; k < white_patches; ++k) {
            std::ranges::generate(patch, [&] { return normal(random); });
            noise.push_back(responses.of(patch));
        }
    } else {
        const auto of_probes = parallel_list(static_cast<int>(whole.size()), [&](int k) {
            const Probe& probe = probes_[whole[static_cast<std::size_t>(k)]];
            const Differences found = differences(probe, 0, scale);
            const std::vector<int> quiet = quiet_images(found.variances, found.sparse);
            std::vector<std::vector<double>> result;
            const std::size_t taken = std::min(patches_a_probe, quiet.size());
            for (std::size_t m = 0; m < taken; ++m) {
                const int image = quiet[(2 * m + 1) * quiet.size() / (2 * taken)];
                std::vector<double> patch(values);
                double level = 0;
                for (std::size_t pixel = 0; pixel < values; ++pixel) {
                    patch[pixel] = second_difference(probe, image, pixel, scale).value_or(0);
                    level +=
                        probe.values[static_cast<std::size_t>(image) * values + pixel] / static_cast<double>(values);
                }
                const double deviation = std::sqrt(6 * model.variance(level));
                if (deviation > 0) {
                    for (double& value : patch) {
                        value /= deviation;
                    }
                    result.push_back(responses.of(patch));
                }
            }
            return result;
        });
        for (const auto& patches : of_probes) {
            noise.insert(noise.end(), patches.begin(), patches.end());
        }
    }
    if (noise.size() < 4 * least_probes) {
        return std::nullopt;
    }
    TextureAndNoise result;
    double pairs = 0, product_squares = 0;
    for (std::size_t k = 0; k < noise.size(); ++k) {
        result.noise_energy += responses.energy(noise[k]) / static_cast<double>(noise.size());
        const auto slopes = responses.slopes(noise[k]);
        for (std::size_t partner = 1; partner <= partners / 2; ++partner) {
            // Patches of one probe follow each other.
            const auto& other = noise[(k + patches_a_probe * partner * 7 + 1) % noise.size()];
            const double product = responses.product(slopes, other);
            product_squares += product * product;
            pairs += 1;
        }
    }
    const bool laplacian = measure_ == FocusMeasure::modified_laplacian;
    result.alone = 0.5 * product_squares / pairs / (laplacian ? 1 : result.noise_energy);

    // Texture around the maximum of every probe's curve.
    const int radius = static_cast<int>(axial_weights.size()) - 1;
    const double width = curve_width();
    const double aligned = topography::suitable_smoothing(width, images_);
    const Means means = means_of(radius > 0 ? axial_weights : topography::axial_weights(aligned), images_);
    double kept = 0; // of the noise's variance by the average of the images
    for (const Share& share : axial_shares(axial_weights, 2 * radius, 4 * radius + 1)) {
        kept += static_cast<double>(share.weight) * static_cast<double>(share.weight);
    }
    const int reach = radius + 2;
    const int apart =
        std::max({1, static_cast<int>(std::lround(width / 2)), (reach + most_offsets - 1) / most_offsets});
    const int offsets = (reach + apart - 1) / apart;
    struct OfProbe {
        std::vector<Sums> sums;
        double bend = std::numeric_limits<double>::quiet_NaN();
        double variance = 0;
        double noise_share = 0;
    };
    const auto of_probes = parallel_list(static_cast<int>(whole.size()), [&](int k) {
        const Probe& probe = probes_[whole[static_cast<std::size_t>(k)]];
        OfProbe found{.sums = std::vector<Sums>(static_cast<std::size_t>(offsets) + 1)};
        const std::vector<double> here =
            radius > 0 ? curve(probe, images_in_order(images_), means) : averaged_singles(probe, means);
        const auto at = static_cast<int>(std::ranges::max_element(here) - here.begin());
        if (at == 0 || at + 1 == images_) {
            return found;
        }
        {
            const std::vector<double>& bent = radius > 0 ? here : probe.singles;
            const auto top = static_cast<std::size_t>(
                std::clamp(static_cast<int>(std::ranges::max_element(bent) - bent.begin()), 1, images_ - 2));
            found.bend = (2 * bent[top] - bent[top - 1] - bent[top + 1]) / bent[top];
        }
        const auto mean_of = [&](const std::vector<Share>& shares) {
            std::vector<double> mean(values);
            for (const auto& [image, weight] : shares) {
                const float* from = probe.values.data() + static_cast<std::size_t>(image) * values;
                for (std::size_t pixel = 0; pixel < values; ++pixel) {
                    mean[pixel] += static_cast<double>(weight) * static_cast<double>(from[pixel]);
                }
            }
            const double level = level_of(mean.data());
            for (double& value : mean) {
                value = level > 0 ? value / level : 0;
            }
            return mean;
        };
        const auto around = mean_of(axial_shares(axial_weights, at, images_));
        const double whole_energy = responses.energy(responses.of(around));
        if (!(whole_energy > 0)) {
            return found;
        }
        double level = 0;
        for (std::size_t pixel = 0; pixel < values; ++pixel) {
            level += probe.values[static_cast<std::size_t>(at) * values + pixel] / static_cast<double>(values);
        }
        found.variance = level > 0 ? model.variance(level) / (level * level) : 0;
        const double noise_here = level > 0 ? kept * model.variance(level) / (level * level) * result.noise_energy : 0;
        for (int offset = -offsets; offset <= offsets; ++offset) {
            const int image = at + offset * apart;
            if (image < 0 || image >= images_) {
                continue;
            }
            Sums& sums = found.sums[static_cast<std::size_t>(std::abs(offset))];
            for (const Halves& halves : halves_at(axial_weights, image, images_)) {
                if (halves.one.empty() || halves.other.empty()) {
                    continue;
                }
                const auto one = responses.of(mean_of(halves.one)), other = responses.of(mean_of(halves.other));
                double energy = 0, beside = 0;
                const auto first = (static_cast<std::size_t>(k) * 37 + 1) * partners;
                if (laplacian) {
                    const auto all = responses.of(mean_of(axial_shares(axial_weights, image, images_)));
                    const auto slopes_one = responses.slopes(one), slopes_other = responses.slopes(other),
                               slopes = responses.slopes(all);
                    energy = std::max(0.0, responses.energy(all) - noise_here);
                    for (std::size_t m = 0; m < partners; ++m) {
                        const auto& patch = noise[(first + m * 5) % noise.size()];
                        const double of_all = responses.product(slopes, patch);
                        beside += 0.5 *
                                  (of_all * of_all +
                                   responses.product(slopes_one, patch) * responses.product(slopes_other, patch)) /
                                  static_cast<double>(partners);
                    }
                    // Of F itself, with what noise alone adds: without it, and times F^2.
                    beside = beside * responses.energy(all) - noise_here * result.alone;
                } else {
                    energy = responses.product(one, other);
                    for (std::size_t m = 0; m < partners; ++m) {
                        const auto& patch = noise[(first + m * 5) % noise.size()];
                        beside += responses.product(one, patch) * responses.product(other, patch) /
                                  static_cast<double>(partners);
                    }
                }
                sums.energy += energy / (whole_energy * whole_energy);
                sums.beside += beside / (whole_energy * whole_energy);
                sums.places += 1;
            }
        }
        return found;
    });
    std::vector<Sums> sums(static_cast<std::size_t>(offsets) + 1);
    std::vector<double> bends;
    for (const OfProbe& found : of_probes) {
        for (std::size_t offset = 0; offset < sums.size(); ++offset) {
            sums[offset].energy += found.sums[offset].energy;
            sums[offset].beside += found.sums[offset].beside;
            sums[offset].places += found.sums[offset].places;
        }
        if (std::isfinite(found.bend)) {
            bends.push_back(found.bend);
            result.variance += found.variance;
            result.share -= found.noise_share;
        }
    }
    if (!(sums[0].energy > 0) || !(sums[0].beside > 0) || bends.size() < least_probes) {
        return std::nullopt;
    }
    const double mean_bend = std::accumulate(bends.begin(), bends.end(), 0.0) / static_cast<double>(bends.size());
    for (const double bend : bends) {
        result.bend_variance += (bend - mean_bend) * (bend - mean_bend) / static_cast<double>(bends.size() - 1);
    }
    result.variance /= static_cast<double>(bends.size());
    const double top = sums[0].energy / sums[0].places;
    result.share = 1 + result.share / static_cast<double>(bends.size());
    std::vector<double> energy, beside;
    for (const Sums& here : sums) {
        const bool any = here.places > 0 && here.energy > 0;
        energy.push_back(here.places > 0 ? std::clamp(here.energy / here.places / top, 0.0, 1.0) : energy.back());
        beside.push_back(any && here.beside > 0 ? here.beside / here.energy : beside.back());
    }
    for (int image = 0; image <= offsets * apart; ++image) {
        const auto before = static_cast<std::size_t>(image / apart);
        const std::size_t after = std::min(before + 1, energy.size() - 1);
        // What fades as a Gaussian is straight by the square of the distance, in its logarithm.
        const double from = static_cast<double>(before) * apart, to = from + apart;
        const double rest = (image * image - from * from) / (to * to - from * from);
        const bool fades = energy[before] > 0 && energy[after] > 0;
        result.energy.push_back(fades ? std::exp(std::lerp(std::log(energy[before]), std::log(energy[after]), rest))
                                      : std::lerp(energy[before], energy[after], rest));
        result.beside.push_back(std::lerp(beside[before], beside[after], rest));
    }
    return result;
}

} // namespace vkfv::topography
