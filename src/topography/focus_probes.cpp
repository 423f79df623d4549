#include "topography/focus_probes.hpp"

#include "core/threads/parallel_list.hpp"
#include "topography/noise/quiet_images.hpp"
#include "topography/topography.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace vkfv::topography {
namespace {

constexpr int reach = 2; // pixels by which the measures' masks reach beyond the window
constexpr std::size_t most_values = std::size_t{1} << 25;

using SharesAt = std::vector<Share> (*)(const std::vector<double>& weights, int at, int images);

std::vector<std::vector<Share>> all_shares(SharesAt shares_at, const std::vector<double>& axial_weights, int images) {
    std::vector<std::vector<Share>> all;
    all.reserve(static_cast<std::size_t>(images));
    for (int at = 0; at < images; ++at) {
        all.push_back(shares_at(axial_weights, at, images));
    }
    return all;
}

std::vector<double> averaged(const std::vector<double>& values, const std::vector<std::vector<Share>>& means) {
    std::vector<double> result;
    for (const auto& shares : means) {
        double sum = 0;
        for (const auto& [image, weight] : shares) {
            sum += weight * values[static_cast<std::size_t>(image)];
        }
        result.push_back(sum);
    }
    return result;
}

// Middles of probes, evenly over a side, each with its window and the masks' reach inside the image where it is large
// enough.
std::vector<int> middles(int count, int margin, int most) {
    const int first = std::min(margin, (count - 1) / 2), last = std::max(count - 1 - margin, count / 2);
    const int places = std::min(most, last - first + 1);
    std::vector<int> result;
    for (int k = 0; k < places; ++k) {
        result.push_back(places == 1 ? (first + last) / 2 : first + (last - first) * k / (places - 1));
    }
    return result;
}

// The least-squares line through points (x, y) with neither coefficient negative.
NoiseModel fitted(const std::vector<double>& x, const std::vector<double>& y) {
    const auto count = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
    const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
    double xx = 0, xy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
    const double slope = xx > 0 ? std::max(0.0, xy / xx) : 0;
    const double constant = mean_y - slope * mean_x;
    return constant >= 0 ? NoiseModel{.constant = constant, .slope = slope}
                         : NoiseModel{.constant = 0, .slope = mean_x > 0 ? mean_y / mean_x : 0};
}

double variance_of(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double variance = 0;
    for (const double value : values) {
        variance += (value - mean) * (value - mean) / count;
    }
    return variance;
}

// The correlation of values with their neighbours: 0 if they have no order, 1 for a smooth curve.
double neighbours_alike(const std::vector<double>& values) {
    const double variance = variance_of(values);
    double steps = 0;
    for (std::size_t k = 1; k < values.size(); ++k) {
        steps += (values[k] - values[k - 1]) * (values[k] - values[k - 1]) / static_cast<double>(values.size() - 1);
    }
    return variance > 0 ? std::max(0.0, 1 - steps / (2 * variance)) : 0;
}

// The correlation of a patch with another that is shifted by (dx, dy) pixels, where both overlap.
double correlation_at(const std::vector<double>& a, const std::vector<double>& b, int columns, int rows, int dx,
                      int dy) {
    double product = 0, square_a = 0, square_b = 0;
    for (int row = std::max(0, -dy); row < std::min(rows, rows - dy); ++row) {
        for (int column = std::max(0, -dx); column < std::min(columns, columns - dx); ++column) {
            const double of_a = a[static_cast<std::size_t>(row * columns + column)];
            const double of_b = b[static_cast<std::size_t>((row + dy) * columns + column + dx)];
            product += of_a * of_b;
            square_a += of_a * of_a;
            square_b += of_b * of_b;
        }
    }
    return square_a > 0 && square_b > 0 ? product / std::sqrt(square_a * square_b) : 0;
}

// The largest correlation of two patches over shifts of up to a third of their sides.
double largest_correlation(const std::vector<double>& a, const std::vector<double>& b, int columns, int rows) {
    const int most_x = columns / 3, most_y = rows / 3;
    double largest = 0;
    for (int dy = -most_y; dy <= most_y; ++dy) {
        for (int dx = -most_x; dx <= most_x; ++dx) {
            largest = std::max(largest, correlation_at(a, b, columns, rows, dx, dy));
        }
    }
    return largest;
}

// True if the mean of the values exceeds 0 by more than chance: by three standard errors, and by a tenth, since blocks
// of compressed noise (`jpeg` and `jpeg colour` of tools/studies/blank_stacks) were alike by 0.08.
bool exceeds_chance(const std::vector<double>& values) {
    constexpr double least = 0.1, errors = 3;
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    return mean > std::max(least, errors * std::sqrt(variance_of(values) / count));
}

// Adds values(p) values(p + k) for every k = (column - reach, row) of sums, over the pixels p of a patch.
void add_products(const std::vector<double>& values, int columns, int rows, Grid<double>& sums) {
    const int reach = sums.columns / 2;
    for (int dy = 0; dy < sums.rows; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            double sum = 0;
            for (int row = 0; row + dy < rows; ++row) {
                const auto here = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
                const auto there = here + static_cast<std::size_t>(dy) * static_cast<std::size_t>(columns);
                for (int column = std::max(0, -dx); column < std::min(columns, columns - dx); ++column) {
                    sum += values[here + static_cast<std::size_t>(column)] *
                           values[there + static_cast<std::size_t>(column + dx)];
                }
            }
            sums(dx + reach, dy) += sum;
        }
    }
}

} // namespace

