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

Prescription with_front(Prescription objective, double working_distance, const Medium& medium, double index) {
    PrescribedSurface front;
    front.medium_after = medium;
    front.thickness = index / objective.surfaces.front().ideal_power.value() - working_distance;
    objective.surfaces.insert(objective.surfaces.begin(), front);
    return objective;
}

Prescription ideal_koehler(double condenser_focal_length, double field_lens_focal_length) {
    Prescription illuminator = ideal_lens(condenser_focal_length);
    illuminator.name = fmt::format("ideal Köhler illuminator, condenser f = {:g} mm, field lens f = {:g} mm",
                                   condenser_focal_length, field_lens_focal_length);
    illuminator.title = illuminator.name;
    illuminator.source_distance = condenser_focal_length;
    illuminator.surfaces.front().thickness = condenser_focal_length;
    PrescribedSurface field_stop;
    field_stop.medium_after = Medium::air();
    field_stop.thickness = field_lens_focal_length;
    field_stop.role = PrescribedSurface::Role::field_stop;
    illuminator.surfaces.push_back(field_stop);
    illuminator.surfaces.push_back(ideal_lens(field_lens_focal_length).surfaces.front());
    return illuminator;
}

} // namespace vkfv::optics
