// A tracer whose images are taken where a stage really stands.
#pragma once

#include "scan/stage.hpp"
#include "trace/interface/tracer.hpp"

#include <memory>

namespace vkfv::scan {

// tracer: of exposures of a moment; with several moments an exposure is their sum, so that each launches as many rays
// as the tracer does, and the image is the mean. Checkpoints are kept where there is one moment.
std::unique_ptr<trace::Tracer> make_staged_tracer(std::unique_ptr<trace::Tracer> tracer, StageMotion motion);

} // namespace vkfv::scan
