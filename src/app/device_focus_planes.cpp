#include "app/device_focus_planes.hpp"

#include "trace/focus_kernels.hpp"

#include <algorithm>

namespace vkfv::app {

namespace {

std::vector<trace::FocusTerm> terms(std::span<const topography::Share> shares) {
    std::vector<trace::FocusTerm> result;
    for (const auto& share : shares) {
        result.push_back({share.image, share.weight});
    }
    return result;
}

focus::f64::CurveRecord in_double(const focus::f32::CurveRecord& curve) {
    return {curve.largest, curve.sum,    curve.offset, curve.residual, curve.at,
            curve.found,   curve.peak_1, curve.peak_2, curve.peak_3,   curve.peak_4};
}

class DeviceFocusPlanes final : public topography::FocusPlanes {
  public:
    DeviceFocusPlanes(const std::string& selector, const topography::FocusPlanesPlan& plan)
        : kernels_(selector,
                   {plan.plan.columns, plan.plan.rows, plan.plan.channels, plan.plan.measure, plan.plan.window_radius,
                    plan.plan.peak, plan.plan.peak_range},
                   std::vector<float>(plan.window.weights().begin(), plan.window.weights().end()),
                   {plan.images_kept, plan.curves_kept, plan.averaged_curves_kept}) {}

    void take(int image, topography::Channels channels) override { kernels_.take(image, channels); }
    void measure(int image, std::span<const topography::Share> shares) override {
        kernels_.measure(image, terms(shares));
    }
    void average(int image, std::span<const topography::Share> shares) override {
        kernels_.average(image, terms(shares));
    }
    void follow(int image, int images) override { kernels_.follow(image, images); }
    topography::StackSummary summary() override {
        auto result = kernels_.result();
        Grid<focus::f64::CurveRecord> curves(result.curves.columns, result.curves.rows);
        std::ranges::transform(result.curves.values, curves.values.begin(), in_double);
        return {std::move(result.brightness), std::move(result.squared_differences), std::move(curves),
                std::move(result.all_in_focus)};
    }

  private:
    trace::FocusKernels kernels_;
};

} // namespace

topography::FocusPlanesMaker device_focus_planes(const std::string& selector) {
    return [selector](const topography::FocusPlanesPlan& plan) {
        return std::make_unique<DeviceFocusPlanes>(selector, plan);
    };
}

} // namespace vkfv::app
