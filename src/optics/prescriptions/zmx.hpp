// Lens files of Zemax's sequential mode (.zmx). The format was learnt from files that Zemax wrote.
#pragma once

#include "optics/media/glass_catalog.hpp"
#include "optics/prescriptions/prescription.hpp"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace vkfv::optics {

struct ZmxLens {
    Prescription prescription;          // in mm, from the first surface behind the object to the last before the image
    std::vector<double> wavelengths_um; // in the order of the file
    double primary_wavelength_um = 0;
    bool from_infinity = false; // true if the object is at infinity
};

// Reads a lens in any encoding of as_utf8(). Supported are refracting surfaces of the types STANDARD and EVENASPH,
// coordinate breaks, PARAXIAL surfaces in air, which become ideal lenses, plane mirrors, which are unfolded, glasses of
// the catalogues (those of GCAT first) and model glasses (of the Abbe number 0: without dispersion). The image's own
// glass, behind which nothing is traced, is left out. configuration: see zmx::read_lines(). Zemax rotates frames as
// CoordinateBreak does. Unsupported content that may change the lens is an InputError that names line, surface and
// keyword.
ZmxLens read_zmx(const std::filesystem::path& file, const GlassCatalog& glasses,
                 std::optional<int> configuration = std::nullopt);

// Reads the bytes of a .zmx file as read_zmx() does; `file` stands for it in messages.
ZmxLens parse_zmx(std::string_view bytes, const std::filesystem::path& file, const GlassCatalog& glasses,
                  std::optional<int> configuration = std::nullopt);

} // namespace vkfv::optics
