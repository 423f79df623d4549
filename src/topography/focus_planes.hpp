// The work on a stack's images and focus curves, plane by plane: what is to be done when is StackEvaluator's, how it is
// done is the host's (host_focus_planes.hpp) or a device's.
#pragma once

#include "topography/axial_average.hpp"
#include "topography/focus_measure.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace vkfv::topography {

// What one pass over a stack leaves of it, pixel by pixel.
struct StackSummary {
    Grid<float> brightness;      // sum over the images of the channels' mean
    Channels all_in_focus;       // each pixel from the images around its maximum
    std::vector<float> gathered; // averaged curves' values at the plan's pixels, one image after the other
};

// Of the pixel row * columns + column.
using RecordTask = std::function<void(std::size_t pixel, const focus::f64::CurveRecord& curve,
                                      const focus::f64::SingleRecord& single)>;

struct FocusPlanesPlan {
    focus::f64::FocusPlan plan{};
    FocusWindow window;
    // Images are averaged before they are measured: joint_value() (records.glsl) is the averaged curves' value then.
    bool images_averaged = false;
    // How many of the last images, of the curves (with those of single images), and of the averaged curves with what
    // follow() compares are asked for again.
    int images_kept = 0;
    int curves_kept = 0;
    int averaged_curves_kept = 0;
    std::vector<std::uint32_t> gathered_pixels{}; // see gather()
};

class FocusPlanes {
  public:
    virtual ~FocusPlanes() = default;
    // The next image; they come in order.
    virtual void take(int image, Channels channels) = 0;
    // The focus measure of the weighted mean of images taken: the curves' values at `image`.
    virtual void measure(int image, std::span<const Share> shares) = 0;
    // The focus measure of the image itself, which was measured last, for follow_single() of every pixel. Keeps its
    // square.
    virtual void measure_alone(int image) = 0;
    // alone_value() (records.glsl) at `image`: the weighted mean of what measure_alone() kept.
    virtual void average_alone(int image, std::span<const Share> shares) = 0;
    // joint_value() at `image` where images are not averaged: the focus measure of the weighted mean of images taken.
    virtual void measure_joint(int image, std::span<const Share> shares) = 0;
    // The weighted mean of curves measured: the averaged curves' values at `image`.
    virtual void average(int image, std::span<const Share> shares) = 0;
    // Keeps the averaged curves' values at `image`, which was averaged last, of the plan's pixels.
    virtual void gather(int image) = 0;
    // follow_curve() of every pixel; `images` averaged curves are there.
    virtual void follow(int image, int images) = 0;
    virtual StackSummary summary() = 0;
    // What is left of every pixel's curves, once summary() has been asked for: calls `task` once a pixel, from several
    // threads and in any order.
    virtual void visit_records(const RecordTask& task) = 0;
};

using FocusPlanesMaker = std::function<std::unique_ptr<FocusPlanes>(const FocusPlanesPlan&)>;

} // namespace vkfv::topography
