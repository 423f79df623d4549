// Parsers for the figures of an instrument's data sheets, in the short words that `vkfv new` takes, such as "20x/0.45"
// and "ring:40-60mm@30deg". All parsers throw InputError with the option as its key.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vkfv::measurement {

// An ideal lens with a tube lens, a telecentric lens that images by itself, or an objective of the assets.
struct SheetObjective {
    enum class Kind { ideal, telecentric, prescription } kind = Kind::ideal;
    std::string text; // as given
    double magnification = 0;
    double numerical_aperture = 0;          // in air
    double tube_length = 200;               // mm, of the tube lens that the magnification is stated for
    std::optional<double> working_distance; // mm
    std::optional<double> parfocal_length;  // mm

    double focal_length() const; // mm
};
// Takes "20x/0.45", "telecentric:2x/0.1", or a name that `vkfv list objectives` prints, such as "10x_0.28".
SheetObjective parse_objective(std::string_view text);

struct SheetCamera {
    std::string text;
    std::string sensor; // a name that `vkfv list cameras` prints; empty: pixels alone
    int columns = 0;
    int rows = 0;
    double pixel_um = 0;
};
// Takes a sensor's name, "2448x2048@3.45um", or an optical format with pixels: "2/3:2448x2048".
SheetCamera parse_camera(std::string_view text);

// Coaxial Köhler illumination, or a flat ring: diameters of its luminous face in mm, and either the face's height over
// the focus (mm) or the elevation of its light (degrees).
struct SheetLight {
    std::string text;
    bool ring = false;
    double inner_diameter = 40;
    double outer_diameter = 60;
    std::optional<double> working_distance;
    std::optional<double> elevation;
};
// Takes "coaxial", "ring", "ring:40-60mm@30deg" or "ring:40-60mm@15mm".
SheetLight parse_light(std::string_view text);

struct SheetLed {
    std::string text;
    std::string colour; // a name that `vkfv list leds` prints; empty: given by peak and width
    double peak_um = 0;
    double full_width_um = 0; // 0: white
};
// Takes a colour, "460nm" or "460nm/25nm" (peak and full width).
SheetLed parse_led(std::string_view text);

struct SheetSpecimen {
    enum class Kind { plane, step, sphere, sinusoid, surface } kind = Kind::plane;
    std::string text;
    double height = 0; // mm: of the step; from the valleys to the peaks of the sinusoid
    double length = 0; // mm: radius of the sphere, period of the sinusoid
    std::filesystem::path file;
};
// Takes "plane", "step:10um", "sphere:1mm" (its radius), "sinusoid:2um/50um" (height from valley to peak, period), or
// the path of a file with a measured surface.
SheetSpecimen parse_specimen(std::string_view text);

} // namespace vkfv::measurement