FocusProbes::FocusProbes(int columns, int rows, FocusMeasure measure, const FocusWindow& window, int most_a_side)
    : measure_(measure), window_(window), pixels_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    const int margin = window.radius() + reach;
    for (const int row : middles(rows, margin, most_a_side)) {
        for (const int column : middles(columns, margin, most_a_side)) {
            Probe& probe = probes_.emplace_back();
            probe.column = std::max(0, column - margin);
            probe.row = std::max(0, row - margin);
            probe.columns = std::min(columns, column + margin + 1) - probe.column;
            probe.rows = std::min(rows, row + margin + 1) - probe.row;
            probe.middle_column = column - probe.column;
            probe.middle_row = row - probe.row;
        }
    }
}

void FocusProbes::add(const Channels& image) {
    channels_ = static_cast<int>(image.size());
    ++images_;
    std::size_t held = 0;
    for (Probe& probe : probes_) {
        for (const Grid<float>& channel : image) {
            for (int row = probe.row; row < probe.row + probe.rows; ++row) {
                const auto first =
                    channel.values.begin() + static_cast<std::ptrdiff_t>(channel.index(probe.column, row));
                probe.values.insert(probe.values.end(), first, first + probe.columns);
            }
        }
        held += probe.values.size();
    }
    follow_singles();
    while (held > most_values && probes_.size() > 1) {
        held = 0;
        std::vector<Probe> every_second;
        for (std::size_t k = 0; k < probes_.size(); k += 2) {
            held += probes_[k].values.size();
            every_second.push_back(std::move(probes_[k]));
        }
        probes_ = std::move(every_second);
    }
}

double FocusProbes::single_of(const Probe& probe, std::size_t image) const {
    const auto pixels = probe.pixels();
    Channels patch(static_cast<std::size_t>(channels_), Grid<float>(probe.columns, probe.rows));
    auto from = probe.values.begin() + static_cast<std::ptrdiff_t>(image * patch.size() * pixels);
    for (auto& channel : patch) {
        std::copy_n(from, pixels, channel.values.begin());
        from += static_cast<std::ptrdiff_t>(pixels);
    }
    return focus_at(patch, measure_, window_, probe.middle_column, probe.middle_row);
}

// Single images are followed as they come, not at the end, for which all threads wait.
void FocusProbes::follow_singles() {
    const auto follow = [&](int k) {
        Probe& probe = probes_[static_cast<std::size_t>(k)];
        probe.singles.push_back(single_of(probe, static_cast<std::size_t>(images_ - 1)));
    };
    constexpr std::size_t pixels_a_thread = std::size_t{1} << 12; // a third of a millisecond
    const std::size_t threads = probes_.size() * probes_.front().pixels() / pixels_a_thread;
    parallel_items(static_cast<int>(probes_.size()), follow, std::max(1, static_cast<int>(threads)));
}

FocusProbes::Means FocusProbes::means_of(const std::vector<double>& axial_weights, int count) {
    const auto shares = all_shares(axial_shares, axial_weights, count);
    return {.images = shares, .curve = shares};
}

std::vector<double> FocusProbes::curve(const Probe& probe, const std::vector<int>& order, const Means& means) const {
    const auto pixels = probe.pixels();
    Channels mean(static_cast<std::size_t>(channels_), Grid<float>(probe.columns, probe.rows));
    std::vector<double> values;
    for (const auto& shares : means.images) {
        for (auto& channel : mean) {
            std::ranges::fill(channel.values, 0.0f);
        }
        for (const auto& [image, weight] : shares) {
            const float* from = probe.values.data() +
                                static_cast<std::size_t>(order[static_cast<std::size_t>(image)]) * mean.size() * pixels;
            for (auto& channel : mean) {
                for (std::size_t k = 0; k < pixels; ++k) {
                    channel.values[k] += weight * from[k];
                }
                from += pixels;
            }
        }
        values.push_back(focus_at(mean, measure_, window_, probe.middle_column, probe.middle_row));
    }
    return averaged(values, means.curve);
}

std::vector<double> FocusProbes::averaged_singles(const Probe& probe, const Means& means) {
    return averaged(probe.singles, means.curve);
}

std::vector<std::vector<double>> FocusProbes::curves_in_order(const Means& means) const {
    const std::vector<int> order = images_in_order(images_);
    std::vector<std::vector<double>> curves(probes_.size());
    parallel_items(static_cast<int>(probes_.size()), [&](int k) {
        curves[static_cast<std::size_t>(k)] = curve(probes_[static_cast<std::size_t>(k)], order, means);
    });
    return curves;
}

