// A tracer whose images are taken at the true positions of a stage.
#pragma once

#include "scan/stage.hpp"
#include "trace/interface/tracer.hpp"

#include <memory>

namespace vkfv::scan {

// Makes a tracer of exposures on a moving stage. tracer: of exposures of a single moment. With several moments an
// exposure is the sum of theirs, each with as many rays as the tracer launches, and the image is their mean.
// Checkpoints are saved if there is one moment.
std::unique_ptr<trace::Tracer> make_staged_tracer(std::unique_ptr<trace::Tracer> tracer, StageMotion motion);

} // namespace vkfv::scan
