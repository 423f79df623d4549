#include "topography/device_focus_planes.hpp"

#include "spirv/focus_columns.h"
#include "spirv/focus_follow.h"
#include "spirv/focus_mean.h"
#include "spirv/focus_noise.h"
#include "spirv/focus_response.h"
#include "spirv/focus_rows.h"
#include "spirv/focus_select.h"
#include "vulkan/kernel.hpp"

#include <algorithm>
#include <optional>

namespace vkfv::topography {

namespace {

using focus::f32::CurveRecord;
using focus::f32::FocusPlan;
using focus::f32::WindowSums;

constexpr std::uint32_t workgroup = 128;
constexpr std::uint32_t most_groups_in_a_row = 65535; // Vulkan's promise

// Push constants of the kernels.
struct Term {
    std::uint32_t count;
    std::uint32_t first_to;
    float weight;
    std::uint32_t first;
};
struct NoiseSizes {
    std::uint32_t pixels;
    std::uint32_t channels;
    std::uint32_t differences;
};
struct CurveStep {
    FocusPlan plan;
    std::int32_t at;
    std::int32_t images;
    std::int32_t kept;
};
struct Choice {
    std::uint32_t pixels;
    std::uint32_t channels;
    std::int32_t wanted;
};
static_assert(sizeof(FocusPlan) == 7 * 4 && sizeof(CurveRecord) == 10 * 4 && sizeof(WindowSums) == 2 * 4);

FocusPlan on_device(const focus::f64::FocusPlan& plan) {
    return {plan.columns, plan.rows, plan.channels, plan.measure, plan.window_radius, plan.peak, plan.peak_range};
}

focus::f64::CurveRecord in_double(const CurveRecord& curve) {
    return {curve.largest, curve.sum,    curve.offset, curve.residual, curve.at,
            curve.found,   curve.peak_1, curve.peak_2, curve.peak_3,   curve.peak_4};
}

std::vector<vulkan::BindingDeclaration> storage_buffers(std::uint32_t count) {
    std::vector<vulkan::BindingDeclaration> all;
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        all.push_back({slot, vulkan::BindingKind::storage_buffer});
    }
    return all;
}

class DeviceFocusPlanes final : public FocusPlanes {
  public:
    DeviceFocusPlanes(const std::string& selector, const FocusPlanesPlan& stack)
        : plan_(on_device(stack.plan)), averaged_curves_(stack.averaged_curves_kept),
          pixels_(static_cast<std::size_t>(plan_.columns) * static_cast<std::size_t>(plan_.rows)),
          channels_(static_cast<std::size_t>(plan_.channels)), device_(vulkan::DeviceOptions{selector}),
          mean_(device_, "focus_mean", focus_mean, storage_buffers(2), sizeof(Term)),
          noise_(device_, "focus_noise", focus_noise, storage_buffers(5), sizeof(NoiseSizes)),
          response_(device_, "focus_response", focus_response, storage_buffers(2), sizeof(FocusPlan)),
          rows_(device_, "focus_rows", focus_rows, storage_buffers(4), sizeof(FocusPlan)),
          columns_(device_, "focus_columns", focus_columns, storage_buffers(3), sizeof(FocusPlan)),
          follow_(device_, "focus_follow", focus_follow, storage_buffers(3), sizeof(CurveStep)),
          select_(device_, "focus_select", focus_select, storage_buffers(3), sizeof(Choice)),
          mean_image_(device_, channels_ * pixels_ * sizeof(float)), responses_(device_, pixels_ * sizeof(WindowSums)),
          row_sums_(device_, static_cast<std::size_t>(focus::f32::focus_fields(plan_)) * pixels_ * sizeof(WindowSums)),
          weights_(device_, stack.window.weights().size() * sizeof(float)),
          averaged_(device_, static_cast<std::size_t>(averaged_curves_) * pixels_ * sizeof(float)),
          records_(device_, pixels_ * sizeof(CurveRecord)), sharpest_(device_, pixels_ * sizeof(std::int32_t)),
          brightness_(device_, pixels_ * sizeof(float)), squared_differences_(device_, pixels_ * sizeof(float)),
          all_in_focus_(device_, channels_ * pixels_ * sizeof(float)) {
        const std::vector<float> weights(stack.window.weights().begin(), stack.window.weights().end());
        weights_.write_values(std::span<const float>(weights));
        brightness_.fill_zero();
        squared_differences_.fill_zero();
        all_in_focus_.fill_zero();
        for (int k = 0; k < stack.images_kept; ++k) {
            images_.emplace_back(device_, channels_ * pixels_ * sizeof(float));
        }
        for (int k = 0; k < stack.curves_kept; ++k) {
            curves_.emplace_back(device_, pixels_ * sizeof(float));
        }
    }

    void take(int image, Channels channels) override {
        submit();
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            image_at(image).write_values(std::span<const float>(channels[channel].values), channel * pixels_);
        }
        const bool differences = image >= 2;
        dispatch(noise_,
                 {&image_at(image), &image_at(differences ? image - 1 : image),
                  &image_at(differences ? image - 2 : image), &brightness_, &squared_differences_},
                 NoiseSizes{static_cast<std::uint32_t>(pixels_), static_cast<std::uint32_t>(channels_),
                            differences ? 1u : 0u},
                 pixels_);
    }