double FocusProbes::curve_width() const {
    if (images_ < 4) {
        return 0;
    }
    constexpr int most_lags = 200;
    const int lags = std::min(most_lags, images_ / 2);
    std::vector<double> structure(static_cast<std::size_t>(lags));
    for (const Probe& probe : probes_) {
        const std::vector<double>& values = probe.singles;
        const double variance = variance_of(values);
        // Noise alone shows no width but has a large variance, so curves count by their order over it.
        const double weight = variance > 0 ? neighbours_alike(values) / variance : 0;
        for (int lag = 1; weight > 0 && lag <= lags; ++lag) {
            double sum = 0;
            for (int k = 0; k < images_; ++k) {
                // The pairs go on from the last image to the first: noise and peak have as many pairs at every lag.
                const auto later = static_cast<std::size_t>((k + lag) % images_);
                const double step = values[later] - values[static_cast<std::size_t>(k)];
                sum += step * step;
            }
            structure[static_cast<std::size_t>(lag - 1)] += weight * sum / images_;
        }
    }
    // The width is found by trial; noise and rise follow by linear least squares for every width.
    double best = 0, least = std::numeric_limits<double>::infinity();
    constexpr double finest = 0.3, ratio = 1.05;
    for (double width = finest; width < images_; width *= ratio) {
        std::vector<double> form;
        for (int lag = 1; lag <= lags; ++lag) {
            const int back = images_ - lag;
            form.push_back(1 - std::exp(-lag * lag / (4 * width * width)) -
                           std::exp(-back * back / (4 * width * width)));
        }
        const NoiseModel line = fitted(form, structure);
        double distance = 0;
        for (std::size_t k = 0; k < form.size(); ++k) {
            const double off = line.constant + line.slope * form[k] - structure[k];
            distance += off * off;
        }
        if (line.slope > 0 && distance < least) {
            least = distance;
            best = width;
        }
    }
    return best;
}

std::vector<double> FocusProbes::brightness() const {
    std::vector<double> brightness(static_cast<std::size_t>(images_));
    for (const Probe& probe : probes_) {
        const auto stride = static_cast<std::ptrdiff_t>(probe.values.size() / brightness.size());
        for (std::size_t image = 0; image < brightness.size(); ++image) {
            const auto from = probe.values.begin() + static_cast<std::ptrdiff_t>(image) * stride;
            brightness[image] += std::accumulate(from, from + stride, 0.0) / static_cast<double>(stride);
        }
    }
    const double mean = std::accumulate(brightness.begin(), brightness.end(), 0.0) / images_;
    for (double& value : brightness) {
        value = mean > 0 && value > 0 ? value / mean : 1;
    }
    return brightness;
}

FocusProbes::Scale FocusProbes::scale() const {
    Scale scale{.gains = brightness(), .saturated = saturation().level};
    for (double& gain : scale.gains) {
        gain = 1 / gain;
    }
    return scale;
}

Saturation FocusProbes::saturation() const {
    SaturationCount count;
    for (const Probe& probe : probes_) {
        count.add(probe.values);
    }
    return count.found();
}

std::optional<double> FocusProbes::second_difference(const Probe& probe, int image, std::size_t k,
                                                     const Scale& scale) const {
    const std::size_t stride = static_cast<std::size_t>(channels_) * probe.pixels();
    const auto at = static_cast<std::size_t>(image);
    const float* here = probe.values.data() + at * stride + k;
    const float before = here[-static_cast<std::ptrdiff_t>(stride)], after = here[stride];
    if (std::max({before, *here, after}) >= scale.saturated) {
        return std::nullopt;
    }
    return before * scale.gains[at - 1] - 2.0 * *here * scale.gains[at] + after * scale.gains[at + 1];
}

FocusProbes::Differences FocusProbes::differences(const Probe& probe, std::size_t channel, const Scale& scale) const {
    const auto pixels = probe.pixels();
    Differences found;
    std::size_t all = 0;
    for (int image = 1; image + 1 < images_; ++image) {
        const auto begin = static_cast<std::size_t>(image * channels_) * pixels;
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t k = channel * pixels; k < (channel + 1) * pixels; ++k) {
            if (const auto second = second_difference(probe, image, k, scale)) {
                sum += *second * *second;
                found.level += probe.values[begin + k];
                ++count;
            }
        }
        all += count;
        constexpr double gain = 1 + 4 + 1; // factor of the second difference on the variance of independent values
        // An image with few unsaturated pixels has an uncertain variance, and the smallest ones are used.
        const bool enough = 2 * count >= pixels;
        found.variances.push_back(enough ? sum / static_cast<double>(count) / gain
                                         : std::numeric_limits<double>::infinity());
    }
    if (found.variances.empty()) {
        return found;
    }
    const auto count = static_cast<double>(found.variances.size());
    found.level /= static_cast<double>(std::max<std::size_t>(1, all));
    // If images are mostly dark, the quarter that saw no light is no measure of the noise.
    const auto dark = std::ranges::count(probe.values, 0.0f);
    found.sparse = static_cast<std::size_t>(dark) > probe.values.size() / 2;
    found.variance = found.sparse ? std::accumulate(found.variances.begin(), found.variances.end(), 0.0) / count
                                  : smallest_quarter(found.variances);
    return found;
}

std::vector<FocusProbes::Differences> FocusProbes::all_differences(const Scale& scale) const {
    const auto channels = static_cast<std::size_t>(channels_);
    std::vector<Differences> found(probes_.size() * channels);
    parallel_items(static_cast<int>(found.size()), [&](int k) {
        const auto patch = static_cast<std::size_t>(k);
        found[patch] = differences(probes_[patch / channels], patch % channels, scale);
    });
    return found;
}

NoiseModel FocusProbes::noise() const {
    std::vector<double> levels, variances;
    for (const Differences& found : all_differences(scale())) {
        if (!found.variances.empty() && std::isfinite(found.variance)) {
            levels.push_back(found.level);
            variances.push_back(found.variance);
        }
    }
    return levels.empty() ? NoiseModel{} : fitted(levels, variances);
}

