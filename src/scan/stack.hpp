// The exposures of a stack, from the first that is missing to the last.
#pragma once

#include "core/progress.hpp"
#include "scan/store.hpp"
#include "trace/tracer.hpp"

#include <cstdint>
#include <functional>

namespace vkfv::scan {

// One of `count` parts of a stack: the images whose number leaves the remainder `index`. Parts are traced
// into folders of their own; put the images of all into one of them, and the whole stack run there finds
// nothing left to trace and writes the ledger.
struct Shard {
    int index = 0; // 0 .. count - 1
    int count = 1;
};

struct StackSummary {
    int kept = 0;   // images that were stored before
    int traced = 0; // images of this run
    std::uint64_t rays = 0;
    double trace_seconds = 0;  // wall clock of the traces of this run
    double device_seconds = 0; // of them, the device's work by its own clock
    double device_span = 0;    // on that clock, from the first image's beginning to the last one's end
    bool complete = false;     // every image of the stack is stored
};

// Looks at an image of the shard: radiant flux per pixel in W as it is stored.
using ImageVisitor = std::function<void(int image, Grid<float> flux)>;

// Exposes and stores all images of the shard that the store lacks. While the tracer works on the next ones, images are
// written and visited by other threads, visited by one.
// The image's number keys its random numbers, so an image does not depend on which run traced it. Reports the
// images of the shard. `visit` sees every image of the shard once, in their order: those stored before from
// the disk, the others when they have been traced. Throws what the tracer throws, and RunError if an image cannot be
// stored: what is stored stays, and the same call continues.
StackSummary run_stack(const trace::Tracer& tracer, ImageStore& store, Progress& progress, Shard shard = {},
                       const ImageVisitor& visit = {});

} // namespace vkfv::scan
