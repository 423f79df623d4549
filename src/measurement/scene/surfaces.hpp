// The surface of the specimen, kept for a later configuration of the same process that has the same surface.
#pragma once

#include "configuration/configuration.hpp"
#include "specimen/description.hpp"
#include "specimen/specimen.hpp"

#include <optional>
#include <string>

namespace vkfv::measurement {

// The last surface is kept, since most sweeps do not vary the surface, and making one may take longer than tracing an
// image.
class Surfaces {
  public:
    struct Surface {
        specimen::Specimen specimen; // with the material of the configuration
        std::string digest;          // of the geometry
    };
    // The surface of the configuration's specimen, valid until the next call. Throws InputError at the place of the key
    // that does not fit.
    const Surface& of(const Configuration& configuration);

  private:
    std::optional<specimen::Description> made_of_;
    Surface surface_;
};

} // namespace vkfv::measurement
