// The evaluation of a stack's images and focus curves, plane by plane: StackEvaluator decides on the steps; the host
// (host_focus_planes.hpp) or a device carries them out.
#pragma once

#include "topography/axial_average.hpp"
#include "topography/focus_measure.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace vkfv::topography {

// The result of one pass over a stack, by pixel.
struct StackSummary {
    Grid<float> brightness;      // sum over the images of the channels' mean
    Channels all_in_focus;       // each pixel from the images around its maximum
    std::vector<float> gathered; // averaged curves' values at the plan's pixels, one image after the other
};

// Task for the records of the pixel row * columns + column.
using RecordTask = std::function<void(std::size_t pixel, const focus::f64::CurveRecord& curve,
                                      const focus::f64::SingleRecord& single)>;

struct FocusPlanesPlan {
    focus::f64::FocusPlan plan{};
    FocusWindow window;
    // True: images are averaged before they are measured, and joint_value() (records.glsl) is the averaged curves'
    // value.
    bool images_averaged = false;
    // Numbers of the last images, of the last curves' values (with those of single images), and of the last averaged
    // curves' values (with the values for follow()) that are needed again.
    int images_kept = 0;
    int curves_kept = 0;
    int averaged_curves_kept = 0;
    std::vector<std::uint32_t> gathered_pixels{}; // see gather()
};

class FocusPlanes {
  public:
    virtual ~FocusPlanes() = default;
    // Takes the next image; they come in order.
    virtual void take(int image, Channels channels) = 0;
    // Makes the curves' values at `image`: the focus measure of the weighted mean of images taken.
    virtual void measure(int image, std::span<const Share> shares) = 0;
    // Makes the focus measure of the image itself, which was measured last, for follow_single() of every pixel, and
    // keeps its square.
    virtual void measure_alone(int image) = 0;
    // Makes alone_value() (records.glsl) at `image`: the weighted mean of the squares kept by measure_alone().
    virtual void average_alone(int image, std::span<const Share> shares) = 0;
    // Makes joint_value() at `image` where images are not averaged: the focus measure of the weighted mean of images
    // taken.
    virtual void measure_joint(int image, std::span<const Share> shares) = 0;
    // Makes the averaged curves' values at `image`: the weighted mean of curves measured.
    virtual void average(int image, std::span<const Share> shares) = 0;
    // Keeps the averaged curves' values at `image`, which was averaged last, for the plan's pixels.
    virtual void gather(int image) = 0;
    // Calls follow_curve() for every pixel; `images`: number of averaged curves' values made so far.
    virtual void follow(int image, int images) = 0;
    virtual StackSummary summary() = 0;
    // Calls `task` with every pixel's records, after summary(): once a pixel, from several threads and in any order.
    virtual void visit_records(const RecordTask& task) = 0;
};

using FocusPlanesMaker = std::function<std::unique_ptr<FocusPlanes>(const FocusPlanesPlan&)>;

} // namespace vkfv::topography
