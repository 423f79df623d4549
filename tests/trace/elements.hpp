// Elements alone, and the microscope and the images that the tests of light without a given sequence share.
#pragma once

#include "optics/instrument/room.hpp"
#include "support/statistics.hpp"
#include "trace/microscope.hpp"

#include <cmath>
#include <vector>

namespace vkfv::test {

using namespace physics::f64;

inline trace::TraceOptions options(trace::Traversal traversal, bool nonsequential = true) {
    trace::TraceOptions result;
    result.rays = 200000;
    result.seed = 3;
    result.max_bounces = 2;
    result.traversal = traversal;
    result.nonsequential = nonsequential;
    return result;
}

// A microscope with few pixels, so that few rays make a sharp test.
inline optics::InstrumentDescription coarse_microscope() {
    auto description = test::microscope_description();
    description.detector_pixels = ImageSize::square(8);
    return description;
}

// The p-value that two independent images have the same expectation.
inline double same_expectation_p(const trace::Image& a, const trace::Image& b) {
    double chi_square = 0;
    double degrees = 0;
    for (std::size_t k = 0; k < a.flux.values.size(); ++k) {
        const double variance = std::pow(a.standard_error.values[k], 2) + std::pow(b.standard_error.values[k], 2);
        if (variance > 0) { // else dark in both
            chi_square += std::pow(a.flux.values[k] - b.flux.values[k], 2) / variance;
            degrees += 1;
        }
    }
    return test::chi_square_tail(chi_square, degrees);
}

// A specimen of little roughness and a narrow lobe, so that much of the light returns.
inline specimen::Specimen smooth_specimen() {
    return test::rough_specimen(0.95, 0.0002);
}

// A scene of given elements alone.
struct Bench {
    optics::Room room;
    Surface surface_at(int) const { return {}; }
    std::uint32_t features() const { return room.facets.empty() ? 0u : FEATURE_FACETS; }
    SpectralBin spectral_bin(int) const { return {}; }
    Hit specimen_hit(real3, real3) const { return {}; }
    double pattern_point(const Pattern&, int, int) const { return 1; }
    double material_number(int) const { return 0; }
    LightField light_field() const { return {}; }
    Element element_at(int index) const { return room.elements[static_cast<std::size_t>(index)]; }
    Facet facet_at(int index) const { return room.facets[static_cast<std::size_t>(index)]; }
    ElementHit nearest_element(real3 origin, real3 direction, PathPlace from) const {
        return optics::nearest_element(room, origin, direction, from);
    }

    void add(Element element, const optics::Pose& pose) {
        element.origin = pose.origin;
        element.axis_x = pose.axes[0];
        element.axis_y = pose.axes[1];
        element.axis_z = pose.axes[2];
        element.rim_radius = element.outer_radius = radius;
        element.surface.semi_diameter_squared = radius * radius;
        room.elements.push_back(element);
        room.surfaces = room.elements.size();
    }
    void add_mesh(const optics::PlacedMesh& mesh) {
        room.add_mesh(mesh);
        room.grow_facet_tree();
    }
    void add_plate(const optics::Pose& first, double thickness, double index) {
        Element face{};
        face.kind = ELEMENT_INTERFACE;
        face.surface.flags = SURFACE_FRESNEL;
        face.surface.index_before = 1;
        face.surface.index_after = index;
        add(face, first);
        std::swap(face.surface.index_before, face.surface.index_after);
        add(face, first.along_z(thickness));
    }
    void add_detector(double height) {
        Element detector{};
        detector.kind = ELEMENT_DETECTOR;
        detector.surface.index_before = detector.surface.index_after = 1;
        add(detector, optics::Pose{}.along_z(height));
    }

    static constexpr double radius = 20;
};

// A fine parallel pencil up the axis from z = -1.
inline physics::f64::Instrument pencil(double half_size, int pixels) {
    physics::f64::Instrument instrument{};
    instrument.source_radius = 0.01;
    instrument.emission_sine = 1e-5;
    instrument.magnification = 1;
    instrument.detector_half_width = half_size;
    instrument.detector_half_height = half_size;
    instrument.detector_columns = pixels;
    instrument.detector_rows = pixels;
    instrument.pixel_reach = 1;
    instrument.spectrum_centre = 4;
    instrument.spectrum_half_width = 1;
    return instrument;
}

constexpr SourceFrame below_the_axis() {
    return {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

inline std::vector<Detection> trace_bench(const Bench& bench, const physics::f64::Instrument& instrument,
                                          std::uint32_t paths) {
    std::vector<Detection> ends;
    ends.reserve(paths);
    const Exposure exposure{.top_distance = 0,
                            .seed = 5,
                            .image = 1,
                            .focal_height = 0,
                            .top_distance_residual = 0,
                            .beside_x = 0,
                            .beside_y = 0,
                            .magnification_change = 0};
    for (std::uint32_t path = 0; path < paths; ++path) {
        ends.push_back(
            trace_nonsequential(bench, instrument, SpecimenRecord{}, exposure, below_the_axis(), uvec2(path, 0)));
    }
    return ends;
}

inline double detected_share(const std::vector<Detection>& ends) {
    double detected = 0;
    for (const Detection& end : ends) {
        detected += end.fate.status == PATH_DETECTED ? 1 : 0;
    }
    return detected / static_cast<double>(ends.size());
}

} // namespace vkfv::test
