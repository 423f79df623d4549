// The heights of a specimen on the grid on which its waves are computed.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "core/messages/warning.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/specimen.hpp"

#include <glm/glm.hpp>

#include <complex>
#include <cstddef>
#include <vector>

namespace vkfv::fields {

// A grid of a detector's pixels, each divided into `parts` along its side, with a margin about them.
struct FieldGrid {
    ImageSize pixels;
    int parts = 1;
    int margin_x = 0,
        margin_y = 0; // points on either side of the pixels; where lengths are odd, the first side has less
    int columns = 0, rows = 0;
    double pitch = 0; // mm
};

// The grid on which light of this cutoff (cycles per mm) does not alias, with a margin of several resolution limits so
// that the two ends of the periodic grid do not touch. pitch: of the pixels in the object, mm.
FieldGrid field_grid(ImageSize pixels, double pitch, double cutoff);

struct SampledSurface {
    FieldGrid grid;
    Grid<double> heights{};    // mm, the mean over the cell, of an edge that in its middle; 0 where there is none
    Grid<double> amplitude{};  // of reflection; 0 beside the specimen
    Grid<glm::dvec2> slopes{}; // within the point's cell
    // Points in whose cells the surface is no plane, as at the edge of a step, and the heights there at places that
    // divide the cell evenly: parts_of_edge for each point, one after the other.
    static constexpr int parts_of_edge = 64;
    std::vector<std::size_t> edges{};
    std::vector<double> edge_heights{};
    double lowest = 0, highest = 0;
    // Shares of the points whose neighbours differ by more phase than pi, whose radius of curvature is below the
    // wavelength, and where a neighbourhood hides a part of the light.
    double steep = 0, sharp = 0, shadowed = 0;
};

// The mean over each point's cell of a wave exp(-i q h) that the surface reflects, h less `zero` (mm): so the spectrum
// beyond the grid's is filtered by the cell's before it folds.
void reflect(const SampledSurface& surface, double wave_number, double zero, Grid<std::complex<double>>& wave);

// Samples the specimen where the pixels look. Throws InputError, by the key, for a specimen without heights (a mesh), a
// pattern or a material that is no mirror, and for surfaces beyond the limits of Kirchhoff's integral.
SampledSurface sample_surface(const specimen::Specimen& specimen, const FieldGrid& grid, double wavelength_um,
                              double aperture_sine);

std::vector<Warning> warnings_of(const SampledSurface& surface);

} // namespace vkfv::fields