FocusProbes::Products FocusProbes::products_of(const Probe& probe, std::size_t channel, const Scale& scale) const {
    const auto pixels = probe.pixels();
    const Differences found = differences(probe, channel, scale);
    Products products{.images = quiet_images(found.variances, found.sparse),
                      .sums = Grid<double>(2 * NoiseCorrelation::reach + 1, NoiseCorrelation::reach + 1)};
    std::vector<double> second;
    for (const int image : products.images) {
        second.clear();
        for (std::size_t k = channel * pixels; k < (channel + 1) * pixels; ++k) {
            second.push_back(second_difference(probe, image, k, scale).value_or(0));
        }
        add_products(second, probe.columns, probe.rows, products.sums);
    }
    return products;
}

NoiseCorrelation FocusProbes::noise_correlation() const {
    NoiseCorrelation correlation;
    if (images_ < least_images_for_correlation) {
        return correlation;
    }
    const auto channels = static_cast<std::size_t>(channels_);
    std::vector<Products> of_patches(probes_.size() * channels);
    const Scale scale = this->scale();
    parallel_items(static_cast<int>(of_patches.size()), [&](int k) {
        const auto patch = static_cast<std::size_t>(k);
        of_patches[patch] = products_of(probes_[patch / channels], patch % channels, scale);
    });
    constexpr int reach = NoiseCorrelation::reach;
    // Mean products of pairs (dx, dy) apart over each patch's variance, with the number of pairs in all patches.
    Grid<double> products(2 * reach + 1, reach + 1), pairs = products;
    double patches = 0;
    for (std::size_t patch = 0; patch < of_patches.size(); ++patch) {
        const Probe& probe = probes_[patch / channels];
        const auto& [images, sums] = of_patches[patch];
        const double variance = sums(reach, 0) / static_cast<double>(probe.pixels());
        if (!(variance > 0)) {
            continue;
        }
        patches += 1;
        for (int dy = 0; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
                const double here = std::max(0, probe.columns - std::abs(dx)) * std::max(0, probe.rows - dy);
                products(dx + reach, dy) += here > 0 ? sums(dx + reach, dy) / (variance * here) : 0;
                pairs(dx + reach, dy) += here * static_cast<double>(images.size());
            }
        }
    }
    // Patches of small images overlap, and differences of consecutive images are partly correlated, which doubles the
    // products' variance at most.
    const double most_pairs = static_cast<double>(pixels_) * channels_ * images_ / 4.0;
    for (int dy = 0; dy <= reach; ++dy) {
        for (int dx = dy == 0 ? 1 : -reach; dx <= reach; ++dx) {
            const double count = std::min(most_pairs, pairs(dx + reach, dy));
            const double value = patches > 0 ? products(dx + reach, dy) / patches : 0;
            constexpr double significant = 4; // standard deviations: 40 places, each by chance in 16000 stacks
            if (count > 0 && std::abs(value) > significant * std::sqrt(2 / count)) {
                correlation.set(dx, dy, std::clamp(value, -1.0, 1.0));
            }
        }
    }
    return correlation;
}

std::vector<Evidence> FocusProbes::by_chance(const std::vector<double>& axial_weights, double rate) const {
    const Means means = means_of(axial_weights, images_);
    const bool alone = axial_weights.size() == 1; // an image's own value, in any order
    std::vector<Evidence> result(static_cast<std::size_t>(random_orders(rate, alone, images_)));
    parallel_items(static_cast<int>(result.size()), [&](int sample) {
        const auto probe = static_cast<std::size_t>(sample) % probes_.size();
        const std::vector<int> order = random_order(images_, static_cast<std::uint64_t>(sample));
        std::vector<double> singles;
        singles.reserve(order.size());
        for (const int image : order) {
            singles.push_back(probes_[probe].singles[static_cast<std::size_t>(image)]);
        }
        result[static_cast<std::size_t>(sample)] =
            evidence_of(alone ? singles : curve(probes_[probe], order, means), singles);
    });
    return result;
}

Channels FocusProbes::noise_patch(const Probe& probe, int image, double contrast, const Scale& scale) const {
    const auto pixels = probe.pixels();
    std::vector<double> noise(static_cast<std::size_t>(channels_) * pixels);
    for (std::size_t k = 0; k < noise.size(); ++k) {
        noise[k] = second_difference(probe, image, k, scale).value_or(0);
    }
    Channels patch(static_cast<std::size_t>(channels_), Grid<float>(probe.columns, probe.rows, 1.0f));
    const double largest = std::abs(*std::ranges::max_element(noise, {}, [](double v) { return std::abs(v); }));
    if (!(largest > 0)) {
        return {};
    }
    // At this contrast the brightness stays 1, so that the focus measure is proportional to the contrast.
    constexpr double little = 1e-3, most = 0.1;
    const auto fill = [&](double strength) {
        for (std::size_t k = 0; k < noise.size(); ++k) {
            patch[k / pixels].values[k % pixels] = static_cast<float>(1 + strength * noise[k]);
        }
    };
    fill(little / largest);
    const double found = focus_at(patch, measure_, window_, probe.middle_column, probe.middle_row);
    // In images without noise the differences are texture, of which a window may hold hardly any.
    if (!(found > 0) || little * contrast / found > most) {
        return {};
    }
    fill(little / largest * contrast / found);
    return patch;
}