    void measure(int image, std::span<const Share> shares) override {
        const vulkan::Buffer* measured = &mean_image_;
        if (shares.size() == 1) {
            measured = &image_at(shares[0].image);
        } else {
            weighted_mean(
                shares, [&](int k) -> const vulkan::Buffer& { return image_at(k); }, mean_image_, 0,
                channels_* pixels_);
        }
        if (plan_.measure != focus::f32::FOCUS_STANDARD_DEVIATION) {
            dispatch(response_, {measured, &responses_}, plan_, pixels_);
        }
        dispatch(rows_, {measured, &responses_, &weights_, &row_sums_}, plan_, pixels_);
        dispatch(columns_, {&row_sums_, &weights_, &curve_at(image)}, plan_, pixels_);
    }

    void average(int image, std::span<const Share> shares) override {
        weighted_mean(
            shares, [&](int k) -> const vulkan::Buffer& { return curve_at(k); }, averaged_,
            static_cast<std::size_t>(image % averaged_curves_) * pixels_, pixels_);
    }

    void follow(int image, int images) override {
        dispatch(follow_, {&averaged_, &records_, &sharpest_}, CurveStep{plan_, image, images, averaged_curves_},
                 pixels_);
        const int first = std::max(0, image - plan_.peak_range);
        const int last = std::min(images - 1, image + plan_.peak_range);
        for (int k = first; k <= last; ++k) {
            dispatch(select_, {&image_at(k), &sharpest_, &all_in_focus_},
                     Choice{static_cast<std::uint32_t>(pixels_), static_cast<std::uint32_t>(channels_), k}, pixels_);
        }
    }

    StackSummary summary() override {
        submit();
        const auto grid = [&](const auto& values) {
            Grid<typename std::decay_t<decltype(values)>::value_type> result(plan_.columns, plan_.rows);
            result.values = values;
            return result;
        };
        StackSummary result;
        result.brightness = grid(brightness_.read_values<float>(pixels_));
        result.squared_differences = grid(squared_differences_.read_values<float>(pixels_));
        result.curves = Grid<focus::f64::CurveRecord>(plan_.columns, plan_.rows);
        std::ranges::transform(records_.read_values<CurveRecord>(pixels_), result.curves.values.begin(), in_double);
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            result.all_in_focus.push_back(grid(all_in_focus_.read_values<float>(pixels_, channel * pixels_)));
        }
        return result;
    }

  private:
    vulkan::Buffer& image_at(int k) { return images_[static_cast<std::size_t>(k) % images_.size()]; }
    vulkan::Buffer& curve_at(int k) { return curves_[static_cast<std::size_t>(k) % curves_.size()]; }

    template <class Push>
    void dispatch(const vulkan::Kernel& kernel, const std::vector<const vulkan::Buffer*>& buffers, const Push& push,
                  std::size_t invocations) {
        std::vector<vulkan::Binding> bindings;
        for (const vulkan::Buffer* buffer : buffers) {
            bindings.push_back({static_cast<std::uint32_t>(bindings.size()), buffer});
        }
        if (!commands_) {
            commands_.emplace(device_);
        }
        const auto groups = static_cast<std::uint32_t>((invocations + workgroup - 1) / workgroup);
        const std::uint32_t group_rows = (groups + most_groups_in_a_row - 1) / most_groups_in_a_row;
        commands_->dispatch(kernel, bindings, push, (groups + group_rows - 1) / group_rows, group_rows);
        commands_->barrier();
    }

    // first_to: in values.
    template <class Plane>
    void weighted_mean(std::span<const Share> shares, const Plane& plane, const vulkan::Buffer& to,
                       std::size_t first_to, std::size_t count) {
        for (std::size_t k = 0; k < shares.size(); ++k) {
            dispatch(mean_, {&plane(shares[k].image), &to},
                     Term{static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(first_to), shares[k].weight,
                          k == 0 ? 1u : 0u},
                     count);
        }
    }

    // What has been recorded since the last image, at once.
    void submit() {
        if (commands_) {
            commands_->submit_and_wait();
            commands_.reset();
        }
    }

    FocusPlan plan_;
    int averaged_curves_;
    std::size_t pixels_;
    std::size_t channels_;
    vulkan::Device device_;
    vulkan::Kernel mean_, noise_, response_, rows_, columns_, follow_, select_;
    vulkan::Buffer mean_image_, responses_, row_sums_, weights_, averaged_, records_, sharpest_, brightness_,
        squared_differences_, all_in_focus_;
    std::vector<vulkan::Buffer> images_; // the last few in turn
    std::vector<vulkan::Buffer> curves_; // likewise
    std::optional<vulkan::Commands> commands_;
};

} // namespace

FocusPlanesMaker device_focus_planes(const std::string& selector) {
    return [selector](const FocusPlanesPlan& plan) { return std::make_unique<DeviceFocusPlanes>(selector, plan); };
}

} // namespace vkfv::topography
