#include "scan/stack.hpp"

#include "core/error.hpp"
#include "core/interruption.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <future>
#include <stdexcept>
#include <vector>

namespace vkfv::scan {

StackSummary run_stack(const trace::Tracer& tracer, ImageStore& store, Progress& progress, Shard shard,
                       const ImageVisitor& visit) {
    if (shard.count < 1 || shard.index < 0 || shard.index >= shard.count) {
        throw std::invalid_argument("a shard is one of 0 .. count - 1");
    }
    for (const std::string& sentence : store.damaged()) {
        spdlog::warn("{}; it is traced again", sentence);
    }
    const auto& positions = store.description().positions;
    std::vector<int> of_shard;
    StackSummary summary;
    for (int image = shard.index; image < static_cast<int>(positions.size()); image += shard.count) {
        of_shard.push_back(image);
        summary.kept += store.stored(image) ? 1 : 0;
    }
    const int images = static_cast<int>(of_shard.size());
    progress.begin(images, summary.kept);

    const auto tell_what_is_stored = [&] {
        say_when_interrupted(fmt::format("{} of {} images are stored in {}: give the same command again to continue.",
                                         summary.kept + summary.traced, images, store.folder().string()));
    };
    tell_what_is_stored();

    // At most one image waits to be written: a second would only hold memory while the disk is the slower
    // part.
    std::future<void> writing;
    std::uint64_t rays_in_writing = 0;
    const auto finish_writing = [&] {
        if (!writing.valid()) {
            return;
        }
        try {
            writing.get();
        } catch (const std::runtime_error& error) {
            throw RunError(fmt::format("{}. {} of {} images are stored in {}: free the disk, then give the same "
                                       "command again to continue",
                                       error.what(), summary.kept + summary.traced, images, store.folder().string()));
        }
        ++summary.traced;
        tell_what_is_stored();
        summary.rays += rays_in_writing;
        progress.advance(rays_in_writing);
    };
    for (const int image : of_shard) {
        const double z = positions[static_cast<std::size_t>(image)];
        if (store.stored(image)) {
            if (visit) {
                visit(image, read_frame(store.folder(), image, z));
            }
            continue;
        }
        trace::Image exposure = tracer.expose(z, static_cast<std::uint32_t>(image));
        summary.trace_seconds += exposure.seconds;
        finish_writing();
        rays_in_writing = exposure.rays;
        Grid<float> flux = visit ? as_stored(exposure.flux) : Grid<float>();
        writing = std::async(std::launch::async,
                             [&store, image, exposure = std::move(exposure)] { store.store(image, exposure); });
        if (visit) {
            visit(image, std::move(flux)); // while it is written
        }
    }
    finish_writing();
    store.write_ledger();
    progress.end();
    summary.complete = store.complete();
    return summary;
}

} // namespace vkfv::scan
