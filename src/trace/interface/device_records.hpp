// The shared records, rounded from the host's double to the device's float.
#pragma once

#include "device/interface.hpp"
#include "optics/instrument/instrument.hpp"
#include "physics/physics.hpp"

#include <vector>

namespace vkfv::trace {

// The uniform block of all surfaces, padded to its capacity. Throws InputError when there are more.
std::vector<physics::f32::Surface> surface_block(const optics::Instrument& instrument);

// The uniform block of the spectrum, padded to its capacity. Throws InputError when there are more bins.
std::vector<physics::f32::SpectralBin> spectrum_block(const optics::Instrument& instrument);

physics::f32::Surface to_float(const physics::f64::Surface& record); // with its bend_residual
physics::f32::Element to_float(const physics::f64::Element& record);
physics::f32::Facet to_float(const physics::f64::Facet& record);
physics::f32::SourceFrame to_float(const physics::f64::SourceFrame& record);
physics::f32::Instrument to_float(const physics::f64::Instrument& record);
physics::f32::BackwardOptics to_float(const physics::f64::BackwardOptics& record);
physics::f32::Lattice to_float(const physics::f64::Lattice& record);
physics::f32::PupilCells to_float(const physics::f64::PupilCells& record);
// The record with bottom, top and slope rounded so that they still bound the surface.
physics::f32::SpecimenRecord to_float(const physics::f64::SpecimenRecord& record);
physics::f32::Exposure to_float(const physics::f64::Exposure& record); // with its top_distance_residual

} // namespace vkfv::trace
