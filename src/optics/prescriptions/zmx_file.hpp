// The content of a .zmx file, line by line, before a lens is built from it. Only the files of this import include this.
#pragma once

#include "core/messages/error.hpp"
#include "optics/media/glass_catalog.hpp"
#include "optics/media/medium.hpp"
#include "optics/prescriptions/zmx_text.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::optics::zmx {

enum class SurfaceKind { standard, even_asphere, coordinate_break, paraxial };
const char* name_of(SurfaceKind kind); // keyword in files: "STANDARD"

struct Parameter {
    double value = 0;
    Line line;
};

// A surface as the file describes it, in the file's lens unit.
struct Surface {
    int number = 0;
    Line line;
    SurfaceKind kind = SurfaceKind::standard;
    Line kind_line;
    std::optional<double> curvature;
    std::optional<double> thickness; // infinity stands for INFINITY
    Line thickness_line;
    double conic = 0;
    std::map<int, Parameter> parameters;
    std::optional<Medium> medium; // none: air or a mirror
    bool mirror = false;
    Line medium_line;
    std::vector<InputProblem> medium_problems; // reported only if light passes this medium
    double diameter = 0;                       // DIAM: semi-diameter; 0: none
    double aperture = 0;                       // semi-diameter at which rays are clipped; 0: none
    bool stop = false;
    Line stop_line;
};

struct File {
    std::filesystem::path path;
    std::string source; // origin of the imported data, for users
    std::string title;
    std::optional<double> unit; // length unit in mm
    std::vector<Surface> surfaces;
    std::map<int, double> wavelengths_um; // key: number of the wavelength
    std::optional<int> wavelength_count;
    int primary = 1; // number of the primary wavelength
    Line primary_line{.keyword = "PWAV"};
    Line last_line;
};

// Reads all lines of a file. Throws InputError for a file that is no lens file, and at an unsupported line that may
// change the lens. Keywords without optical meaning are skipped, unknown ones with a warning in the log. Unknown
// glasses are recorded at their surfaces. configuration: number of the configuration to read; none: the one that was
// active when the file was saved.
File read_lines(std::string_view bytes, const std::filesystem::path& path, const GlassCatalog& glasses,
                std::optional<int> configuration);

} // namespace vkfv::optics::zmx
