// Responses of the masks of a focus measure to a patch of an image.
#pragma once

#include "topography/focus_measure.hpp"
#include "topography/noise/focus_masks.hpp"

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace vkfv::topography {

// Responses of a patch to every channel's masks, in the window around its middle.
class WindowResponses {
  public:
    WindowResponses(FocusMeasure measure, const FocusWindow& window, int channels)
        : laplacian_(measure == FocusMeasure::modified_laplacian),
          magnitudes_(focus::f64::focus_adds_magnitudes(static_cast<int>(measure))),
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
    // True if the measure adds magnitudes, not energies.
    bool magnitudes() const { return magnitudes_; }

    // The responses to a patch. patch: all channels, patch_side() squared pixels each.
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

    // The weights of noise in the measure: the responses, or their directions where magnitudes are added.
    std::vector<double> slopes(const std::vector<double>& responses) const {
        if (!magnitudes_) {
            return responses;
        }
        std::vector<double> result(responses.size());
        for (std::size_t pixel = 0; pixel < weights_.size(); ++pixel) {
            const double whole = magnitude(responses, pixel);
            for (std::size_t channel = 0; channel < static_cast<std::size_t>(channels_) && whole > 0; ++channel) {
                const double share = of_channel(responses, channel, pixel) / whole;
                for (std::size_t mask = 0; mask < masks_.size(); ++mask) {
                    const std::size_t at = (channel * masks_.size() + mask) * weights_.size() + pixel;
                    const double sign = responses[at] > 0 ? 1.0 : responses[at] < 0 ? -1.0 : 0.0;
                    result[at] = laplacian_ ? share * sign : responses[at] / whole;
                }
            }
        }
        return result;
    }

    // The window's mean of the product, summed over masks and channels, divided by the number of channels as in the
    // measure.
    double product(const std::vector<double>& a, const std::vector<double>& b) const {
        double sum = 0;
        for (std::size_t field = 0; field < a.size(); field += weights_.size()) {
            for (std::size_t pixel = 0; pixel < weights_.size(); ++pixel) {
                sum += weights_[pixel] * a[field + pixel] * b[field + pixel];
            }
        }
        return sum / (magnitudes_ ? std::sqrt(channels_) : channels_);
    }

    // The square of the measure.
    double energy(const std::vector<double>& responses) const {
        if (!magnitudes_) {
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
            const double response = responses[(channel * masks_.size() + mask) * weights_.size() + pixel];
            sum += laplacian_ ? std::abs(response) : response * response;
        }
        return laplacian_ ? sum : std::sqrt(sum);
    }
    double magnitude(const std::vector<double>& responses, std::size_t pixel) const {
        double squares = 0;
        for (std::size_t channel = 0; channel < static_cast<std::size_t>(channels_); ++channel) {
            squares += std::pow(of_channel(responses, channel, pixel), 2);
        }
        return std::sqrt(squares);
    }

    bool laplacian_, magnitudes_, deviation_;
    std::vector<Mask> masks_;
    int channels_;
    int side_;
    std::vector<double> weights_;
};

} // namespace vkfv::topography