IndependentImages FocusProbes::independent_images(const std::vector<double>& neighbour_weights,
                                                  bool curves_averaged) const {
    constexpr std::size_t least_probes = 9;
    constexpr double contrast = 1e-3; // see noise_patch()
    constexpr int samples = 600;      // for a standard deviation known to a thirtieth
    if (images_ < 3 || probes_.size() < least_probes) {
        return {};
    }
    const Scale scale = this->scale();
    std::vector<std::vector<int>> quiet(probes_.size());
    parallel_items(static_cast<int>(probes_.size()), [&](int k) {
        const auto place = static_cast<std::size_t>(k);
        const Differences found = differences(probes_[place], 0, scale);
        quiet[place] = quiet_images(found.variances, found.sparse);
    });
    const int radius = static_cast<int>(neighbour_weights.size()) - 1;
    const int images = curves_averaged ? 4 * radius + 1 : 2 * radius + 1, middle = images / 2;
    const auto shares = all_shares(axial_shares, neighbour_weights, images);
    const auto& around = shares[static_cast<std::size_t>(middle)];
    double kept = 0;
    for (const auto& [image, weight] : around) {
        kept += static_cast<double>(weight) * static_cast<double>(weight);
    }
    std::vector<double> ratios(samples);
    parallel_items(samples, [&](int sample) {
        std::mt19937_64 random(static_cast<std::uint64_t>(sample));
        const std::vector<int> places = random_order(static_cast<int>(probes_.size()), random());
        std::vector<Channels> patches;
        std::set<std::pair<std::size_t, int>> taken; // a patch that is taken twice agrees with itself
        for (std::size_t k = 0; static_cast<int>(patches.size()) < images && k < 4 * places.size() + 4; ++k) {
            const auto place = static_cast<std::size_t>(places[k % places.size()]);
            const Probe& probe = probes_[place];
            if (quiet[place].empty() || probe.pixels() != probes_.front().pixels() ||
                probe.columns != probes_.front().columns) {
                continue;
            }
            const int image = quiet[place][random() % quiet[place].size()];
            if (!taken.emplace(place, image).second) {
                continue;
            }
            Channels patch = noise_patch(probe, image, contrast, scale);
            if (!patch.empty()) {
                patches.push_back(std::move(patch));
            }
        }
        if (static_cast<int>(patches.size()) < images) {
            return;
        }
        const auto value_at = [&](int at) {
            Channels mean(static_cast<std::size_t>(channels_), Grid<float>(patches[0][0].columns, patches[0][0].rows));
            for (const auto& [image, weight] : shares[static_cast<std::size_t>(at)]) {
                const Channels& from = patches[static_cast<std::size_t>(image)];
                for (std::size_t channel = 0; channel < mean.size(); ++channel) {
                    for (std::size_t k = 0; k < mean[channel].values.size(); ++k) {
                        mean[channel].values[k] += weight * from[channel].values[k];
                    }
                }
            }
            return focus_at(mean, measure_, window_, probes_.front().middle_column, probes_.front().middle_row);
        };
        double value = curves_averaged ? 0 : value_at(middle);
        if (curves_averaged) {
            for (const auto& [at, weight] : around) {
                value += weight * value_at(at);
            }
        }
        ratios[static_cast<std::size_t>(sample)] = value * value / (kept * contrast * contrast);
    });
    std::erase(ratios, 0.0);
    if (ratios.size() < samples / 2) {
        return {};
    }
    const auto count = static_cast<double>(ratios.size());
    IndependentImages found{.mean = std::accumulate(ratios.begin(), ratios.end(), 0.0) / count,
                            .largest = std::ranges::max(ratios)};
    double squares = 0;
    for (const double ratio : ratios) {
        squares += (ratio - found.mean) * (ratio - found.mean);
    }
    found.deviation = std::sqrt(squares / (count - 1));
    return found;
}

double FocusProbes::measure_of_rounding(double brightness) const {
    // With so many values the step between a camera's grey values shows. Floats have hardly any step.
    constexpr std::size_t most = 4096;
    std::vector<float> values;
    for (const Probe& probe : probes_) {
        const std::size_t count = std::min(probe.values.size(), std::max<std::size_t>(1, most / probes_.size()));
        values.insert(values.end(), probe.values.begin(), probe.values.begin() + static_cast<std::ptrdiff_t>(count));
    }
    std::ranges::sort(values);
    float step = std::numeric_limits<float>::infinity();
    for (std::size_t k = 1; k < values.size(); ++k) {
        if (values[k] > values[k - 1]) {
            step = std::min(step, values[k] - values[k - 1]);
        }
    }
    if (!std::isfinite(step) || !(brightness > 0)) {
        return 0;
    }
    std::mt19937_64 random(0);
    Channels patch(static_cast<std::size_t>(channels_), Grid<float>(probes_.front().columns, probes_.front().rows));
    for (Grid<float>& channel : patch) {
        for (float& value : channel.values) {
            const double rounded = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
            value = static_cast<float>(brightness + rounded * step);
        }
    }
    return focus_at(patch, measure_, window_, probes_.front().middle_column, probes_.front().middle_row);
}

