#include "optics/prescriptions/zmx.hpp"

#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "optics/prescriptions/pose.hpp"
#include "optics/prescriptions/zmx_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

namespace {

using namespace zmx;

// Thicknesses (mm) have the same range as in prescriptions.
constexpr NumberRange thickness_range = {.minimum = 0, .maximum = 1e6};
constexpr NumberRange offset_range = {.minimum = -1e6, .maximum = 1e6};
constexpr NumberRange tilt_range_deg = {.minimum = -360, .maximum = 360};

// Builds the lens from the content of a .zmx file.
class Builder {
  public:
    explicit Builder(File file) : file_(std::move(file)) {}

    ZmxLens lens() {
        if (file_.surfaces.size() < 3) {
            refuse({file_.path}, {.number = file_.last_line.number}, fmt::format("{} surfaces", file_.surfaces.size()),
                   "a lens: an object, at least one surface, and an image",
                   "Check that this is a whole .zmx file of a sequential lens.");
        }
        if (!file_.unit) {
            refuse({file_.path}, {.number = 1}, "no UNIT", "the lens unit", "Add a line UNIT MM, or another unit.");
        }
        ZmxLens result;
        Prescription& prescription = result.prescription;
        prescription.file = file_.path;
        prescription.name = file_.path.stem().string();
        prescription.title = file_.title.empty() ? prescription.name : file_.title;
        prescription.source = file_.source;
        prescription.licence = "not known to the import: see the source";
        require_glasses();
        for (const auto& surface : file_.surfaces) {
            check(surface);
        }
        check_image();
        unfold_mirrors();
        result.from_infinity = std::isinf(*file_.surfaces.front().thickness);
        prescription.medium_before = file_.surfaces.front().medium.value_or(Medium::air());
        std::vector<CoordinateBreak> breaks;
        bool has_stop = false;
        for (std::size_t i = 1; i + 1 < file_.surfaces.size(); ++i) {
            const Surface& surface = file_.surfaces[i];
            if (surface.kind == SurfaceKind::coordinate_break) {
                breaks.push_back(break_of(surface));
                continue;
            }
            if (unfolded_ && stands_straight(breaks)) {
                const double distance = Pose().along(breaks).origin.z;
                breaks.clear();
                if (!prescription.surfaces.empty()) {
                    prescription.surfaces.back().thickness += distance;
                }
            }
            prescription.surfaces.push_back(prescribed(surface));
            prescription.surfaces.back().breaks = std::exchange(breaks, {});
            if (surface.stop && std::exchange(has_stop, true)) {
                refuse(place_of(surface), surface.stop_line, "a second stop", "one stop",
                       "Keep the one that limits the light.");
            }
        }
        if (prescription.surfaces.empty()) {
            refuse({file_.path}, {.number = file_.last_line.number}, "coordinate breaks only", "at least one surface",
                   "Check that this is the file of a lens.");
        }
        // The last thickness ends at the image plane, which is no part of the lens.
        prescription.surfaces.back().thickness = 0;
        take_over_wavelengths(result);
        return result;
    }

  private:
    Place place_of(const Surface& surface) const { return {file_.path, surface.number}; }

    // Throws one InputError for all missing glasses. The image's glass is not needed, as no light is traced behind the
    // image.
    void require_glasses() const {
        std::vector<InputProblem> problems;
        for (std::size_t i = 0; i + 1 < file_.surfaces.size(); ++i) {
            const auto& of_surface = file_.surfaces[i].medium_problems;
            problems.insert(problems.end(), of_surface.begin(), of_surface.end());
        }
        if (!problems.empty()) {
            throw InputError(std::move(problems));
        }
    }

    void check_image() const {
        const Surface& image = file_.surfaces.back();
        if (*image.thickness != 0 || image.kind == SurfaceKind::coordinate_break) {
            refuse(place_of(image), image.thickness_line, "a lens surface at the end",
                   "an image surface, of thickness 0",
                   "The file looks cut off: copy it again; or add an image surface.");
        }
        if (image.medium) {
            spdlog::info("{}:{}: {} behind the image is left out: no light goes there", file_.path.string(),
                         image.medium_line.number,
                         image.medium_line.words.empty() ? "the glass" : image.medium_line.words.front());
        }
    }

