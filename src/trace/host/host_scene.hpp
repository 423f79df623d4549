// The scene that the shared physics reads on the host, in double.
#pragma once

#include "optics/instrument/room.hpp"
#include "specimen/intersector.hpp"
#include "trace/interface/emission_order.hpp"

namespace vkfv::trace {

struct HostScene {
    optics::TrainScene trains;
    const specimen::Intersector* intersector;
    const optics::Room* room = nullptr;      // only for non-sequential paths
    const EmissionCells* emission = nullptr; // only for forward paths

    const physics::f64::Surface& surface_at(int index) const { return trains.surface_at(index); }
    physics::f64::EmissionCell emission_cell(glm::uvec2 path) const {
        return emission->of((std::uint64_t{path.y} << 32) | path.x);
    }
    std::uint32_t features() const { return trains.features() | intersector->features(); }
    const physics::f64::SpectralBin& spectral_bin(int index) const { return trains.spectral_bin(index); }
    physics::f64::Hit specimen_hit(physics::f64::real3 origin, physics::f64::real3 direction) const {
        return intersector->hit(origin, direction);
    }
    physics::f64::LightField light_field() const { return trains.light_field(); }
    double pattern_point(const physics::f64::Pattern& pattern, int column, int row) const {
        return pattern.of_light != 0 ? trains.pattern_point(pattern, column, row)
                                     : intersector->reflectance_at(column, row);
    }
    double material_number(int index) const { return intersector->material_number(index); }
    const physics::f64::Element& element_at(int index) const { return room->elements[static_cast<std::size_t>(index)]; }
    const physics::f64::Facet& facet_at(int index) const { return room->facets[static_cast<std::size_t>(index)]; }
    physics::f64::ElementHit nearest_element(physics::f64::real3 origin, physics::f64::real3 direction,
                                             physics::f64::PathPlace from) const {
        return optics::nearest_element(*room, origin, direction, from);
    }
};

} // namespace vkfv::trace