bool FocusProbes::reappears(const std::vector<PlaceOfImages>& places) const {
    constexpr std::size_t fewest = 5;
    if (places.size() < fewest) {
        return true;
    }
    std::vector<double> at_its_place(places.size(), 0.0), anywhere(places.size(), 0.0); // excess over another place
    parallel_items(static_cast<int>(places.size()), [&](int k) {
        const auto place = static_cast<std::size_t>(k);
        const PlaceOfImages& here = places[place];
        const PlaceOfImages& other = places[(place + 1) % places.size()];
        const int columns = here.probe->columns, rows = here.probe->rows;
        if (other.probe->columns != columns || other.probe->rows != rows) {
            return;
        }
        const auto all = patterns(*here.probe);
        const auto& image = all[here.image];
        const auto& neighbour = all[here.neighbour];
        const auto of_other = patterns(*other.probe)[other.neighbour];
        at_its_place[place] = correlation_at(image, neighbour, columns, rows, 0, 0) -
                              correlation_at(image, of_other, columns, rows, 0, 0);
        anywhere[place] =
            largest_correlation(image, neighbour, columns, rows) - largest_correlation(image, of_other, columns, rows);
    });
    return exceeds_chance(at_its_place) || exceeds_chance(anywhere);
}

bool FocusProbes::lie_on_a_surface(const std::vector<PlaceOfImages>& places) {
    constexpr double errors_of_chance = 3;
    constexpr double fewest_pairs = 16; // the bound below is a quarter of chance's mean then, and for 9 pairs it is 0
    std::vector<double> images(places.size());
    std::ranges::transform(places, images.begin(),
                           [](const PlaceOfImages& place) { return static_cast<double>(place.image); });
    const double variance = variance_of(images);
    // Half of the mean squared step between independent values is their variance, with a relative standard deviation of
    // 1 / sqrt(pairs) (J. von Neumann, "Distribution of the ratio of the mean square successive difference to the
    // variance", 1941).
    const auto follow_each_other = [&](auto along, auto across, auto extent) {
        double squares = 0, pairs = 0;
        for (const PlaceOfImages& place : places) {
            const PlaceOfImages* beside = nullptr;
            for (const PlaceOfImages& other : places) {
                if (across(*other.probe) == across(*place.probe) &&
                    along(*other.probe) >= along(*place.probe) + extent(*place.probe) &&
                    (beside == nullptr || along(*other.probe) < along(*beside->probe))) {
                    beside = &other;
                }
            }
            if (beside != nullptr) {
                squares += std::pow(static_cast<double>(beside->image) - static_cast<double>(place.image), 2);
                ++pairs;
            }
        }
        return pairs >= fewest_pairs && squares < 2 * pairs * (1 - errors_of_chance / std::sqrt(pairs)) * variance;
    };
    const auto column = [](const Probe& probe) { return probe.column; };
    const auto row = [](const Probe& probe) { return probe.row; };
    return follow_each_other(column, row, [](const Probe& probe) { return probe.columns; }) ||
           follow_each_other(row, column, [](const Probe& probe) { return probe.rows; });
}

std::optional<StrongTexture> FocusProbes::persistence_of_strong_texture(const std::vector<double>& neighbour_weights,
                                                                        bool curves_averaged) const {
    constexpr double least_rise = 8; // rise of the measure along z, over its quiet value
    constexpr double persistent = 0.25;
    constexpr double least_share = 0.02;
    const double mean = [&] {
        double sum = 0;
        for (const Probe& probe : probes_) {
            sum += std::accumulate(probe.values.begin(), probe.values.end(), 0.0) /
                   static_cast<double>(probe.values.size() * probes_.size());
        }
        return sum;
    }();
    const double rounding = measure_of_rounding(mean);
    Means means = means_of(neighbour_weights, images_);
    if (!curves_averaged) {
        means.curve = all_shares(axial_shares, {1}, images_);
    }
    std::vector<double> shares(probes_.size(), std::numeric_limits<double>::quiet_NaN()), correlations = shares;
    std::vector<std::optional<PlaceOfImages>> passing(probes_.size()); // where strong texture does not persist
    parallel_items(static_cast<int>(probes_.size()), [&](int k) {
        const Probe& probe = probes_[static_cast<std::size_t>(k)];
        const std::vector<double>& singles = probe.singles;
        const auto at = static_cast<std::size_t>(std::ranges::max_element(singles) - singles.begin());
        const double quiet = std::max(smallest_quarter(singles), rounding);
        if (at == 0 || at + 1 == singles.size() || !(singles[at] > least_rise * quiet)) {
            return;
        }
        const double joint = curve(probe, images_in_order(images_), means)[at];
        double alike = 0, independent = 0, kept = 0; // alike: the focus measure of the mean if all have one pattern
        for (const auto& [image, weight] : means.images[at]) {
            const double share = static_cast<double>(weight) * static_cast<double>(weight);
            const double single = singles[static_cast<std::size_t>(image)];
            kept += share;
            alike += static_cast<double>(weight) * single;
            independent += share * single * single;
        }
        const double beyond_independent = joint * joint - independent;
        shares[static_cast<std::size_t>(k)] = beyond_independent / (independent * (1 / kept - 1));
        // Neighbours without any pattern have nothing that could be alike, and rounding alone is left of both.
        constexpr double least_beyond = 1e-9;
        const double if_alike = alike * alike - independent;
        correlations[static_cast<std::size_t>(k)] =
            if_alike > least_beyond * independent ? beyond_independent / if_alike : 0;
        const std::size_t neighbour = singles[at - 1] > singles[at + 1] ? at - 1 : at + 1;
        if (shares[static_cast<std::size_t>(k)] < persistent) {
            passing[static_cast<std::size_t>(k)] = {&probe, at, neighbour};
        }
    });
    std::vector<PlaceOfImages> not_persistent;
    for (const auto& place : passing) {
        if (place) {
            not_persistent.push_back(*place);
        }
    }
    // A pattern that neither reappears nor shows a surface is noise, whose strength is no evidence.
    if (!reappears(not_persistent) && !lie_on_a_surface(not_persistent)) {
        for (std::size_t k = 0; k < shares.size(); ++k) {
            if (passing[k]) {
                shares[k] = correlations[k] = std::numeric_limits<double>::quiet_NaN();
            }
        }
    }
    const auto told =
        static_cast<double>(std::ranges::count_if(shares, [](double share) { return !std::isnan(share); }));
    if (told < std::max(5.0, least_share * static_cast<double>(probes_.size()))) {
        return std::nullopt;
    }
    const auto median = [](std::vector<double>& values) {
        std::erase_if(values, [](double value) { return std::isnan(value); });
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::ranges::nth_element(values, middle);
        return *middle;
    };
    return StrongTexture{.share = median(shares), .correlation = median(correlations)};
}

