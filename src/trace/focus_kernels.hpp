// The evaluation of a focus stack on a Vulkan device, in float: images come from the trace, each is handed over once,
// and only what is left of all of them comes back. The algorithm is shaders/focus/'s.
#pragma once

#include "core/grid.hpp"
#include "focus/focus.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vkfv::trace {

// How many of the last images and curves are asked for again.
struct FocusDepths {
    int images = 0;
    int curves = 0;
    int averaged_curves = 0;
};

// A term of a weighted mean.
struct FocusTerm {
    int image;
    float weight;
};

// What is left of a stack, a value a pixel; rows ascend with y.
struct FocusResult {
    Grid<float> brightness;          // sum over the images of the channels' mean
    Grid<float> squared_differences; // sum over images and channels of (I[k-1] - 2 I[k] + I[k+1])^2
    Grid<focus::f32::CurveRecord> curves;
    std::vector<Grid<float>> all_in_focus; // a grid a channel
};

// The steps of one evaluation; who calls them sees to their order, and that nothing is asked for that is older than the
// depths.
class FocusKernels {
  public:
    // selector: an index or a part of the device's name, as TraceOptions::device. window_weights: of the distances
    // 0 ... plan.window_radius. Throws DeviceError.
    FocusKernels(const std::string& selector, const focus::f32::FocusPlan& plan, std::span<const float> window_weights,
                 const FocusDepths& depths);
    ~FocusKernels();

    // The next image, a grid a channel.
    void take(int image, std::span<const Grid<float>> channels);
    // The focus measure of a weighted mean of images: the curves' values at `image`.
    void measure(int image, std::span<const FocusTerm> terms);
    // The weighted mean of curves: the averaged curves' values at `image`.
    void average(int image, std::span<const FocusTerm> terms);
    // follow_curve() of every pixel; `images` averaged curves are there.
    void follow(int image, int images);
    FocusResult result();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Whether the device of this selector has cores of its own, so that an evaluation there costs the host nothing. Throws
// DeviceError.
bool is_hardware(const std::string& selector);

} // namespace vkfv::trace
