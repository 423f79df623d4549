#include "measurement/sweep/sweep_rows.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/stages.hpp"
#include "core/threads/job_queue.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/host_memory.hpp"
#include "report/declared_figures.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
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
        first_stacks_.push_back(stacks_.size());
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

// Rows that share light, each group in its order, the groups in the order of their first rows.
std::vector<std::vector<std::size_t>> SweptStacks::rows_by_light() const {
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::set<std::string>> lights; // of each group
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        std::vector<std::size_t> joined;
        std::set<std::string> own;
        for (std::size_t k = 0; k < rows_[row].size(); ++k) {
            own.insert(keys_[first_stacks_[row] + k].light);
        }
        // Groups that the row has light in common with become one.
        std::size_t into = groups.size();
        for (std::size_t group = 0; group < groups.size(); ++group) {
            if (std::ranges::none_of(own, [&](const std::string& light) { return lights[group].contains(light); })) {
                continue;
            }
            if (into == groups.size()) {
                into = group;
            } else {
                groups[into].insert(groups[into].end(), groups[group].begin(), groups[group].end());
                lights[into].merge(lights[group]);
                groups[group].clear();
                lights[group].clear();
            }
        }
        if (into == groups.size()) {
            groups.emplace_back();
            lights.emplace_back();
        }
        groups[into].push_back(row);
        lights[into].merge(own);
    }
    std::erase_if(groups, [](const auto& group) { return group.empty(); });
    std::ranges::for_each(groups, [](auto& group) { std::ranges::sort(group); });
    return groups;
}

int SweptStacks::lanes() const {
    constexpr int most_lanes = 3; // an H200 with 16 cores takes as long with four or six
    if (stacks_.empty() || stacks_.front()->trace.device == "host") {
        return 1;
    }
    const auto reports = vulkan::list_devices();
    double memory = static_cast<double>(memory_of_host());
    for (const std::size_t device : vulkan::choose_devices(reports, stacks_.front()->trace.device)) {
        if (vulkan::is_software(reports[device])) {
            return 1;
        }
        memory = std::min(memory, static_cast<double>(reports[device].memory_bytes));
    }
    double largest = 0;
    for (std::size_t k = 0; k < stacks_.size(); ++k) {
        if (k == 0 || stacks_[k]->instrument.detector_pixels != stacks_[k - 1]->instrument.detector_pixels) {
            largest = std::max(largest, evaluation_bytes(*stacks_[k], assemble_for_figures(*stacks_[k])));
        }
    }
    constexpr double share = 0.25; // of the memory; light, kernels and images of waves take the rest
    return std::clamp(static_cast<int>(share * memory / largest), 1, most_lanes);
}

SweepRow SweptStacks::measure_row(std::size_t number, StackRuns& runs, Progress& progress,
                                  const std::function<void(const StackResult&)>& after_stack) const {
    const std::vector<Configuration>& repeats = rows_[number];
    std::vector<Grid<double>> heights;
    std::vector<Json> figures;
    heights.reserve(repeats.size());
    figures.reserve(repeats.size());
    double rays_per_image = 0;
    SweepRow row;
    for (std::size_t k = 0; k < repeats.size(); ++k) {
        const std::size_t number_of_stack = first_stacks_[number] + k;
        const auto stack = runs.measure(repeats[k], progress, others_of(number_of_stack));
        if (is_first_of_light(number_of_stack)) {
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

void SweptStacks::measure(Progress& progress, int lanes, const Listener& listener) const {
    const auto groups = rows_by_light();
    std::mutex telling;
    const auto told = [&](const auto& tell, auto&&... what) {
        const std::scoped_lock lock(telling);
        if (tell) {
            tell(std::forward<decltype(what)>(what)...);
        }
    };
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> ends = false;
    const auto work = [&](Progress& own) {
        StackRuns runs;
        try {
            for (std::size_t group = next++; group < groups.size(); group = next++) {
                for (const std::size_t row : groups[group]) {
                    if (ends) {
                        return;
                    }
                    told(listener.begins, row);
                    told(listener.after_row, row, measure_row(row, runs, own, [&](const StackResult& stack) {
                             told(listener.after_stack, row, stack);
                         }));
                }
            }
        } catch (...) {
            ends = true;
            throw;
        }
    };
    const int threads = std::min(lanes, static_cast<int>(groups.size()));
    if (threads <= 1) {
        work(progress);
        return;
    }
    enter_stage("stacks side by side");
    JobQueue queue(threads, static_cast<std::size_t>(threads));
    for (int lane = 0; lane < threads; ++lane) {
        queue.add([&] {
            Progress silent = Progress::on_standard_error(true);
            work(silent);
        });
    }
    queue.finish();
    enter_stage("results of the stacks");
}

} // namespace vkfv::measurement
