#include "topography/noise/texture_and_noise.hpp"

#include "core/threads/parallel_list.hpp"
#include "topography/focus_probes.hpp"
#include "topography/noise/image_halves.hpp"
#include "topography/noise/quiet_images.hpp"
#include "topography/noise/window_responses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

namespace vkfv::topography {

namespace {

// Sums from a probe at one distance from its maximum, over the square of the energy at the maximum, since noise
// contributes to the variance of a height in this proportion.
struct Sums {
    double energy = 0;
    double beside = 0;
    double places = 0;
};

struct TextureOfProbe {
    std::vector<Sums> sums{}; // by distance from the maximum
    double bend = 0;
    double variance = 0;
    double noise_share = 0; // share of the energy at the maximum
    bool found = false;
};

// The share of the noise's variance that the average of the images keeps.
double kept_by(const std::vector<double>& axial_weights) {
    const int radius = static_cast<int>(axial_weights.size()) - 1;
    double kept = 0;
    for (const Share& share : axial_shares(axial_weights, 2 * radius, 4 * radius + 1)) {
        kept += static_cast<double>(share.weight) * static_cast<double>(share.weight);
    }
    return kept;
}

constexpr std::size_t least_probes = 9, patches_a_probe = 4, partners = 8;

// Finds the energy of noise alone, and the variance of the measure by it.
void find_noise(const WindowResponses& responses, const std::vector<std::vector<double>>& noise,
                TextureAndNoise& result) {
    double pairs = 0, squares = 0;
    for (std::size_t k = 0; k < noise.size(); ++k) {
        result.noise_energy += responses.energy(noise[k]) / static_cast<double>(noise.size());
        const auto slopes = responses.slopes(noise[k]);
        for (std::size_t partner = 1; partner <= partners / 2; ++partner) {
            constexpr std::size_t apart = 7 * patches_a_probe; // skips the consecutive patches of one probe
            squares += std::pow(responses.product(slopes, noise[(k + apart * partner + 1) % noise.size()]), 2);
            pairs += 1;
        }
    }
    result.alone = 0.5 * squares / pairs / (responses.magnitudes() ? 1 : result.noise_energy);
}

// Averages the sums of all probes for every distance of an image from the maximum; apart: images between two distances.
bool add_up(const std::vector<TextureOfProbe>& probes, int apart, TextureAndNoise& result) {
    std::vector<Sums> sums(probes.front().sums.size());
    double count = 0, bends = 0, squares = 0, noise_share = 0;
    for (const TextureOfProbe& probe : probes) {
        if (!probe.found) {
            continue;
        }
        for (std::size_t k = 0; k < sums.size(); ++k) {
            sums[k].energy += probe.sums[k].energy;
            sums[k].beside += probe.sums[k].beside;
            sums[k].places += probe.sums[k].places;
        }
        count += 1;
        bends += probe.bend;
        squares += probe.bend * probe.bend;
        noise_share += probe.noise_share;
        result.variance += probe.variance;
    }
    if (count < static_cast<double>(least_probes) || !(sums[0].energy > 0) || !(sums[0].beside > 0)) {
        return false;
    }
    result.variance /= count;
    result.share = 1 - noise_share / count;
    result.bend_variance = std::max(0.0, squares - bends * bends / count) / (count - 1);
    std::vector<double> energy, beside;
    for (const Sums& here : sums) {
        const bool any = here.places > 0 && here.energy > 0;
        const double top = sums[0].energy / sums[0].places;
        energy.push_back(here.places > 0 ? std::clamp(here.energy / here.places / top, 0.0, 1.0) : energy.back());
        beside.push_back(any && here.beside > 0 ? here.beside / here.energy : beside.back());
    }
    for (int image = 0; image <= apart * (static_cast<int>(sums.size()) - 1); ++image) {
        const auto before = static_cast<std::size_t>(image / apart);
        const std::size_t after = std::min(before + 1, energy.size() - 1);
        // The logarithm of a Gaussian is linear in the squared distance, so this is interpolated.
        const double from = static_cast<double>(before) * apart, to = from + apart;
        const double rest = (image * image - from * from) / (to * to - from * from);
        const bool fades = energy[before] > 0 && energy[after] > 0;
        result.energy.push_back(fades ? std::exp(std::lerp(std::log(energy[before]), std::log(energy[after]), rest))
                                      : std::lerp(energy[before], energy[after], rest));
        result.beside.push_back(std::lerp(beside[before], beside[after], rest));
    }
    return true;
}

} // namespace

double TextureAndNoise::between(const std::vector<double>& values, double distance) {
    const double last = static_cast<double>(values.size() - 1);
    const double at = std::min(std::abs(distance), last);
    const auto before = static_cast<std::size_t>(at);
    return before + 1 < values.size() ? std::lerp(values[before], values[before + 1], at - static_cast<double>(before))
                                      : values.back();
}

double FocusProbes::variance_over(const NoiseModel& model, const std::vector<std::size_t>& places) const {
    if (images_ < least_images_for_correlation) {
        return 1;
    }
    const Scale scale = this->scale();
    const auto of_probes = parallel_list(static_cast<int>(places.size()), [&](int k) {
        const Differences found = differences(probes_[places[static_cast<std::size_t>(k)]], 0, scale);
        const double expected = model.variance(found.level);
        const std::vector<int> quiet = quiet_images(found.variances, found.sparse);
        double sum = 0;
        for (const int image : quiet) {
            sum += found.variances[static_cast<std::size_t>(image - 1)];
        }
        return quiet.empty() || !(expected > 0) ? 1.0 : sum / static_cast<double>(quiet.size()) / expected;
    });
    const double mean =
        std::accumulate(of_probes.begin(), of_probes.end(), 0.0) / static_cast<double>(of_probes.size());
    return std::isfinite(mean) ? mean : 1;
}

std::vector<std::vector<double>> FocusProbes::noise_responses(const WindowResponses& responses,
                                                              const std::vector<std::size_t>& places,
                                                              const NoiseModel& model,
                                                              const NoiseCorrelation& correlation) const {
    const std::size_t values = static_cast<std::size_t>(channels_) * probes_[places.front()].pixels();
    std::vector<std::vector<double>> noise;
    if (channels_ == 1 && !correlation.neighbours()) {
        constexpr std::size_t most = 1024, most_values = std::size_t{1} << 21;
        const std::size_t patches = std::clamp<std::size_t>(most_values / values, most / 8, most);
        std::mt19937_64 random(0);
        std::normal_distribution<double> normal;
        std::vector<double> patch(values);
        const double deviation = std::sqrt(variance_over(model, places));
        for (std::size_t k = 0; k < patches; ++k) {
            std::ranges::generate(patch, [&] { return deviation * normal(random); });
            noise.push_back(responses.of(patch));
        }
        return noise;
    }
    const Scale scale = this->scale();
    const auto of_probes = parallel_list(static_cast<int>(places.size()), [&](int k) {
        const Probe& probe = probes_[places[static_cast<std::size_t>(k)]];
        const Differences found = differences(probe, 0, scale);
        const std::vector<int> quiet =
            found.variances.empty() ? std::vector<int>() : quiet_images(found.variances, found.sparse);
        std::vector<std::vector<double>> result;
        const std::size_t taken = std::min(patches_a_probe, quiet.size());
        for (std::size_t m = 0; m < taken; ++m) {
            const int image = quiet[(2 * m + 1) * quiet.size() / (2 * taken)];
            const float* from = probe.values.data() + static_cast<std::size_t>(image) * values;
            constexpr double gain = 1 + 4 + 1; // factor of the second difference on the variance of independent values
            const double level = std::accumulate(from, from + values, 0.0) / static_cast<double>(values);
            const double deviation = std::sqrt(gain * model.variance(level));
            if (!(deviation > 0)) {
                continue;
            }
            std::vector<double> patch(values);
            for (std::size_t pixel = 0; pixel < values; ++pixel) {
                patch[pixel] = second_difference(probe, image, pixel, scale).value_or(0) / deviation;
            }
            result.push_back(responses.of(patch));
        }
        return result;
    });
    for (const auto& patches : of_probes) {
        noise.insert(noise.end(), patches.begin(), patches.end());
    }
    return noise;
}

std::vector<double> FocusProbes::mean_patch(const Probe& probe, const std::vector<Share>& shares) const {
    const std::size_t values = static_cast<std::size_t>(channels_) * probe.pixels();
    std::vector<double> mean(values);
    for (const auto& [image, weight] : shares) {
        const float* from = probe.values.data() + static_cast<std::size_t>(image) * values;
        for (std::size_t pixel = 0; pixel < values; ++pixel) {
            mean[pixel] += static_cast<double>(weight) * static_cast<double>(from[pixel]);
        }
    }
    const double level = std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(values);
    for (double& value : mean) {
        value = level > 0 ? value / level : 0;
    }
    return mean;
}

std::optional<TextureAndNoise> FocusProbes::texture_and_noise(const std::vector<double>& axial_weights,
                                                              const NoiseModel& model,
                                                              const NoiseCorrelation& correlation) const {
    const WindowResponses responses(measure_, window_, channels_);
    std::vector<std::size_t> places; // probes whose patch lies in the image
    for (std::size_t k = 0; k < probes_.size(); ++k) {
        if (probes_[k].columns == responses.patch_side() && probes_[k].rows == responses.patch_side()) {
            places.push_back(k);
        }
    }
    if (places.size() < least_probes || images_ < 3) {
        return std::nullopt;
    }
    // Only some places are kept: patches of wide windows overlap, and take long.
    constexpr std::size_t most_pixels = std::size_t{1} << 17;
    const std::size_t kept_places =
        std::clamp<std::size_t>(most_pixels / probes_[places.front()].pixels(), 2 * least_probes, places.size());
    for (std::size_t k = 0; k < kept_places; ++k) {
        places[k] = places[k * places.size() / kept_places];
    }
    places.resize(kept_places);
    const auto noise = noise_responses(responses, places, model, correlation);
    if (noise.size() < 4 * least_probes) {
        return std::nullopt;
    }
    TextureAndNoise result;
    find_noise(responses, noise, result);

    constexpr int most_distances = 8;
    const int radius = static_cast<int>(axial_weights.size()) - 1, reach = radius + 2;
    const double width = curve_width(), kept = kept_by(axial_weights);
    const int apart =
        std::max({1, static_cast<int>(std::lround(width / 2)), (reach + most_distances - 1) / most_distances});
    const int distances = (reach + apart - 1) / apart;
    // If nothing is averaged, this average is used all the same, as noise would choose the maxima.
    const Means means =
        means_of(radius > 0 ? axial_weights : topography::axial_weights(topography::suitable_smoothing(width, images_)),
                 images_);
    const std::size_t values = static_cast<std::size_t>(channels_) * probes_[places.front()].pixels();
    const auto of_probes = parallel_list(static_cast<int>(places.size()), [&](int k) {
        const Probe& probe = probes_[places[static_cast<std::size_t>(k)]];
        TextureOfProbe here{.sums = std::vector<Sums>(static_cast<std::size_t>(distances) + 1)};
        const std::vector<double> smooth =
            radius > 0 ? curve(probe, images_in_order(images_), means) : averaged_singles(probe, means);
        const auto at = static_cast<int>(std::ranges::max_element(smooth) - smooth.begin());
        if (at == 0 || at + 1 == images_) {
            return here;
        }
        const std::vector<double>& bent = radius > 0 ? smooth : probe.singles;
        const auto top = static_cast<std::size_t>(
            std::clamp(static_cast<int>(std::ranges::max_element(bent) - bent.begin()), 1, images_ - 2));
        here.bend = bent[top] > 0 ? (2 * bent[top] - bent[top - 1] - bent[top + 1]) / bent[top] : 0;
        const auto responses_of = [&](const std::vector<Share>& shares) {
            return responses.of(mean_patch(probe, shares));
        };
        const double whole = responses.energy(responses_of(axial_shares(axial_weights, at, images_)));
        const float* focused = probe.values.data() + static_cast<std::size_t>(at) * values;
        const double level = std::accumulate(focused, focused + values, 0.0) / static_cast<double>(values);
        if (!(whole > 0) || !(level > 0)) {
            return here;
        }
        here.found = true;
        here.variance = model.variance(level) / (level * level);
        const double noise_here = kept * here.variance * result.noise_energy;
        here.noise_share = std::min(1.0, noise_here / whole);
        const auto patch = [&](std::size_t m) -> const std::vector<double>& {
            return noise[((static_cast<std::size_t>(k) * 37 + 1) * partners + m * 5) % noise.size()];
        };
        const auto beside = [&](const std::vector<double>& one, const std::vector<double>& other) {
            double sum = 0;
            for (std::size_t m = 0; m < partners; ++m) {
                sum += responses.product(one, patch(m)) * responses.product(other, patch(m));
            }
            return sum / static_cast<double>(partners);
        };
        for (int distance = -distances; distance <= distances; ++distance) {
            const int image = at + distance * apart;
            if (image < 0 || image >= images_) {
                continue;
            }
            Sums& sums = here.sums[static_cast<std::size_t>(std::abs(distance))];
            for (const Halves& halves : halves_at(axial_weights, image, images_)) {
                if (halves.one.empty() || halves.other.empty()) {
                    continue;
                }
                const auto one = responses_of(halves.one), other = responses_of(halves.other);
                double energy = 0, product = 0;
                if (responses.magnitudes()) {
                    const auto all = responses_of(axial_shares(axial_weights, image, images_));
                    const auto slopes = responses.slopes(all);
                    const double square = responses.energy(all);
                    energy = std::max(0.0, square - noise_here);
                    // The product contains the variance of F itself, times F^2; noise's own part is subtracted.
                    product = 0.5 * square *
                                  (beside(slopes, slopes) + beside(responses.slopes(one), responses.slopes(other))) -
                              noise_here * result.alone;
                } else {
                    energy = responses.product(one, other);
                    product = beside(one, other);
                }
                sums.energy += energy / (whole * whole);
                sums.beside += product / (whole * whole);
                sums.places += 1;
            }
        }
        return here;
    });
    return add_up(of_probes, apart, result) ? std::optional(result) : std::nullopt;
}

} // namespace vkfv::topography