std::vector<std::vector<double>> FocusProbes::patterns(const Probe& probe) const {
    const std::size_t pixels = probe.pixels(), channels = static_cast<std::size_t>(channels_);
    std::vector<std::vector<double>> all;
    for (int image = 0; image < images_; ++image) {
        std::vector<double>& pattern = all.emplace_back(pixels);
        for (std::size_t k = 0; k < channels * pixels; ++k) {
            pattern[k % pixels] += probe.values[static_cast<std::size_t>(image) * channels * pixels + k];
        }
        const double level = std::accumulate(pattern.begin(), pattern.end(), 0.0) / static_cast<double>(pixels);
        for (double& value : pattern) {
            value -= level;
        }
    }
    std::vector<int> by_focus = images_in_order(images_);
    std::ranges::sort(by_focus, {}, [&](int image) { return probe.singles[static_cast<std::size_t>(image)]; });
    by_focus.resize(static_cast<std::size_t>(std::max(1, images_ / 3)));
    std::vector<double> quiet(pixels);
    for (const int image : by_focus) {
        for (std::size_t k = 0; k < pixels; ++k) {
            quiet[k] += all[static_cast<std::size_t>(image)][k] / static_cast<double>(by_focus.size());
        }
    }
    for (auto& pattern : all) {
        std::ranges::transform(pattern, quiet, pattern.begin(), std::minus());
    }
    return all;
}

double FocusProbes::least_energy() const {
    struct Pair {
        double energy; // the smaller of both images
        bool agrees;
    };
    constexpr double flat = 1e-5; // contrast: below the step of 16 bits
    constexpr double agreeing = 0.5;
    std::vector<std::vector<Pair>> of_probes(probes_.size());
    std::vector<double> least_of_flat;
    parallel_items(static_cast<int>(probes_.size()), [&](int probe) {
        const auto& singles = probes_[static_cast<std::size_t>(probe)].singles;
        const auto all = patterns(probes_[static_cast<std::size_t>(probe)]);
        for (std::size_t k = 1; k < all.size(); ++k) {
            const double product = std::inner_product(all[k].begin(), all[k].end(), all[k - 1].begin(), 0.0);
            const double here = std::inner_product(all[k].begin(), all[k].end(), all[k].begin(), 0.0);
            const double before = std::inner_product(all[k - 1].begin(), all[k - 1].end(), all[k - 1].begin(), 0.0);
            const double smaller = std::min(singles[k], singles[k - 1]);
            if (smaller > flat && here > 0 && before > 0) {
                of_probes[static_cast<std::size_t>(probe)].push_back(
                    {.energy = smaller * smaller, .agrees = product >= agreeing * std::sqrt(here * before)});
            }
        }
    });
    for (const Probe& probe : probes_) {
        double least = std::numeric_limits<double>::infinity();
        for (const double single : probe.singles) {
            least = single > flat ? std::min(least, single) : least;
        }
        if (std::isfinite(least) && std::ranges::any_of(probe.singles, [](double single) { return single <= flat; })) {
            least_of_flat.push_back(least * least);
        }
    }
    std::vector<Pair> pairs;
    for (const auto& some : of_probes) {
        pairs.insert(pairs.end(), some.begin(), some.end());
    }
    std::ranges::sort(pairs, std::greater(), &Pair::energy);
    // Energies within a factor of two are compared, the largest first.
    constexpr std::size_t least_pairs = 8;
    constexpr double least_share = 0.2;
    double found = 0;
    for (std::size_t first = 0, end = 0, others = 0; first < pairs.size() && found == 0; ++first) {
        for (; end < pairs.size() && 2 * pairs[end].energy > pairs[first].energy; ++end) {
            others += pairs[end].agrees ? 0 : 1;
        }
        const std::size_t count = end - first;
        if (count >= least_pairs && static_cast<double>(others) >= least_share * static_cast<double>(count)) {
            found = 2 * pairs[first].energy;
        }
        others -= pairs[first].agrees ? 0 : 1;
    }
    constexpr std::size_t least_flat = 5;
    if (least_of_flat.size() >= std::max(least_flat, probes_.size() / 20)) {
        const auto middle = least_of_flat.begin() + static_cast<std::ptrdiff_t>(least_of_flat.size() / 2);
        std::ranges::nth_element(least_of_flat, middle);
        found = std::max(found, 4 * *middle);
    }
    return found;
}

