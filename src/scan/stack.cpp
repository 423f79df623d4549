#include "scan/stack.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <future>
#include <stdexcept>
#include <vector>

namespace vkfv::scan {

StackSummary run_stack(const trace::Tracer& tracer, ImageStore& store, Progress& progress, Shard shard) {
    if (shard.count < 1 || shard.index < 0 || shard.index >= shard.count) {
        throw std::invalid_argument("a shard is one of 0 .. count - 1");
    }
    for (const std::string& sentence : store.damaged()) {
        spdlog::warn("{}; it is traced again", sentence);
    }
    const auto& positions = store.description().positions;
    std::vector<int> missing;
    int images = 0;
    for (int image = shard.index; image < static_cast<int>(positions.size()); image += shard.count) {
        ++images;
        if (!store.stored(image)) {
            missing.push_back(image);
        }
    }

    StackSummary summary;
    summary.kept = images - static_cast<int>(missing.size());
    progress.begin(images, summary.kept);

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
            throw RunError(
                fmt::format("{}. {} of {} images are stored in {}: free the disk, then give the same "
                            "command again to continue",
                            error.what(), summary.kept + summary.traced, images, store.folder().string()));
        }
        ++summary.traced;
        summary.rays += rays_in_writing;
        progress.advance(rays_in_writing);
    };
    for (const int image : missing) {
        trace::Image exposure =
            tracer.expose(positions[static_cast<std::size_t>(image)], static_cast<std::uint32_t>(image));
        summary.trace_seconds += exposure.seconds;
        finish_writing();
        rays_in_writing = exposure.rays;
        writing = std::async(std::launch::async, [&store, image, exposure = std::move(exposure)] {
            store.store(image, exposure);
        });
    }
    finish_writing();
    store.write_ledger();
    progress.end();
    summary.complete = store.complete();
    return summary;
}

} // namespace vkfv::scan
