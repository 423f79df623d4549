// The exposures of a stack, from the first that is missing to the last.
#pragma once

#include "core/messages/progress.hpp"
#include "scan/store.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <functional>

namespace vkfv::scan {

struct StackSummary {
    int kept = 0;   // images that were stored before
    int traced = 0; // images of this run
    std::uint64_t rays = 0;
    double trace_seconds = 0;  // wall clock of the traces of this run
    double device_seconds = 0; // of them, the devices' work by their own clocks
    double device_span = 0;    // on these clocks, from the first image's beginning to the last one's end
    bool complete = false;     // every image of the stack is stored, as far as the store looks
};

// Looks at an image of the shard, as it is stored.
using ImageVisitor = std::function<void(int image, Grid<float> values)>;
// Makes of an exposure what is stored: see light_itself().
using ImageDeveloper = std::function<Frame(int image, const trace::Image& exposure)>;

// Radiant flux per pixel in W.
Frame light_itself(int image, const trace::Image& exposure);

// Exposes and stores all images of the store's shard that it lacks. While the tracer works on the next ones, images are
// written and visited by other threads, visited by one.
// The image's number keys its random numbers, so an image does not depend on which run traced it. Reports the
// images of the shard. `visit` sees every image of the shard once, in their order: those stored before from
// the disk, the others when they have been traced. Throws what the tracer throws, and RunError if an image cannot be
// stored: what is stored stays, and the same call continues. checkpoint_interval: s, after which a long exposure is
// kept half done; 0: none is. develop: of what is traced now; its values must be as the store's pixels give them back.
StackSummary run_stack(const trace::Tracer& tracer, ImageStore& store, Progress& progress,
                       const ImageVisitor& visit = {}, double checkpoint_interval = 0,
                       const ImageDeveloper& develop = light_itself);

} // namespace vkfv::scan
