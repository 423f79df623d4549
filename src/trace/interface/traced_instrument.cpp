#include "trace/interface/traced_instrument.hpp"

#include <utility>

namespace vkfv::trace {

optics::Instrument as_traced(const optics::Instrument& instrument, const TraceOptions& options) {
    const bool in_sequence = !options.nonsequential;
    optics::Instrument traced = options.waves && in_sequence ? optics::with_whole_pixels(instrument) : instrument;
    const bool once = options.max_bounces == 1 && options.estimator == Estimator::forward;
    return once && in_sequence ? optics::aimed_for_single_scatter(std::move(traced)) : traced;
}

} // namespace vkfv::trace
