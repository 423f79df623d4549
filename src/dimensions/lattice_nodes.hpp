// The places of a cross grating's nodes, by which the lateral scales of an instrument are known.
#pragma once

#include "dimensions/feature.hpp"

#include <optional>
#include <vector>

namespace vkfv::dimensions {

// A node of the lattice, in the feature's frame (mm).
struct LatticeNode {
    double u = 0, v = 0;         // nominal place: whole periods from the origin
    double off_u = 0, off_v = 0; // measured place less the nominal one
};

// The nodes whose neighbourhood of one period to either side lies in the map and is measured, but for a hundredth. A
// node's place is told by the phases of the two fundamental waves in that neighbourhood, under Hann windows of two
// periods, which are zero at all harmonics and at the mean. Waves that stand at right angles only: no nodes for another
// angle.
std::vector<LatticeNode> lattice_nodes(const surface::HeightMap& map, const CrossGrating& grating);

// The affine part of a lattice's distortion, by least squares over the nodes. Standard errors are those of the scatter
// of the nodes about it.
struct LatticeMap {
    double amplification_u = 0, amplification_v = 0; // measured over nominal pitch
    double perpendicularity = 0;                     // rad, the angle between the measured axes less 90 degrees
    double amplification_error = 0;                  // standard error of the less certain amplification
    double perpendicularity_error = 0;               // rad
    double largest_deviation = 0;    // mm, the farthest node from the affine map: the x-y mapping deviation
    double scatter = 0;              // mm, standard deviation of a coordinate about the affine map
    std::vector<LatticeNode> rest{}; // the nodes, whose off_u and off_v are what the affine map leaves
};
// None for fewer than four nodes, or nodes on one line.
std::optional<LatticeMap> lattice_map(const std::vector<LatticeNode>& nodes);

} // namespace vkfv::dimensions
