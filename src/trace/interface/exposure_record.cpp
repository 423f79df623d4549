#include "trace/interface/exposure_record.hpp"

namespace vkfv::trace {

physics::f64::Exposure make_exposure(const optics::Instrument& instrument, const physics::f64::SpecimenRecord& specimen,
                                     FocalPosition position, std::uint32_t seed, std::uint32_t image) {
    physics::f64::Exposure exposure{};
    // In the specimen's frame the plane of best focus stands at the focal height and carries the objective along.
    exposure.top_distance = position.height + instrument.front_vertex_height - specimen.top;
    exposure.seed = seed;
    exposure.image = image;
    exposure.focal_height = position.height;
    exposure.beside_x = position.beside.x;
    exposure.beside_y = position.beside.y;
    exposure.magnification_change = instrument.magnification_rate * position.height;
    return exposure;
}

} // namespace vkfv::trace
