// The interferometers and specimens that the tests of fields share.
#pragma once

#include "core/mathematics/units.hpp"
#include "fields/interferometer.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/prescriptions/ideal_lens.hpp"
#include "specimen/description.hpp"
#include "trace/microscope.hpp"

#include <complex>
#include <string>

namespace vkfv::test {

// A microscope without aberrations, of so many pixels of this pitch in the object (um).
inline optics::InstrumentDescription interferometer(double aperture, double pitch_um, int columns, int rows,
                                                    optics::Spectrum spectrum) {
    optics::InstrumentDescription description;
    description.spectrum = std::move(spectrum);
    description.illumination = ideal_illuminator();
    description.objective = optics::ideal_objective(20, aperture);
    description.tube_lens = optics::ideal_lens(200);
    description.detector_pixels = {columns, rows};
    description.detector_width = from_um(10 * pitch_um * columns);
    description.source.radius = 1;
    const double fills = optics::assemble(description).first_order.pupil_radius_in_source;
    description.source.radius = fills;
    return description;
}

inline specimen::Material mirror(double reflectance = 1) {
    return {{{.model = "mirror", .weight = reflectance, .parameters = {}}}};
}

template <class Kind>
specimen::Specimen analytic(Kind kind, double size_um) {
    kind.size = from_um(size_um);
    kind.representation = specimen::Representation::analytic;
    return specimen::make({.shape = kind, .material = mirror()});
}

inline specimen::Specimen step_of(double height_um, double size_um) {
    specimen::Step step;
    step.height = from_um(height_um);
    step.wall = from_um(1e-3);
    return analytic(step, size_um);
}

inline specimen::Specimen flat_of(double tilt, double size_um) { // rad, along x
    specimen::Plane plane;
    plane.tilt_x = tilt;
    return analytic(plane, size_um);
}

// E of a pixel at a focal height (um): 1 of a level mirror in focus.
inline std::complex<double> fringe(const fields::FringeFields& fields, int column, int row, double height_um) {
    std::complex<double> sum = 0;
    for (std::size_t node = 0; node < fields.wave_numbers.size(); ++node) {
        sum += std::complex<double>(fields.nodes[node](column, row)) *
               std::polar(1.0, fields.wave_numbers[node] * (from_um(height_um) - fields.height_offset));
    }
    return sum;
}

inline fields::FringeFields fields_of(const optics::InstrumentDescription& description,
                                      const specimen::Specimen& specimen, double lowest_um, double highest_um,
                                      const fields::ReferenceArm& arm = {}) {
    return fields::fringe_fields(optics::assemble(description), description, specimen, arm,
                                 {.lowest = from_um(lowest_um), .highest = from_um(highest_um)});
}

// The message of the error that the work throws; empty if it throws none.
template <class Work>
std::string refusal(const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

} // namespace vkfv::test
