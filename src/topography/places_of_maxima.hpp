// The place of a focus curve from the place of its maximum after the averages along z. Away from the ends both are the
// same. Near them less is averaged the nearer the end, so that values there stand higher: a maximum moves towards the
// end, by up to a third of the curve's standard deviation. The wider the curve, the more it moves, and within a stack
// widths differ: a window on a slope has texture of many heights, and fine texture fades sooner than coarse. The
// curvature at the maximum shows how narrow a curve is.
#pragma once

#include "topography/peak_method.hpp"

#include <vector>

namespace vkfv::topography {

// Method and range by which the maximum of a curve is found.
struct PeakFinder {
    PeakMethod method = PeakMethod::gaussian;
    int range = 1; // steps on either side
};

// For every point of the curve, in steps of the scan and inside it: the middle of the Gaussian of standard deviation
// curve_width (steps) whose maximum, after both averages by these weights (axial_weights()), is found there. Points
// that no such maximum reaches follow at the distances of averaged_points(). curve_width 0: the points themselves.
std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width,
                                     const PeakFinder& finder);

// The curvature of the logarithm of a curve at its maximum, steps^-2: 1 / width^2 for a Gaussian. It is computed from
// three values: bend is twice the largest less both neighbours, over the largest; offset is the maximum's distance from
// the largest in steps. 0: the curve does not bend.
double curvature_at_maximum(double bend, double offset);

// A Gaussian whose averaged maximum is found near an end.
struct MaximumNearEnd {
    double place;     // its middle, in steps from that end
    double found;     // the averaged curve's maximum, in steps from that end
    double curvature; // curvature of the averaged curve at its maximum: curvature_at_maximum()
    int image;        // image of its largest value, counted from that end
};

// The places for curves of other widths than the stack's, up to 2.8 times as wide or as narrow. A width is given as the
// logarithm of its ratio to the stack's.
class PlacesByWidth {
  public:
    // No end moves any maximum.
    PlacesByWidth() = default;
    // Arguments are those of places_of_maxima().
    PlacesByWidth(const std::vector<double>& weights, int images, double curve_width, const PeakFinder& finder);

    // True if an end moves maxima that are found at `at`, in steps of the scan and inside it.
    bool feels_an_end(double at) const;

    struct Width {
        double logarithm = 0; // logarithm of the width over the stack's
        double weight = 0;    // inverse variance, up to a factor, from the curvature's dependence on the width there
    };
    // The width of the curve whose averaged maximum is found at the distance `offset` from the image of its largest
    // value and has this curvature; the nearest width if none has it.
    Width width(int image, double offset, double curvature) const;

    // The place of a curve of this width whose averaged maximum is found at `at`, where an end is felt.
    double place(double at, double logarithm) const;

  private:
    double from_the_end(double at) const;
    double place_of(std::size_t width, double found) const;
    double curvature_of(std::size_t width, int image, double found) const;

    int images_ = 0;
    double last_ = 0;                                   // distance from the end beyond which it is not felt, steps
    std::vector<std::vector<MaximumNearEnd>> by_width_; // from narrow to wide
    std::vector<double> line_;                          // places of curves as wide as the scan, averaged_points()
};

} // namespace vkfv::topography
