// Lens prescriptions: the tables of surfaces that assets/ holds as TOML.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::optics {

// A medium between surfaces: indices at stated wavelengths, and between them the Cauchy formula
// n = A + B / lambda^2 + C / lambda^4 through the three nearest (one: constant, two: A and B).
struct Medium {
    std::string name;                   // "air", "N-BK7", ...; as the source names it
    std::vector<double> wavelengths_um; // ascending; empty, with one index: the same at every wavelength
    std::vector<double> indices;

    static Medium air(); // index 1: indices are relative to air

    // Throws InputError (naming medium and wavelength) outside the tabulated range widened by 10 nm.
    double index(double wavelength_um) const;
};

// One surface in the direction of the prescription. Lengths in mm.
struct PrescribedSurface {
    double curvature = 0; // 1/mm
    double conic = 0;
    std::array<double, 7> aspheric{}; // a4 ... a16
    double thickness = 0;             // to the next vertex; of the last surface: unused
    Medium medium_after;
    std::optional<double> semi_diameter; // none: unbounded
    enum class Role { refracting, aperture_stop, field_stop } role = Role::refracting;
};

struct Prescription {
    std::filesystem::path file; // that it was read from, for messages
    std::string name;
    std::string title;
    std::string source;  // where the numbers come from
    std::string licence; // of the numbers
    Medium medium_before;
    std::vector<PrescribedSurface> surfaces;
    // Illuminators only: from the source to the first vertex.
    std::optional<double> source_distance;

    Prescription reversed() const; // light travels the other way
};

// Where a prescription is: `name` is a path ending in .toml, relative to the folder `base`, or the stem of a
// file that is looked for as assets/<folder>/<name>.toml beside `base`, beside the folders above it, and in
// the assets that came with the program. None: no such file.
std::optional<std::filesystem::path> find_prescription(const std::string& name,
                                                       const std::filesystem::path& folder,
                                                       const std::filesystem::path& base);

// Reads the prescription that find_prescription finds. Throws InputError.
Prescription load_prescription(const std::string& name, const std::filesystem::path& folder,
                               const std::filesystem::path& base);

} // namespace vkfv::optics
