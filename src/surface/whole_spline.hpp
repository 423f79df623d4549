// The spline filter of a map without gaps.
#pragma once

#include "surface/height_map.hpp"
#include "surface/spline_filter.hpp"

#include <array>
#include <vector>

namespace vkfv::surface {

// The inverse of 1 + B, B what the bending energy of spline_filter.hpp is the square of, over the grid of a map.
//
// With mirrored ends cosine transforms turn B into a factor. Natural ends have less energy: along x a_x^4 times the
// square of the difference of the two outermost points is missing in every row and at either end, and so along y; which
// is a correction of rank 2 (columns + rows), found by conjugate gradients among the cosines' amplitudes (Woodbury).
// Even and odd cosines do not mix.
class WholeSpline {
  public:
    WholeSpline(const HeightMap& map, double nesting_index, SplineEnds ends);

    // Of heights in the order of the map's grid.
    std::vector<double> low_pass(std::vector<double> heights) const;

  private:
    // The slopes of even and odd cosines together at the ends, by the index of the cosine along the border: of the ends
    // along x (an entry a row of amplitudes) and along y (an entry a column).
    struct Slopes {
        std::array<std::vector<double>, 2> at_x, at_y;
    };

    Slopes slopes_of(const Grid<double>& amplitudes) const;
    Slopes times_correction(const Slopes& slopes) const;
    Slopes solved(const Slopes& right) const;
    void free_ends(Grid<double>& amplitudes) const;

    int columns_, rows_;
    SplineEnds ends_;
    Grid<double> transmission_;            // with mirrored ends
    double missing_x_ = 0, missing_y_ = 0; // 2 a^4
    std::vector<double> end_x_, end_y_;    // slope of each cosine at its end
    Slopes diagonal_;
};

} // namespace vkfv::surface