    // Unfolds plane mirrors: light that a mirror reflects continues straight, through the mirror image of the surfaces
    // that follow. Behind the mirror Zemax counts along the old z, so that distances, curvatures and the tilts about x
    // and y have the opposite signs of those in the mirror's image. Each mirror also reverses the lens laterally, which
    // changes no distance, angle or centred surface.
    void unfold_mirrors() {
        bool reversed = false;
        for (Surface& surface : file_.surfaces) {
            if (surface.kind == SurfaceKind::paraxial && reversed) {
                refuse(place_of(surface), surface.kind_line, "PARAXIAL behind an odd number of mirrors",
                       "PARAXIAL surfaces that light meets along z", "Unfold the lens in Zemax.");
            }
            if (reversed) {
                *surface.curvature = -*surface.curvature + 0.0;
                for (auto& [number, parameter] : surface.parameters) {
                    const bool tilt = number == 3 || number == 4;
                    if (surface.kind == SurfaceKind::even_asphere ||
                        (surface.kind == SurfaceKind::coordinate_break && tilt)) {
                        parameter.value = -parameter.value + 0.0;
                    }
                }
            }
            const bool is_image = &surface == &file_.surfaces.back();
            if (surface.mirror && !is_image) {
                require_plane(surface);
                spdlog::info("{}:{}: the plane mirror of surface {} is unfolded", file_.path.string(),
                             surface.medium_line.number, surface.number);
                unfolded_ = true;
                reversed = !reversed;
                surface.kind = SurfaceKind::coordinate_break; // without its reflection the mirror is only a distance
                surface.parameters.clear();
            }
            if (reversed && std::isfinite(*surface.thickness)) {
                *surface.thickness = -*surface.thickness + 0.0;
            }
        }
    }

    void require_plane(const Surface& surface) const {
        const bool plane = *surface.curvature == 0 && surface.kind == SurfaceKind::standard;
        if (!plane || surface.number == 0) {
            refuse(place_of(surface), surface.medium_line, surface.medium_line.rest, "a plane mirror",
                   "Curved mirrors are not imported.");
        }
        if (surface.stop) {
            refuse(place_of(surface), surface.stop_line, "a stop at a mirror", "a stop at a surface of the lens",
                   "Put the stop in front of the mirror.");
        }
    }

    // True if the breaks leave the optical axis unchanged.
    static bool stands_straight(const std::vector<CoordinateBreak>& breaks) {
        constexpr double negligible = 1e-9; // mm, and for components of the axes
        const Pose pose = Pose().along(breaks);
        double off = std::max(std::abs(pose.origin.x), std::abs(pose.origin.y));
        for (int axis = 0; axis < 3; ++axis) {
            off = std::max(off, std::abs(pose.axes[axis][axis] - 1));
        }
        return off < negligible;
    }

    void check(const Surface& surface) const {
        if (!surface.curvature || !surface.thickness) {
            refuse(place_of(surface), surface.line, surface.curvature ? "no DISZ" : "no CURV",
                   "curvature and thickness", "The file looks cut off: copy it again.");
        }
        const bool is_end = surface.number == 0 || surface.number + 1 == static_cast<int>(file_.surfaces.size());
        if (surface.stop && (is_end || surface.kind == SurfaceKind::coordinate_break)) {
            refuse(place_of(surface), surface.stop_line, "a stop at a surface without light", "a stop within the lens",
                   "Make a surface of the lens the stop.");
        }
        if (surface.kind == SurfaceKind::coordinate_break) {
            if (surface.medium || surface.mirror || *surface.curvature != 0 || surface.conic != 0) {
                refuse(place_of(surface), surface.medium || surface.mirror ? surface.medium_line : surface.kind_line,
                       "a coordinate break that refracts", "no glass and no curvature",
                       "Give them to the next surface.");
            }
        }
        // A paraxial surface has two parameters: its focal length and the mode in which path lengths are counted.
        const int most = surface.kind == SurfaceKind::standard           ? 0
                         : surface.kind == SurfaceKind::coordinate_break ? 6
                         : surface.kind == SurfaceKind::paraxial         ? 2
                                                                         : 8;
        for (const auto& [number, parameter] : surface.parameters) {
            if (parameter.value != 0 && (number < 1 || number > most)) {
                refuse(place_of(surface), parameter.line, parameter.line.rest,
                       fmt::format("no parameter {} of a surface {}", number, name_of(surface.kind)), "Set it to 0.");
            }
        }
        if (surface.kind == SurfaceKind::even_asphere && parameter_of(surface, 1) != 0) {
            const Line& line = surface.parameters.at(1).line;
            refuse(place_of(surface), line, line.rest, "0 as the coefficient of r^2",
                   "Make it part of the curvature: add twice the coefficient to it, and refit the conic.");
        }
    }

    // The power (1/mm) of a PARAXIAL surface.
    double ideal_power_of(const Surface& surface) const {
        const double focal_length = in_mm(surface, surface.kind_line, parameter_of(surface, 1));
        const Surface& before = file_.surfaces[static_cast<std::size_t>(surface.number) - 1];
        if (surface.medium || before.medium || *surface.curvature != 0 || surface.conic != 0) {
            refuse(place_of(surface), surface.kind_line, surface.kind_line.rest, "a plane PARAXIAL surface in air",
                   "Make it so in Zemax.");
        }
        if (focal_length == 0 || !std::isfinite(1 / focal_length)) {
            refuse(place_of(surface), surface.kind_line, fmt::format("a focal length of {} mm", focal_length),
                   "a focal length as PARM 1", "Give it.");
        }
        return 1 / focal_length;
    }

    static double parameter_of(const Surface& surface, int number) {
        const auto found = surface.parameters.find(number);
        return found == surface.parameters.end() ? 0 : found->second.value;
    }

