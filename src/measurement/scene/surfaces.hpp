// The surface of the specimen, kept for the next configuration of the same process that has the same one.
#pragma once

#include "configuration/configuration.hpp"
#include "specimen/description.hpp"
#include "specimen/specimen.hpp"

#include <optional>
#include <string>

namespace vkfv::measurement {

// Most sweeps do not vary the surface, and making it may take longer than tracing an image: so the last one is kept.
class Surfaces {
  public:
    struct Surface {
        specimen::Specimen specimen; // with the material asked for
        std::string digest;          // of the geometry
    };
    // Valid until the next call. Throws InputError at the place of the key that does not fit.
    const Surface& of(const Configuration& configuration);

  private:
    std::optional<specimen::Description> made_of_;
    Surface surface_;
};

} // namespace vkfv::measurement
