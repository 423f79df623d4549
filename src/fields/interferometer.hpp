// The images of an interferometer, as waves of the specimen's height map make them with those of a reference mirror.
#pragma once

#include "fields/fringe_transfer.hpp"
#include "fields/reference_arm.hpp"
#include "fields/sampled_surface.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <complex>
#include <memory>
#include <vector>

namespace vkfv::fields {

// What images of a scan have in common, and the numbers of which host and device make each of them.
struct FringeFields {
    ImageSize pixels;
    std::vector<double> wave_numbers; // q_z of the nodes, rad/mm
    double height_offset = 0;         // mm: a frame at the focal height z has the phases q_z (z - height_offset)
    // IFFT[H FFT[exp(-i q_z h)]], averaged over each pixel: real and imaginary parts, node by node.
    std::vector<Grid<std::complex<float>>> nodes;
    Grid<float> background; // W
    double signal = 0;      // W: the image is background + signal times the real part of the sum over the nodes
    double emitted = 0;     // W
};

struct FocalRange {
    double lowest = 0, highest = 0; // mm
};

// The surface as the fields see it. Throws InputError where they do not hold for it.
SampledSurface surface_of(const optics::Instrument& instrument, const optics::InstrumentDescription& description,
                          const specimen::Specimen& specimen);

// All that the fields of the nodes are made of, by the host or by a device.
struct FieldParts {
    SampledSurface surface;
    FringeTransfer transfer;
    FringeFields fields;      // without the nodes' fields
    double middle_height = 0; // mm, which heights are counted from
    glm::dvec2 tilt{0};       // slopes of the reference mirror
};

// Throws InputError where a part of the instrument or the specimen has no meaning here. description: of the instrument.
FieldParts field_parts(const optics::Instrument& instrument, const optics::InstrumentDescription& description,
                       const specimen::Specimen& specimen, const ReferenceArm& arm, FocalRange range);

// Makes the nodes' fields by the host's cores in double.
void add_nodes(FieldParts& parts);

// Makes the fields by the host's cores in double. description: of the instrument. Throws InputError where a part of the
// instrument or the specimen has no meaning here.
FringeFields fringe_fields(const optics::Instrument& instrument, const optics::InstrumentDescription& description,
                           const specimen::Specimen& specimen, const ReferenceArm& arm, FocalRange range);

// A tracer whose exposures are such images: no rays, no noise. Focal heights must lie in the range: RunError otherwise.
std::unique_ptr<trace::Tracer> make_host_interferometer(const optics::Instrument& instrument,
                                                        const optics::InstrumentDescription& description,
                                                        const specimen::Specimen& specimen, const ReferenceArm& arm,
                                                        FocalRange range);

// The wave numbers q_z (rad/mm) between which the fringes of an instrument lie, less what 4 standard deviations of a
// Gaussian spectrum leave.
struct FringeBand {
    double least = 0, most = 0;
};
FringeBand fringe_band(const optics::Spectrum& spectrum, double numerical_aperture, double index);

} // namespace vkfv::fields
