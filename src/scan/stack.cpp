#include "scan/stack.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/interruption.hpp"
#include "core/threads/job_queue.hpp"
#include "scan/checkpoint_files.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace vkfv::scan {

namespace {

// The fields of the log's line about an image, which programs that watch a run read (docs/cluster.md). z: mm.
LogFields fields_of(int image, double z, const trace::Image& exposure) {
    double detected = 0, lost = 0;
    for (const auto& entry : exposure.ledger.entries) {
        (entry.status == trace::Ledger::Status::detected ? detected : lost) += entry.power;
    }
    return {{"image", std::int64_t{image}},
            {"z_um", z * um_per_mm},
            {"device", std::int64_t{exposure.device}},
            {"rays", static_cast<std::int64_t>(exposure.rays)},
            {"detected_rays", static_cast<std::int64_t>(exposure.detected)},
            {"seconds", exposure.seconds},
            {"longest_submission_s", exposure.longest_submission},
            {"device_begin_s", exposure.device_begin},
            {"device_end_s", exposure.device_end},
            {"device_busy_s", exposure.device_seconds},
            {"emitted_W", exposure.ledger.emitted},
            {"detected_W", detected},
            {"lost_W", lost},
            {"residual_W", exposure.ledger.residual()}};
}

} // namespace

Frame light_itself(int /*image*/, const trace::Image& exposure) {
    return {.values = as_stored(exposure.flux)};
}

StackSummary run_stack(const trace::Tracer& tracer, ImageStore& store, Progress& progress, const ImageVisitor& visit,
                       double checkpoint_interval, const ImageDeveloper& develop) {
    for (const std::string& sentence : store.damaged()) {
        spdlog::warn("{}; it is traced again", sentence);
    }
    const auto& positions = store.description().positions;
    const Shard shard = store.shard();
    std::vector<int> of_shard;
    std::vector<int> to_trace;
    StackSummary summary;
    const auto checkpoints = std::make_shared<const CheckpointFiles>(
        [folder = store.folder()](std::uint32_t image) { return folder / checkpoint_path(static_cast<int>(image)); },
        store.description().digest, checkpoint_interval);
    for (int image = shard.index; image < static_cast<int>(positions.size()); image += shard.count) {
        of_shard.push_back(image);
        if (store.stored(image)) {
            ++summary.kept;
            checkpoints->drop(static_cast<std::uint32_t>(image)); // left by a run that was killed before dropping it
        } else {
            to_trace.push_back(image);
        }
    }
    const int images = static_cast<int>(of_shard.size());
    progress.begin(images, summary.kept);
    const CountedWork work(static_cast<double>(to_trace.size()));

    const auto tell_what_is_stored = [&] {
        say_when_interrupted(fmt::format("{} of {} images are stored in {}: give the same command again to continue.",
                                         summary.kept + summary.traced, images, store.folder().string()));
    };
    tell_what_is_stored();

    std::mutex counting; // guards the summary
    const auto write = [&](int image, const trace::Image& exposure, const Frame& frame) {
        try {
            store.store(image, exposure, frame);
        } catch (const FolderRemoved&) {
            throw;
        } catch (const std::runtime_error& error) {
            const std::scoped_lock lock(counting);
            throw RunError(fmt::format("{}. {} of {} images are stored in {}. When that is mended, the same command "
                                       "continues",
                                       error.what(), summary.kept + summary.traced, images, store.folder().string()));
        }
        checkpoints->drop(static_cast<std::uint32_t>(image));
        const std::scoped_lock lock(counting);
        ++summary.traced;
        summary.rays += exposure.rays;
        tell_what_is_stored();
        progress.advance(exposure.rays, fields_of(image, positions[static_cast<std::size_t>(image)], exposure));
    };
    // At most as many images wait to be written as threads write: more would only hold memory while the disk is the
    // slower part.
    const int writers = std::clamp(static_cast<int>(std::thread::hardware_concurrency()) / 4, 1, 4);
    JobQueue writing(writers, static_cast<std::size_t>(writers));
    JobQueue visiting(1, 2);

    const auto trace_all = [&] {
        std::deque<std::future<trace::Image>> under_way;
        auto to_begin = to_trace.begin();
        auto to_take = to_trace.begin();
        auto last = std::chrono::steady_clock::now();
        std::vector<double> device_ends; // when the previous image ended on each device, s
        for (const int image : of_shard) {
            const double z = positions[static_cast<std::size_t>(image)];
            if (to_take == to_trace.end() || *to_take != image) {
                if (visit) {
                    visiting.add([&visit, &store, image, z] { visit(image, read_frame(store.folder(), image, z)); });
                }
                continue;
            }
            ++to_take;
            for (; to_begin != to_trace.end() && static_cast<int>(under_way.size()) < tracer.most_under_way();
                 ++to_begin) {
                under_way.push_back(tracer.begin(positions[static_cast<std::size_t>(*to_begin)],
                                                 static_cast<std::uint32_t>(*to_begin),
                                                 checkpoint_interval > 0 ? checkpoints : nullptr));
            }
            auto exposure = std::make_shared<trace::Image>(under_way.front().get());
            under_way.pop_front();
            // Exposures overlap, so an image counts only the time since the image before it ended.
            const auto now = std::chrono::steady_clock::now();
            exposure->seconds = std::min(exposure->seconds, std::chrono::duration<double>(now - last).count());
            last = now;
            summary.trace_seconds += exposure->seconds;
            summary.device_seconds += exposure->device_seconds;
            const auto device = static_cast<std::size_t>(exposure->device);
            device_ends.resize(std::max(device_ends.size(), device + 1));
            summary.device_span += std::max(0.0, exposure->device_end - device_ends[device]);
            device_ends[device] = std::max(device_ends[device], exposure->device_end);
            const auto frame = std::make_shared<const Frame>(develop(image, *exposure));
            if (visit) {
                visiting.add([&visit, image, frame] { visit(image, frame->values); });
            }
            writing.add([&write, image, exposure, frame] { write(image, *exposure, *frame); });
        }
    };
    try {
        trace_all();
        visiting.finish();
    } catch (...) {
        writing.finish(); // images traced before are kept
        throw;
    }
    writing.finish();
    if (shard.is_whole()) {
        store.restore_configuration();
        store.write_ledger();
    }
    progress.end();
    summary.complete = store.complete();
    return summary;
}

} // namespace vkfv::scan
