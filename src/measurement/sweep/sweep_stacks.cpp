#include "measurement/sweep/sweep_rows.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/heartbeat.hpp"
#include "measurement/scene/disk_space.hpp"
#include "report/declared_figures.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

constexpr double wanted_height_noise = 0.1; // um, noise for which the table tells the rays

// Heights as topography.tif holds them, float32 um, so that the figures of a sweep are those of its files.
Grid<double> as_written(const Grid<double>& heights) {
    Grid<double> result = heights;
    for (double& height : result.values) {
        height = static_cast<float>(height * um_per_mm) * mm_per_um;
    }
    return result;
}

// The figures of one stack.
Json figures_of(const topography::Deviation& deviation) {
    return report::as_declared("sweep.rows.figures",
                               {{"rms deviation", deviation.rms},
                                {"Sq measured / Sq true", deviation.sq_measured / deviation.sq_true},
                                {"correlation", deviation.correlation},
                                {"share measured", deviation.measured_share}});
}

// The mean figures over the repeats. A figure is null where a repeat has none.
Json mean_of(const std::vector<Json>& repeats) {
    Json means;
    for (const auto& [name, unused] : repeats.front().items()) {
        double sum = 0;
        for (const auto& repeat : repeats) {
            sum += repeat.at(name).get<double>();
        }
        means[name] = sweep_figure(sum / static_cast<double>(repeats.size()));
    }
    return means;
}

// The root mean square (mm) of the points' standard deviations over the repeats. Points that a repeat lacks do not
// count.
double height_noise(const std::vector<Grid<double>>& repeats) {
    const auto count = static_cast<double>(repeats.size());
    double variance = 0, points = 0;
    for (std::size_t k = 0; k < repeats.front().values.size(); ++k) {
        double sum = 0, square = 0;
        for (const auto& heights : repeats) {
            sum += heights.values[k];
            square += heights.values[k] * heights.values[k];
        }
        if (std::isfinite(sum)) {
            variance += std::max(0.0, square - sum * sum / count) / (count - 1);
            points += 1;
        }
    }
    return std::sqrt(variance / points);
}

// Heights as brightness over the lowest, or over 0 if all heights are positive. The contact sheet stretches pictures
// from 0 to twice their mean.
Grid<float> picture_of(const Grid<double>& heights) {
    Grid<float> picture(heights.columns, heights.rows);
    double lowest = 0;
    for (const double height : heights.values) {
        lowest = std::isfinite(height) ? std::min(lowest, height) : lowest;
    }
    std::ranges::transform(heights.values, picture.values.begin(), [&](double height) {
        return std::isfinite(height) ? static_cast<float>(height - lowest) : 0.0f;
    });
    return picture;
}

} // namespace

SweptStacks::SweptStacks(std::vector<std::vector<Configuration>> rows) : rows_(std::move(rows)) {
    for (const auto& row : rows_) {
        for (const Configuration& configuration : row) {
            stacks_.push_back(&configuration);
            keys_.push_back({.images = image_key(configuration), .light = light_key(configuration)});
        }
    }
}

std::string SweptStacks::plan() const {
    std::set<std::string> images, lights;
    for (const Keys& keys : keys_) {
        images.insert(keys.images);
        lights.insert(keys.light);
    }
    return fmt::format(
        "Of {} stacks the light of {} is traced, {} further {} made of the same light, and {} of the same "
        "images",
        stacks_.size(), lights.size(), images.size() - lights.size(), images.size() - lights.size() == 1 ? "is" : "are",
        stacks_.size() - images.size());
}

bool SweptStacks::is_first_of_light(std::size_t stack) const {
    const auto end = keys_.begin() + static_cast<std::ptrdiff_t>(stack);
    return std::find_if(keys_.begin(), end, [&](const Keys& earlier) { return earlier.light == keys_[stack].light; }) ==
           end;
}

double SweptStacks::images() const {
    double images = 0;
    for (std::size_t k = 0; k < stacks_.size(); ++k) {
        if (is_first_of_light(k)) {
            images += static_cast<double>(stacks_[k]->scan.value().positions().size());
        }
    }
    return images;
}

StackAmongOthers SweptStacks::others_of(std::size_t stack) const {
    StackAmongOthers others;
    others.more = stack + 1 < stacks_.size();
    std::set<std::string> made = {keys_[stack].images};
    for (std::size_t k = 0; k < stacks_.size(); ++k) {
        if (k < stack && keys_[k].images == keys_[stack].images) {
            others.same_images.push_back(stacks_[k]->output_directory);
        }
        if (k > stack && keys_[k].light == keys_[stack].light) {
            others.light_again = true;
            if (made.insert(keys_[k].images).second) {
                others.same_light.push_back(stacks_[k]);
            }
        }
    }
    return others;
}

void SweptStacks::require_space(const std::filesystem::path& folder) const {
    double needed = 0;
    for (const Configuration* configuration : stacks_) {
        if (!std::filesystem::exists(configuration->output_directory / "results.json")) {
            needed += static_cast<double>(image_bytes(configuration->instrument.detector_pixels)) *
                          static_cast<double>(configuration->scan->positions().size()) +
                      static_cast<double>(results_bytes(*configuration));
        }
    }
    const auto free = free_bytes(folder);
    const std::string all = bytes_text(static_cast<std::uint64_t>(needed));
    spdlog::info("The stacks take up to {} of the disk, which has {} free", all, bytes_text(free));
    if (needed > static_cast<double>(free)) {
        throw RunError(fmt::format("the stacks take {}, and {} has {} free. Choose another --out, or fewer stacks", all,
                                   folder.string(), bytes_text(free)));
    }
}

SweepRow SweptStacks::measure_next(Progress& progress, const std::function<void(const StackResult&)>& after_stack) {
    const std::vector<Configuration>& repeats = rows_[next_row_++];
    std::vector<Grid<double>> heights;
    std::vector<Json> figures;
    double rays_per_image = 0;
    SweepRow row;
    for (const auto& configuration : repeats) {
        const std::size_t number = next_stack_++;
        const auto stack = runs_.measure(configuration, progress, others_of(number));
        if (is_first_of_light(number)) {
            leave_out_work(stack.traced.kept);
        }
        after_stack(stack);
        heights.push_back(as_written(stack.evaluation.topography.height.height));
        figures.push_back(figures_of(stack.evaluation.deviation.value()));
        rays_per_image = static_cast<double>(stack.rays_per_image);
        row.device = stack.device;
    }
    row.figures = mean_of(figures);
    if (repeats.size() > 1) {
        const double noise = height_noise(heights);
        const double rays = rays_per_image * std::pow(noise * um_per_mm / wanted_height_noise, 2);
        row.figures.update(report::as_declared(
            "sweep.rows.figures", {{"height noise", sweep_figure(noise)},
                                   {fmt::format("rays for {:g} um", wanted_height_noise), sweep_figure(rays)}}));
    }
    row.picture = picture_of(heights.front());
    return row;
}

} // namespace vkfv::measurement
