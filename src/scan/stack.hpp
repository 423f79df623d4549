// Traces the missing exposures of a stack.
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
    double device_seconds = 0; // the devices' work in that time, by their own clocks
    double device_span = 0;    // by these clocks, from the beginning of the first image to the end of the last
    bool complete = false;     // every image of the stack is stored, as far as the store checks
};

// Receives an image of the shard as it is stored.
using ImageVisitor = std::function<void(int image, Grid<float> values)>;
// Makes the stored frame of an exposure: see light_itself().
using ImageDeveloper = std::function<Frame(int image, const trace::Image& exposure)>;

// The frame of radiant flux per pixel in W.
Frame light_itself(int image, const trace::Image& exposure);

// Exposes and stores all images of the store's shard that it lacks. While the tracer works on the next ones, other
// threads write images, and one visits them. The image's number keys its random numbers, so an image does not depend on
// which run traced it. Reports the images of the shard. `visit` sees every image of the shard once, in order: those
// stored before from the disk, the others when they have been traced. checkpoint_interval: s, after which a long
// exposure is saved unfinished; 0: never. develop: converts the images traced now; its values must be as the store's
// pixels give them back. Throws what the tracer throws, and RunError if an image cannot be stored: stored images stay,
// and the same call continues.
StackSummary run_stack(const trace::Tracer& tracer, ImageStore& store, Progress& progress,
                       const ImageVisitor& visit = {}, double checkpoint_interval = 0,
                       const ImageDeveloper& develop = light_itself);

} // namespace vkfv::scan