double FocusProbes::share_with_rival(const std::vector<double>& axial_weights, double most_rival) const {
    // The noise floor must not be taken for a maximum at either end.
    const auto curves = curves_in_order({.images = all_shares(even_shares, axial_weights, images_),
                                         .curve = all_shares(axial_shares, axial_weights, images_)});
    // Variance of the averaged noise over a single image's, and the number of its independent values.
    const double variance = averaged_points(axial_weights, images_)[static_cast<std::size_t>(images_ / 2)].variance;
    const double independent = std::max(2.0, images_ * variance);
    // The limit is twice the range of that many normal values: where noise exceeds texture the measure is not linear,
    // and averages leave up to twice as much.
    const double by_noise = 4 * std::sqrt(2 * std::log(independent) * variance);
    int rivalled = 0;
    for (std::size_t probe = 0; probe < curves.size(); ++probe) {
        auto curve = focus::f64::empty_curve();
        for (std::size_t k = 0; k < curves[probe].size(); ++k) {
            curve = focus::f64::follow_shape(curve, curves[probe][k], static_cast<int>(k));
        }
        const std::vector<double>& single = probes_[probe].singles;
        double differences = 0;
        for (std::size_t k = 2; k < single.size(); ++k) {
            const double second = single[k - 2] - 2 * single[k - 1] + single[k];
            differences += second * second;
        }
        const double noise = std::sqrt(differences / (6.0 * std::max(1, images_ - 2)));
        rivalled +=
            curve.rival > std::max(most_rival * (curve.highest - curve.sum / images_), by_noise * noise) ? 1 : 0;
    }
    return static_cast<double>(rivalled) / static_cast<double>(curves.size());
}

std::vector<std::vector<double>> FocusProbes::some_curves() const {
    constexpr std::size_t every = 7; // shifts the column from row to row
    std::vector<std::vector<double>> curves;
    for (std::size_t k = 0; k < probes_.size(); k += every) {
        curves.push_back(probes_[k].singles);
    }
    return curves;
}

double FocusProbes::distance_from_the_ends(double share_nearer) const {
    struct Place {
        double distance;
        double weight;
    };
    std::vector<Place> places;
    double total = 0;
    const auto means = all_shares(axial_shares, axial_weights(least_smoothing), images_);
    for (const Probe& probe : probes_) {
        const std::vector<double> curve = averaged(probe.singles, means);
        const auto at = static_cast<int>(std::ranges::max_element(curve) - curve.begin());
        const int distance = std::min(at, images_ - 1 - at);
        // A maximum at an end is outside the scan, however little is averaged.
        if (distance > 0) {
            const double form = neighbours_alike(probe.singles);
            places.push_back({static_cast<double>(distance), form * form});
            total += places.back().weight;
        }
    }
    std::ranges::sort(places, {}, &Place::distance);
    double sum = 0;
    for (const auto& [distance, weight] : places) {
        sum += weight;
        if (sum > share_nearer * total) {
            return distance;
        }
    }
    return images_;
}

double FocusProbes::suitable_smoothing() const {
    if (images_ <= few_images) {
        return 0;
    }
    // Two averages of this standard deviation move Gaussian curves nearer than 1.6 times it to the end itself, whatever
    // their width.
    constexpr double least_distance = 2, share_nearer = 0.05;
    return std::min(topography::suitable_smoothing(curve_width(), images_),
                    std::max(least_smoothing, distance_from_the_ends(share_nearer) / least_distance));
}

std::optional<double> FocusProbes::noise_share() const {
    const auto found = texture_and_noise(axial_weights(suitable_smoothing()), noise(), noise_correlation());
    return found ? std::optional(1 - found->share) : std::nullopt;
}

void FocusProbes::measure_by(FocusMeasure measure) {
    if (measure == measure_) {
        return;
    }
    measure_ = measure;
    parallel_items(static_cast<int>(probes_.size()), [&](int k) {
        Probe& probe = probes_[static_cast<std::size_t>(k)];
        for (std::size_t image = 0; image < probe.singles.size(); ++image) {
            probe.singles[image] = single_of(probe, image);
        }
    });
}

void FocusProbes::settle(TopographyOptions& options) {
    // At this share noise alone scatters heights by a hundredth of the curves' standard deviation, about as much as the
    // place of texture does on a gentle slope (docs/topography.md).
    constexpr double most_noise = 1e-3;
    if (!options.focus_measure) {
        const bool averaged = options.smoothing_steps.value_or(suitable_smoothing()) > 0;
        options.focus_measure = !averaged                                ? where_little_is_averaged
                                : noise_share().value_or(1) > most_noise ? where_noise_counts
                                                                         : where_noise_is_low;
        measure_by(*options.focus_measure);
    }
    if (!options.smoothing_steps) {
        options.smoothing_steps = suitable_smoothing();
    }
}

double suitable_smoothing(double curve_width, int images) {
    constexpr double most_of_the_scan = 0.1;
    const double smoothing =
        std::min({most_smoothing_of_width * curve_width, most_of_the_scan * (images - 1), most_smoothing_steps});
    return smoothing >= least_smoothing ? smoothing : 0;
}

} // namespace vkfv::topography