    // Converts a value of the dimension length^dimension from the file's unit to mm^dimension.
    double in_mm(const Surface& surface, const Line& line, double value, int dimension = 1) const {
        const double result = value * std::pow(*file_.unit, dimension) + 0.0;
        if (!std::isfinite(result)) {
            refuse(place_of(surface), line, line.rest, "a number that is finite in mm", "Correct it.");
        }
        return result;
    }

    double thickness_of(const Surface& surface, const NumberRange& range) const {
        const Line& line = surface.thickness_line;
        const double thickness = in_mm(surface, line, std::min(*surface.thickness, 1e300));
        if (!range.contains(thickness)) {
            refuse(place_of(surface), line, line.rest, fmt::format("a thickness {} mm", range.to_string()),
                   *surface.thickness < 0 ? "Leave out what stands in front of the surface before it."
                                          : "Choose a smaller distance.");
        }
        return thickness;
    }

    CoordinateBreak break_of(const Surface& surface) const {
        const auto checked = [&](int number, const NumberRange& range, auto convert) {
            const auto found = surface.parameters.find(number);
            if (found == surface.parameters.end()) {
                return 0.0;
            }
            const Line& line = found->second.line;
            const double value = convert(line, found->second.value);
            if (!range.contains(value)) {
                refuse(place_of(surface), line, line.rest,
                       fmt::format("a value {} in mm or degrees", range.to_string()),
                       "Choose a smaller decentre or tilt.");
            }
            return value;
        };
        const auto length = [&](int number) {
            return checked(number, offset_range,
                           [&](const Line& line, double value) { return in_mm(surface, line, value); });
        };
        const auto angle = [&](int number) {
            return checked(number, tilt_range_deg, [](const Line&, double value) { return value; }) *
                   radians_per_degree;
        };
        return {.decentre_x = length(1),
                .decentre_y = length(2),
                .tilt_x = angle(3),
                .tilt_y = angle(4),
                .tilt_z = angle(5),
                .tilt_first = parameter_of(surface, 6) != 0,
                .thickness = thickness_of(surface, offset_range)};
    }

    PrescribedSurface prescribed(const Surface& surface) const {
        PrescribedSurface result;
        result.curvature = in_mm(surface, surface.line, *surface.curvature, -1);
        result.conic = surface.conic;
        for (const auto& [number, parameter] : surface.parameters) {
            if (surface.kind == SurfaceKind::even_asphere && number >= 2 &&
                number <= 8) { // coefficient of r^(2 number)
                result.aspheric[static_cast<std::size_t>(number - 2)] =
                    in_mm(surface, parameter.line, parameter.value, 1 - 2 * number);
            }
        }
        if (surface.kind == SurfaceKind::paraxial) {
            result.ideal_power = ideal_power_of(surface);
            spdlog::warn("{}:{}: the PARAXIAL surface becomes an ideal lens, which keeps Abbe's sine condition",
                         file_.path.string(), surface.kind_line.number);
        }
        result.medium_after = surface.medium.value_or(Medium::air());
        const double semi_diameter = surface.aperture > 0 ? surface.aperture : surface.diameter;
        if (semi_diameter > 0) {
            result.semi_diameter = in_mm(surface, surface.line, semi_diameter);
        }
        if (surface.stop) {
            result.role = PrescribedSurface::Role::aperture_stop;
        }
        const bool is_last = surface.number + 2 == static_cast<int>(file_.surfaces.size());
        result.thickness = is_last ? 0 : thickness_of(surface, thickness_range);
        return result;
    }

    // Only the stated number of wavelengths is taken, as Zemax pads the list to 24 entries.
    void take_over_wavelengths(ZmxLens& result) const {
        for (const auto& [number, wavelength] : file_.wavelengths_um) {
            if (!file_.wavelength_count || number <= *file_.wavelength_count) {
                result.wavelengths_um.push_back(wavelength);
            }
        }
        const auto primary = file_.wavelengths_um.find(file_.primary);
        if (result.wavelengths_um.empty() || primary == file_.wavelengths_um.end() ||
            (file_.wavelength_count && file_.primary > *file_.wavelength_count)) {
            refuse({file_.path}, file_.primary_line, file_.primary_line.rest,
                   fmt::format("one of the {} wavelengths of the file", result.wavelengths_um.size()),
                   "Give the wavelengths in lines WAVM, and the primary one's number in PWAV.");
        }
        result.primary_wavelength_um = primary->second;
    }

    File file_;
    bool unfolded_ = false; // true if the lens had mirrors
};

} // namespace

ZmxLens parse_zmx(std::string_view bytes, const std::filesystem::path& file, const GlassCatalog& glasses,
                  std::optional<int> configuration) {
    return Builder(read_lines(bytes, file, glasses, configuration)).lens();
}

ZmxLens read_zmx(const std::filesystem::path& file, const GlassCatalog& glasses, std::optional<int> configuration) {
    return parse_zmx(read_file(file, {.expected = "a Zemax lens file (.zmx)"}), file, glasses, configuration);
}

} // namespace vkfv::optics
