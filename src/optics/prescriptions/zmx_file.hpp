// What a .zmx file says, line by line, before a lens is made of it. Only the files of this import include this.
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
const char* name_of(SurfaceKind kind); // as files write it: "STANDARD"

struct Parameter {
    double value = 0;
    Line line;
};

// In the file's lens unit.
struct Surface {
    int number = 0;
    Line line;
    SurfaceKind kind = SurfaceKind::standard;
    Line kind_line;
    std::optional<double> curvature;
    std::optional<double> thickness; // infinity: INFINITY
    Line thickness_line;
    double conic = 0;
    std::map<int, Parameter> parameters;
    std::optional<Medium> medium; // none: air, or a mirror
    bool mirror = false;
    Line medium_line;
    std::vector<InputProblem> medium_problems; // what is wrong with it, if light goes there
    double diameter = 0;                       // half of it; 0: none
    double aperture = 0;                       // the same, and rays are clipped there
    bool stop = false;
    Line stop_line;
};

struct File {
    std::filesystem::path path;
    std::string source; // of what is imported, for its users
    std::string title;
    std::optional<double> unit; // mm
    std::vector<Surface> surfaces;
    std::map<int, double> wavelengths_um; // by their numbers
    std::optional<int> wavelength_count;
    int primary = 1; // wavelength's number
    Line primary_line{.keyword = "PWAV"};
    Line last_line;
};

// Throws InputError for a file that is no lens file, and at a line that may change the lens and is not understood.
// Keywords without optical meaning are passed over, others that are not known with a warning in the log. Glasses that
// are not known are noted with their surfaces. configuration: the number of the one to read, of those that the file
// has; none: the one that was active when it was saved.
File read_lines(std::string_view bytes, const std::filesystem::path& path, const GlassCatalog& glasses,
                std::optional<int> configuration);

} // namespace vkfv::optics::zmx
