// Lenses without a prescription: aplanatic, without aberrations and dispersion (physics::pass_ideal_lens).
#pragma once

#include "optics/prescriptions/prescription.hpp"

namespace vkfv::optics {

// An ideal lens as one surface. focal_length: mm.
Prescription ideal_lens(double focal_length);

// An ideal lens with the aperture stop in its back focal plane, where Abbe's sine condition gives the numerical
// aperture's cone the radius focal_length * numerical_aperture (mm).
Prescription ideal_objective(double focal_length, double numerical_aperture);

// An ideal objective whose front is a plane without effect on light, at the working distance (mm) from its front focal
// plane. `medium` is below it, of that index at the reference wavelength. With a long working distance the front lies
// behind the lens that stands for the whole objective: light goes back to it, as to a principal plane.
Prescription with_front(Prescription objective, double working_distance, const Medium& medium, double index);

// Köhler illumination by two ideal lenses, in the direction from the source. The source stands in the front focal plane
// of the condenser, the field stop in the condenser's back focal plane, which is the front focal plane of the field
// lens. So each point of the source lights the whole field stop evenly, and the source is imaged into the back focal
// plane of the field lens, field_lens_focal_length / condenser_focal_length times larger. Focal lengths in mm; the
// field stop is open.
Prescription ideal_koehler(double condenser_focal_length, double field_lens_focal_length);

} // namespace vkfv::optics
