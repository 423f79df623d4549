#include "measurement/scene/surfaces.hpp"

#include "measurement/scene/assembly.hpp"
#include "specimen/geometry_digest.hpp"

#include <utility>

namespace vkfv::measurement {

const Surfaces::Surface& Surfaces::of(const Configuration& configuration) {
    specimen::Description geometry = configuration.specimen.value();
    geometry.material = {};
    geometry.where = {};
    if (!made_of_ || *made_of_ != geometry) {
        surface_.specimen = make_specimen(configuration);
        surface_.digest = specimen::geometry_digest(surface_.specimen);
        made_of_ = std::move(geometry);
    }
    surface_.specimen.material = configuration.specimen->material;
    return surface_;
}

} // namespace vkfv::measurement
