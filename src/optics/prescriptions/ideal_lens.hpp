// Lenses for whoever has no prescription: aplanatic, without aberrations (physics::pass_ideal_lens).
#pragma once

#include "optics/prescriptions/prescription.hpp"

namespace vkfv::optics {

// One surface. focal_length: mm.
Prescription ideal_lens(double focal_length);

// A lens, and the aperture stop in its back focal plane, where Abbe's sine condition gives the numerical aperture's
// cone the radius focal_length * numerical_aperture.
Prescription ideal_objective(double focal_length, double numerical_aperture);

} // namespace vkfv::optics
