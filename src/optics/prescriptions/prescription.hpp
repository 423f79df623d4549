// Lens prescriptions: the tables of surfaces that assets/ holds as TOML.
#pragma once

#include "optics/media/glass_catalog.hpp"
#include "optics/media/medium.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::optics {

// A change of the frame for all surfaces that follow: decentre, then tilts about the new x, y and z axes in this order
// (reversed if tilt_first), then the thickness along the new z. Positive tilts turn z towards -y (about x), z towards x
// (about y) and x towards y (about z). Lengths in mm, angles in rad.
struct CoordinateBreak {
    double decentre_x = 0;
    double decentre_y = 0;
    double tilt_x = 0;
    double tilt_y = 0;
    double tilt_z = 0;
    bool tilt_first = false; // tilts about z, y, x, then the decentre
    double thickness = 0;
};

// The function of a surface. The illumination aperture stands at the source and belongs to no prescription.
enum class SurfaceRole { refracting, aperture_stop, field_stop, illumination_aperture };
const char* name_of(SurfaceRole role); // name in prescriptions, "aperture stop"; refracting: ""

// A surface, in the direction in which the prescription lists its surfaces. Lengths in mm.
struct PrescribedSurface {
    std::vector<CoordinateBreak> breaks; // between the previous surface's thickness and this vertex, in order
    double curvature = 0;                // 1/mm
    double conic = 0;
    std::array<double, 7> aspheric{}; // a4 ... a16
    double thickness = 0;             // distance to the next vertex; unused at the last surface
    Medium medium_after;
    std::optional<double> semi_diameter; // none: unbounded
    std::optional<double> ideal_power;   // 1/mm: an ideal lens (physics::pass_ideal_lens) instead of an interface
    using Role = SurfaceRole;
    Role role = Role::refracting;
};

struct Prescription {
    std::filesystem::path file; // file of origin, for messages
    std::string name;
    std::string title;
    std::string source;  // origin of the numbers
    std::string licence; // licence of the numbers
    Medium medium_before;
    std::vector<PrescribedSurface> surfaces;
    // The distance (mm) from the source to the first vertex, in illuminators only.
    std::optional<double> source_distance;
};

// Reads the prescription that find_asset() finds. A medium is searched in the file's own [media], then in `glasses`.
// Throws InputError.
Prescription load_prescription(const std::string& name, const std::filesystem::path& folder,
                               const std::filesystem::path& base,
                               const GlassCatalog& glasses = GlassCatalog::builtin());

// Reads the text of a prescription as load_prescription() does; `file` stands for it in messages.
Prescription parse_prescription(std::string_view text, const std::filesystem::path& file,
                                const GlassCatalog& glasses = GlassCatalog::builtin());

} // namespace vkfv::optics
