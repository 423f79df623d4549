// The metrological characteristics of a virtual instrument (ISO 25178-600): the standards that each is determined on,
// what it is computed by, and the figures of a certificate. A characteristic is one file of this folder.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "core/toml/toml_reader.hpp"
#include "measurement/surface/standard.hpp"
#include "report/chart.hpp"
#include "surface/height_map.hpp"

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The instrument's properties by which standards are chosen. Lengths in mm; the names in brackets are those of the
// manual's equations.
struct Conditions {
    ImageSize pixels;
    double pitch = 0;           // of the pixels on the specimen (p)
    double window = 0;          // width of the focus window (W)
    double resolution = 0;      // 0.61 times the wavelength over the numerical aperture
    double lowest = 0;          // lowest position of the scan
    double range = 0;           // way from the lowest to the highest position (R)
    double step = 0;            // distance of the positions (D)
    double curve_deviation = 0; // standard deviation of a focus curve (w)
    double blur = 0;            // radius of the light cone at a defocus of half the scan
    bool camera = false;        // false: images are light without a camera's noise
    bool small = false;         // fewer repetitions and places
    std::uint32_t seed = 0;     // the first seed of repeated measurements

    double field() const { return pitch * std::min(pixels.columns, pixels.rows); }
    double longer_field() const { return pitch * std::max(pixels.columns, pixels.rows); }
    double middle() const { return lowest + 0.5 * range; }
    // The heights that are measured without an influence of the scan's ends.
    double usable_range() const { return range - 4 * curve_deviation; }
    // The tangent of the angle between the axis and the rim of the light cone.
    double cone_slope() const { return range > 0 ? 2 * blur / range : 0; }
    // Nesting index of the S-filter before figures of a whole surface.
    double s_filter() const { return 2.5 * window; }
};

// A stack of one standard.
struct Trial {
    std::string name;                      // of its folder
    std::string specimen;                  // TOML of the table [specimen] and those below it
    std::vector<TomlOverride> overrides{}; // of other keys
};

// The heights that a trial measured. Maps are on the grid of the pixels; mm.
struct TrialResult {
    std::string name;
    surface::HeightMap heights{};
    surface::HeightMap truth{};
    Grid<double> uncertainty{}; // standard uncertainty of each height
    double height_noise = 0;    // median of the stated noise
    double measured_share = 0;  // share of the points
    std::vector<StandardDimension> dimensions{};
};

// A figure with its standard uncertainty, in its unit: "um", "nm", "deg", "percent" or none.
struct CertificateFigure {
    std::string key; // name in certificate.json, with its unit
    std::string title;
    std::string unit;
    double value = surface::undefined;
    double standard_uncertainty = surface::undefined;
    double degrees_of_freedom = std::numeric_limits<double>::infinity();

    // The factor k by Student's distribution, so that an interval of the half width k u covers 95 %; NaN without
    // degrees of freedom.
    double coverage_factor() const;
    // The half width k u of that interval.
    double expanded_uncertainty() const;
};

struct CertificateTable {
    std::string caption;
    std::vector<std::string> columns; // heads with their units
    std::vector<std::vector<double>> rows;
};

struct Findings {
    std::vector<CertificateFigure> figures;
    std::vector<CertificateTable> tables;
    std::vector<report::Chart> charts;
    std::vector<std::string> remarks; // sentences: where the procedure was not followed, and what a figure leaves out
};

struct Characteristic {
    std::string name;      // as --only takes it: "N_M"
    std::string title;     // "measurement noise"
    std::string standard;  // a sentence: what is measured
    std::string procedure; // sentences: how the figures come from it
    std::string equation;  // the same in LaTeX
    bool lateral = false;  // needs the larger field of a small calibration
    // The trials in their order. None if the instrument cannot measure any such standard: a remark then says why.
    std::vector<Trial> (*trials)(const Conditions& conditions, std::vector<std::string>& remarks);
    Findings (*evaluate)(const Conditions& conditions, std::span<const TrialResult> results);
};

// All characteristics, in the order of a certificate.
const std::vector<Characteristic>& characteristics();

Characteristic measurement_noise();
Characteristic flatness_deviation();
Characteristic vertical_amplification();
Characteristic lateral_mapping();
Characteristic lateral_resolution();
Characteristic slope_limit();
Characteristic least_roughness();
Characteristic repeatability();

} // namespace vkfv::measurement
