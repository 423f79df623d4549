#include "measurement/fit/model_stacks.hpp"

#include "core/files/digest.hpp"
#include "core/messages/error.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "measurement/scene/configured_numbers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <optional>
#include <system_error>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_model_stacks { // files of a unity build share the unnamed namespace

namespace fs = std::filesystem;

struct Kept {
    std::vector<double> statistics;
    std::string device;
};

// The statistics that an earlier run kept; none: there are none, or the file is not whole.
std::optional<Kept> kept_in(const fs::path& file, const std::string& digest) {
    std::error_code none;
    if (!fs::exists(file, none)) {
        return std::nullopt;
    }
    try {
        const auto json = nlohmann::json::parse(read_file(file));
        if (json.at("digest") == digest) {
            return Kept{.statistics = json.at("statistics"), .device = json.at("device")};
        }
    } catch (const nlohmann::json::exception& error) {
        spdlog::warn("{}: {}; the stack is traced again", file.string(), error.what());
    }
    return std::nullopt;
}

std::size_t count_of(const StatisticsLayout& layout) {
    std::size_t count = 0;
    for (const StatisticGroup& group : statistic_groups(layout)) {
        count += static_cast<std::size_t>(group.count);
    }
    return count;
}

} // namespace of_model_stacks
} // namespace

ModelStacks::ModelStacks(const Configuration& base, std::filesystem::path file, std::vector<TomlOverride> overrides,
                         const std::vector<FreeParameter>& parameters, const StatisticsLayout& layout,
                         ResultFolder& results, Progress& progress)
    : base_(base), file_(std::move(file)), overrides_(std::move(overrides)), parameters_(parameters), layout_(layout),
      results_(results), progress_(progress),
      seeds_(seeds_in(base, {"trace.seed", "camera.noise_seed", "stage.seed", "specimen.seed",
                             "specimen.roughness.seed", "specimen.reflectance.seed"})) {
    if (base.estimator_is_chosen) { // all stacks by the same one, whatever their numbers suggest
        overrides_.push_back({"trace.estimator",
                              base.trace.estimator == trace::Estimator::backward ? "\"backward\"" : "\"forward\"",
                              "fit"});
    }
}

Configuration ModelStacks::configuration(const std::vector<double>& place, int seed) const {
    auto overrides = overrides_;
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
        overrides.push_back({parameters_[k].key, shortest_toml(parameters_[k].value(place[k])), "fit"});
    }
    for (const auto& [key, first] : seeds_) { // the base's own seeds may be those of the measured stack
        overrides.push_back({key, fmt::format("{}", first + 1 + static_cast<std::uint32_t>(seed)), "fit"});
    }
    const Configuration model = load_configuration(file_, overrides, Needs::stack);
    const auto images = model.scan->positions().size();
    const ImageSize pixels = model.instrument.detector_pixels;
    if (images != static_cast<std::size_t>(layout_.images) || pixels != layout_.pixels) {
        throw InputError(
            {.where = {.file = "command line"},
             .key = "--free",
             .found = fmt::format("keys that make {} images of {} x {} pixels where the search goes", images,
                                  pixels.columns, pixels.rows),
             .expected = fmt::format("keys that leave the {} of {} x {} of the stack", layout_.images,
                                     layout_.pixels.columns, layout_.pixels.rows),
             .remedy = "Hold the keys of [scan] and [detector] that decide them, and what they depend on."});
    }
    return model;
}

std::vector<double> ModelStacks::statistics(const std::vector<double>& place, int seed) {
    using namespace of_model_stacks;
    Configuration model = configuration(place, seed);
    const double images = static_cast<double>(model.scan->positions().size());
    Digest digest;
    digest.add(image_key(model)).add(fmt::format("window = {}\nbrightness = {}\n", layout_.window, layout_.brightness));
    const std::string whole = digest.sha256(), name = digest.text();
    const fs::path file = fs::path("runs") / (name + ".json");
    if (auto kept = kept_in(results_.path() / file, whole); kept && kept->statistics.size() == count_of(layout_)) {
        if (names_.insert(name).second) {
            ++stacks_;
            results_.note(file, read_file(results_.path() / file));
            leave_out_work(images);
        }
        devices_.insert(kept->device);
        return std::move(kept->statistics);
    }
    ++stacks_;
    ++traced_;
    names_.insert(name);
    const fs::path folder = results_.path() / "tracing" / name;
    model.output_directory = folder;
    StackStatistics statistics(layout_);
    const auto traced =
        runs_.trace(model, progress_, [&](int image, const Grid<float>& values) { statistics.add(image, values); });
    leave_out_work(traced.traced.kept);
    const auto values = statistics.values();
    nlohmann::ordered_json json = {{"digest", whole}, {"device", traced.device}, {"seed", seed}};
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
        json["parameters"][parameters_[k].key] = parameters_[k].value(place[k]);
    }
    json["statistics"] = values;
    results_.write(file, json_text(json) + "\n");
    std::error_code none; // images that stay are in nobody's way
    fs::remove_all(folder, none);
    fs::remove(folder.parent_path(), none); // if it is empty
    devices_.insert(traced.device);
    return values;
}

} // namespace vkfv::measurement
