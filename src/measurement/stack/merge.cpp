// The merging of a stack's shards.
#include "core/messages/error.hpp"
#include "core/messages/interruption.hpp"
#include "core/messages/stages.hpp"
#include "core/toml/toml_reader.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/stack/stack.hpp"
#include "measurement/stack/stack_parts.hpp"
#include "scan/stack_identity.hpp"
#include "trace/interface/light_sources.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace vkfv::measurement {

namespace {

namespace fs = std::filesystem;

// Ascending numbers as "3 to 7, 12".
std::string ranges_text(const std::vector<int>& numbers) {
    std::vector<std::string> ranges;
    for (std::size_t first = 0; first < numbers.size();) {
        std::size_t last = first;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) {
            ++last;
        }
        ranges.push_back(first == last ? fmt::format("{}", numbers[first])
                                       : fmt::format("{} to {}", numbers[first], numbers[last]));
        first = last + 1;
    }
    return fmt::format("{}", fmt::join(ranges, ", "));
}

// The tracer that made the images of this identity, as it would trace them now: its device, with the kernels and the
// instrument of this program.
trace::TracerIdentity tracer_of(const std::string& identity, const StackScene& scene, const fs::path& folder) {
    auto tracer =
        trace::TracerIdentity::parse(TomlTable::parse(identity, folder / scan::configuration_name).table("made"));
    tracer.kernels = trace::kernels_digest();
    tracer.instrument = trace::traced_digest(scene.instrument, scene.configuration.trace);
    return tracer;
}

// The pupil filter of each source's light; none where images are made by rays.
std::vector<optics::PupilFilter> filters_of_run(const Configuration& configuration, const trace::TracerIdentity& tracer,
                                                const optics::Instrument& instrument) {
    std::vector<optics::PupilFilter> filters;
    if (tracer.sorting.pupil_cells != 0) {
        std::vector<trace::LightSorting> sortings = tracer.further_sortings;
        sortings.insert(sortings.begin(), tracer.sorting);
        const auto lights = instrument.lights();
        for (std::size_t k = 0; k < lights.size(); ++k) {
            auto waves = configuration.trace.waves.value_or(optics::WaveOptions());
            waves.cells = sortings.at(k).pupil_cells;
            waves.parts = sortings.at(k).parts_per_pixel;
            waves.tiles = sortings.at(k).field_tiles;
            filters.emplace_back(*lights[k], waves);
        }
    }
    return filters;
}

void require_same_stack(const fs::path& folder, const std::string& identity) {
    const std::string difference = scan::identity_differences(scan::stored_identity(folder), identity);
    if (!difference.empty()) {
        refuse_file(folder / scan::configuration_name, "", "a stack of another configuration, program or device",
                    "shards of one stack",
                    "Trace its images again like the others', with this program. What differs, there from what belongs "
                    "here:" +
                        difference);
    }
}

void gather_images(scan::ImageStore& store, const std::vector<fs::path>& shards) {
    for (const std::string& sentence : store.damaged()) {
        spdlog::warn("{}; it is looked for in the shards", sentence);
    }
    std::vector<int> missing;
    for (int image = 0; image < static_cast<int>(store.description().positions.size()); ++image) {
        const auto taken_from = [&](const fs::path& shard) { return store.take(image, shard); };
        if (!store.stored(image) && std::ranges::none_of(shards, taken_from)) {
            missing.push_back(image);
        }
    }
    if (!missing.empty()) {
        refuse_file(store.folder(), "", fmt::format("no image {}", ranges_text(missing)),
                    fmt::format("all {} images of the stack", store.description().positions.size()),
                    "Name the folders of all shards, or trace what is missing: of N shards, image k is of number "
                    "k mod N + 1. Images that are here stay.");
    }
}

} // namespace

StackResult merge_stack(const fs::path& folder, const std::vector<fs::path>& shards) {
    std::error_code none;
    const bool begun = shards.empty() || fs::exists(folder / scan::configuration_name, none);
    const fs::path& first = begun ? folder : shards.front();
    const std::string identity = scan::stored_identity(first);
    auto configuration = load_configuration(first / scan::configuration_name, {}, Needs::stack);
    configuration.output_directory = folder;
    const StackScene scene(configuration);
    const auto tracer = tracer_of(identity, scene, first);
    const auto description = scene.description(tracer);
    require_same_stack(first, description.identity);
    for (const fs::path& shard : shards) {
        require_same_stack(shard, description.identity);
    }

    enter_stage("folder of the stack");
    say_when_interrupted(
        fmt::format("What was merged is in {}: give the same command again to continue.", folder.string()));
    scan::ImageStore store(folder, description);
    require_space(store, results_bytes(configuration));
    gather_images(store, shards);
    store.write_ledger();

    const auto filters = filters_of_run(configuration, tracer, scene.instrument);
    enter_stage("images");
    // The evaluation has the same bits on every device, so a device that is not here is not missed.
    const auto evaluate_on = configuration.evaluate_on == EvaluateOn::host ? EvaluateOn::host : EvaluateOn::automatic;
    GrowingEvaluation evaluation(
        scene, focus_planes_for_files(evaluate_on, configuration.trace.device, scene.positions.size()), filters);
    for (std::size_t image = 0; image < scene.positions.size(); ++image) {
        evaluation.add(static_cast<int>(image),
                       scan::read_frame(folder, static_cast<int>(image), scene.positions[image]));
    }
    EvaluatedStack evaluated = evaluation.finish(store, tracer);
    write_stack_results(store, configuration, evaluated);
    return {.evaluation = std::move(evaluated.evaluation),
            .traced = {.kept = static_cast<int>(scene.positions.size()), .complete = true},
            .rays_per_image = trace::launched_rays(configuration.trace, configuration.instrument),
            .folder = folder,
            .device = tracer.text()};
}

} // namespace vkfv::measurement
