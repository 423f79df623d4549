// A tracer whose images are taken at the true positions of a stage.
#pragma once

#include "scan/stage.hpp"
#include "trace/interface/tracer.hpp"

#include <memory>

namespace vkfv::scan {

// tracer: of single moments, with its share of the rays. With several moments an exposure is their sum, so that each
// launches as many rays as the tracer does, and the image is the mean. Checkpoints are saved if there is one moment.
std::unique_ptr<trace::Tracer> make_staged_tracer(std::unique_ptr<trace::Tracer> tracer, StageMotion motion);

} // namespace vkfv::scan
