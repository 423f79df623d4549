// A drawing of the instrument to scale, in the y-z plane: the specimen at the bottom, the illuminator from the side.
#pragma once

#include "optics/instrument/instrument.hpp"

#include <string>

namespace vkfv::report {

// A self-contained SVG document, the same bytes for the same instrument. `name` heads the title line. Lenses, stops,
// mirrors, the splitter, the field on the specimen, the detector and the source have their true sizes and places, and
// rays are traced (room_rays.hpp). Pale housings and the specimen's slab only help the eye.
std::string layout_svg(const optics::Instrument& instrument, const std::string& name);

} // namespace vkfv::report
