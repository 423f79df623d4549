#include "optics/prescriptions/ideal_lens.hpp"

#include <fmt/format.h>

namespace vkfv::optics {

Prescription ideal_lens(double focal_length) {
    Prescription lens;
    lens.name = fmt::format("ideal lens f = {:g} mm", focal_length);
    lens.title = lens.name;
    lens.medium_before = Medium::air();
    PrescribedSurface surface;
    surface.ideal_power = 1 / focal_length;
    surface.medium_after = Medium::air();
    lens.surfaces = {surface};
    return lens;
}

Prescription ideal_objective(double focal_length, double numerical_aperture) {
    Prescription objective = ideal_lens(focal_length);
    objective.surfaces.front().thickness = focal_length;
    PrescribedSurface stop;
    stop.medium_after = Medium::air();
    stop.semi_diameter = focal_length * numerical_aperture;
    stop.role = PrescribedSurface::Role::aperture_stop;
    objective.surfaces.push_back(stop);
    return objective;
}

} // namespace vkfv::optics
