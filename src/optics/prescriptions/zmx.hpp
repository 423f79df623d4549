// Lens files of Zemax's sequential mode (.zmx). The format was learnt from files that Zemax wrote.
#pragma once

#include "optics/media/glass_catalog.hpp"
#include "optics/prescriptions/prescription.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace vkfv::optics {

struct ZmxLens {
    Prescription prescription;          // in mm, from the first surface behind the object to the last before the image
    std::vector<double> wavelengths_um; // as the file lists them
    double primary_wavelength_um = 0;
};

// Reads UTF-16 with a byte-order mark or UTF-8, lines ending in LF or CRLF. Understood are refracting
// surfaces of the types STANDARD and EVENASPH, coordinate breaks, glasses of the catalogue and model glasses (of the
// Abbe number 0: without dispersion). The image's own glass, behind which nothing is traced, is left out.
// Zemax turns frames as CoordinateBreak does. What may change the lens and is not understood is an InputError
// that names line, surface and keyword; nothing is left out in silence but what Zemax computes with or
// displays.
ZmxLens read_zmx(const std::filesystem::path& file, const GlassCatalog& glasses);

// The same of a file's bytes; `file` stands for it in messages.
ZmxLens parse_zmx(std::string_view bytes, const std::filesystem::path& file, const GlassCatalog& glasses);

} // namespace vkfv::optics
