// The spline filter of a map without gaps.
#pragma once

#include "surface/height_map.hpp"
#include "surface/spline_filter.hpp"

#include <array>
#include <vector>

namespace vkfv::surface {

// The spline filter (1 + B)^-1 of a map without gaps, where B is the matrix of the bending energy of spline_filter.hpp.
//
// With mirrored ends cosine transforms turn B into a factor. Natural ends have less energy: along x, a_x^4 times the
// square of the difference of the two outermost points is missing in every row at either end, and likewise along y.
// This is a correction of rank 2 (columns + rows), found by conjugate gradients among the cosines' amplitudes
// (Woodbury). Even and odd cosines do not mix.
class WholeSpline {
  public:
    WholeSpline(const HeightMap& map, double nesting_index, SplineEnds ends);

    // Filters heights in the order of the map's grid.
    std::vector<double> low_pass(std::vector<double> heights) const;

  private:
    // The summed slopes of the even and of the odd cosines at the ends, by the index of the cosine along the border: at
    // the ends along x (one entry for each row of amplitudes) and along y (one for each column).
    struct Slopes {
        std::array<std::vector<double>, 2> at_x, at_y;
    };

    Slopes slopes_of(const Grid<double>& amplitudes) const;
    Slopes times_correction(const Slopes& slopes) const;
    Slopes solved(const Slopes& right) const;
    void free_ends(Grid<double>& amplitudes) const;

    int columns_, rows_;
    SplineEnds ends_;
    Grid<double> transmission_;            // transmission of the filter with mirrored ends
    double missing_x_ = 0, missing_y_ = 0; // 2 a^4
    std::vector<double> end_x_, end_y_;    // slope of each cosine at its end
    Slopes diagonal_;
};

} // namespace vkfv::surface
