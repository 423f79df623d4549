// Where a focus curve lies whose maximum the averages along z bring to a point. Away from the ends that is the point.
// Near them less is averaged the nearer the end, so that what lies there stands higher: a maximum moves towards the
// end, by up to a third of the curve's standard deviation. The wider the curve, the more it moves, and within a stack
// widths differ: a window upon a slope has texture of many heights, and fine texture fades sooner than coarse. How
// narrow a curve is shows in how curved it is at its maximum.
#pragma once

#include "topography/peak_method.hpp"

#include <vector>

namespace vkfv::topography {

// How the maximum of a curve is found.
struct PeakFinder {
    PeakMethod method = PeakMethod::gaussian;
    int range = 1; // steps on either side
};

// For every point of the curve, in steps of the scan and inside it: the middle of that Gaussian of the standard
// deviation curve_width (steps) whose maximum, after both averages by these weights (axial_weights()), is found there.
// Points that none comes to follow in the distances of averaged_points(). curve_width 0: those points themselves.
std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width,
                                     const PeakFinder& finder);

// How curved the logarithm of a curve is at its maximum, steps^-2: 1 / width^2 of a Gaussian. By three values: bend is
// by how much the largest exceeds the mean of both its neighbours, twice, over the largest; offset is the maximum's
// distance from it in steps. 0: it does not bend.
double curvature_at_maximum(double bend, double offset);

// A Gaussian whose averaged maximum is found near an end.
struct MaximumNearEnd {
    double place;     // its middle, in steps from that end
    double found;     // the averaged curve's maximum, likewise
    double curvature; // of the averaged curve there, curvature_at_maximum()
    int image;        // of its largest value, likewise
};

// The same places for curves of other widths than the stack's, up to 2.8 times as wide or as narrow. A width is told as
// the logarithm of its ratio to the stack's.
class PlacesByWidth {
  public:
    // Ends are felt nowhere.
    PlacesByWidth() = default;
    // As for places_of_maxima().
    PlacesByWidth(const std::vector<double>& weights, int images, double curve_width, const PeakFinder& finder);

    // Whether an end moves maxima that are found there; at: in steps of the scan, inside it.
    bool feels_an_end(double at) const;

    struct Width {
        double logarithm = 0; // of the width over the stack's
        double weight = 0;    // inverse variance, up to a factor: how much the curvature depends on the width there
    };
    // Of the curve whose averaged maximum is found at the distance `offset` from the image of its largest value, and
    // has this curvature; the nearest width there is if none has it.
    Width width(int image, double offset, double curvature) const;

    // Where a curve of this width lies whose averaged maximum is found at `at`, where an end is felt.
    double place(double at, double logarithm) const;

  private:
    double from_the_end(double at) const;
    double place_of(std::size_t width, double found) const;
    double curvature_of(std::size_t width, int image, double found) const;

    int images_ = 0;
    double last_ = 0;                                   // from which distance to the end on it is not felt, steps
    std::vector<std::vector<MaximumNearEnd>> by_width_; // narrow to wide
    std::vector<double> line_;                          // places of curves as wide as the scan, averaged_points()
};

} // namespace vkfv::topography
