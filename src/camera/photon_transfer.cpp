#include "camera/photon_transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::camera {

namespace {

constexpr int bands = 16;
// An exposure so short that dark current does not contribute to the measurements with light.
constexpr double short_exposure = 1e-5;    // s
constexpr double beyond_saturation = 1.15; // end of the series, relative to the full well
constexpr int peak_exposures = 25;
constexpr double peak_reach = 1.5; // in standard deviations of the charge about the largest variance
constexpr int dark_exposures = 6;
constexpr double dark_share = 0.05; // dark charge at the longest exposure, relative to the full well
constexpr double flat_share = 0.5;  // charge of the flat stack, relative to the full well

int band_of(int row, int rows) {
    return row * bands / rows;
}

std::vector<PairSums> sums_of_pair(const Grid<float>& a, const Grid<float>& b) {
    std::vector<PairSums> sums(bands);
    for (int row = 0; row < a.rows; ++row) {
        PairSums& sum = sums[static_cast<std::size_t>(band_of(row, a.rows))];
        for (int column = 0; column < a.columns; ++column) {
            const double one = a(column, row), other = b(column, row);
            sum.pixels += 1;
            sum.sum += one + other;
            sum.difference += one - other;
            sum.squared_difference += (one - other) * (one - other);
        }
    }
    return sums;
}

// Sums of each pixel over a stack, accumulated image by image, for its mean and variance.
class GrowingStack {
  public:
    GrowingStack(int columns, int rows) : sum_(columns, rows), square_(columns, rows) {}

    void add(const Grid<float>& image) {
        ++images_;
        for (std::size_t k = 0; k < image.values.size(); ++k) {
            const double value = image.values[k]; // whole number, so that sums of squares are exact
            sum_.values[k] += value;
            square_.values[k] += value * value;
        }
    }
    std::vector<StackSums> sums() const {
        std::vector<StackSums> sums(bands);
        for (int row = 0; row < sum_.rows; ++row) {
            StackSums& sum = sums[static_cast<std::size_t>(band_of(row, sum_.rows))];
            for (int column = 0; column < sum_.columns; ++column) {
                const double mean = sum_(column, row) / images_;
                sum.pixels += 1;
                sum.mean += mean;
                sum.squared_mean += mean * mean;
                sum.variance += (square_(column, row) - images_ * mean * mean) / (images_ - 1);
            }
        }
        return sums;
    }

  private:
    Grid<double> sum_, square_;
    double images_ = 0;
};

// Takes the images in sequence; each has its own random numbers.
class Laboratory {
  public:
    Laboratory(const Camera& camera, const PhotonTransferOptions& options, const ImageTaker& take)
        : camera_(camera), options_(options), take_(take),
          pattern_(camera.fixed_pattern(options.columns, options.rows)) {}

    Grid<float> image(const TakenImage& what) {
        const Grid<double> flux(options_.columns, options_.rows,
                                what.photons / camera_.photons_per_joule() / what.exposure_time);
        auto image = camera_.image(flux, what.exposure_time, next_image_++, pattern_);
        if (take_) {
            take_(what, image);
        }
        return image;
    }
    PairLevel pair(const std::string& name, const std::string& series, double photons, double exposure_time) {
        const auto a = image({name + "_a", series, photons, exposure_time});
        const auto b = image({name + "_b", series, photons, exposure_time});
        return {.photons = photons, .exposure_time = exposure_time, .bands = sums_of_pair(a, b)};
    }
    std::vector<StackSums> stack(const std::string& name, const std::string& series, double photons) {
        GrowingStack stack(options_.columns, options_.rows);
        for (int k = 0; k < options_.averaged; ++k) {
            stack.add(image({fmt::format("{}_{:03}", name, k), series, photons, short_exposure}));
        }
        return stack.sums();
    }

  private:
    const Camera& camera_;
    const PhotonTransferOptions& options_;
    const ImageTaker& take_;
    FixedPattern pattern_;
    std::uint32_t next_image_ = 0;
};

// The photons at the level of largest variance, smoothed with half weights on its two neighbours.
double photons_of_largest_variance(const std::vector<PairLevel>& series) {
    double largest = 0, photons = 0;
    for (std::size_t k = 1; k + 1 < series.size(); ++k) {
        const double variance =
            temporal_variance(series[k - 1]) + 2 * temporal_variance(series[k]) + temporal_variance(series[k + 1]);
        if (variance > largest) {
            largest = variance;
            photons = series[k].photons;
        }
    }
    return photons;
}

} // namespace

PhotonTransferData measure_photon_transfer(const Camera& measured, const PhotonTransferOptions& options,
                                           const ImageTaker& take) {
    const Camera camera = measured.of_single_frames();
    Laboratory laboratory(camera, options, take);
    PhotonTransferData data;
    const double full_well = camera.options().full_well;
    const double efficiency = camera.quantum_efficiency();
    const double step = beyond_saturation * full_well / efficiency / (options.exposures - 1);
    for (int k = 0; k < options.exposures; ++k) {
        data.series.push_back(laboratory.pair(fmt::format("transfer_{:03}", k), "transfer", k * step, short_exposure));
    }
    const double coarse_peak = photons_of_largest_variance(data.series);
    const double fine_step = peak_reach * std::sqrt(coarse_peak * efficiency) / efficiency * 2 / (peak_exposures - 1);
    const auto about = [&](double middle, double distance, const char* name) {
        std::vector<PairLevel> levels;
        for (int k = 0; k < peak_exposures; ++k) {
            levels.push_back(laboratory.pair(fmt::format("{}_{:03}", name, k), name,
                                             middle + (k - peak_exposures / 2) * distance, short_exposure));
        }
        return levels;
    };
    // A cubic only approximates the peak, with the same error wherever the peak is in the middle of the levels; so the
    // peak found is measured again.
    const auto wide = about(coarse_peak, std::max(fine_step, 2 * step / (peak_exposures - 1)), "search");
    const auto middle = about(photons_of_largest_variance(wide), fine_step, "middle");
    data.peak = about(photons_of_peak(middle), fine_step, "peak");
    if (const double current = camera.options().dark_current; current > 0) {
        for (int k = 1; k <= dark_exposures; ++k) {
            data.dark.push_back(laboratory.pair(fmt::format("dark_{:03}", k), "dark current", 0,
                                                dark_share * full_well / current * k / dark_exposures));
        }
    }
    data.averaged = options.averaged;
    data.dark_stack = laboratory.stack("dark_stack", "dark stack", 0);
    data.flat_photons = flat_share * full_well / efficiency;
    data.flat_stack = laboratory.stack("flat_stack", "flat stack", data.flat_photons);
    return data;
}

double mean_value(const PairLevel& level, int left_out) {
    double pixels = 0, sum = 0;
    for (int band = 0; band < bands; ++band) {
        if (band != left_out) {
            pixels += level.bands[static_cast<std::size_t>(band)].pixels;
            sum += level.bands[static_cast<std::size_t>(band)].sum;
        }
    }
    return sum / 2 / pixels;
}

double temporal_variance(const PairLevel& level, int left_out) {
    double pixels = 0, difference = 0, square = 0;
    for (int band = 0; band < bands; ++band) {
        if (band != left_out) {
            const PairSums& sums = level.bands[static_cast<std::size_t>(band)];
            pixels += sums.pixels;
            difference += sums.difference;
            square += sums.squared_difference;
        }
    }
    return square / 2 / pixels - difference / pixels * (difference / pixels) / 2;
}

} // namespace vkfv::camera
