#include "trace/focus_kernels.hpp"

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

namespace vkfv::trace {

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

std::vector<vulkan::BindingDeclaration> storage_buffers(std::uint32_t count) {
    std::vector<vulkan::BindingDeclaration> all;
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        all.push_back({slot, vulkan::BindingKind::storage_buffer});
    }
    return all;
}

} // namespace

struct FocusKernels::State {
    State(const std::string& selector, const FocusPlan& plan_, std::span<const float> window_weights,
          const FocusDepths& depths_)
        : plan(plan_), depths(depths_),
          pixels(static_cast<std::size_t>(plan.columns) * static_cast<std::size_t>(plan.rows)),
          channels(static_cast<std::size_t>(plan.channels)), device(vulkan::DeviceOptions{selector}),
          mean(device, "focus_mean", focus_mean, storage_buffers(2), sizeof(Term)),
          noise(device, "focus_noise", focus_noise, storage_buffers(5), sizeof(NoiseSizes)),
          response(device, "focus_response", focus_response, storage_buffers(2), sizeof(FocusPlan)),
          rows(device, "focus_rows", focus_rows, storage_buffers(4), sizeof(FocusPlan)),
          columns(device, "focus_columns", focus_columns, storage_buffers(3), sizeof(FocusPlan)),
          follow(device, "focus_follow", focus_follow, storage_buffers(3), sizeof(CurveStep)),
          select(device, "focus_select", focus_select, storage_buffers(3), sizeof(Choice)),
          mean_image(device, channels * pixels * sizeof(float)), responses(device, pixels * sizeof(WindowSums)),
          row_sums(device, static_cast<std::size_t>(focus::f32::focus_fields(plan)) * pixels * sizeof(WindowSums)),
          weights(device, window_weights.size() * sizeof(float)),
          averaged(device, static_cast<std::size_t>(depths.averaged_curves) * pixels * sizeof(float)),
          records(device, pixels * sizeof(CurveRecord)), sharpest(device, pixels * sizeof(std::int32_t)),
          brightness(device, pixels * sizeof(float)), squared_differences(device, pixels * sizeof(float)),
          all_in_focus(device, channels * pixels * sizeof(float)) {
        weights.write_values(window_weights);
        brightness.fill_zero();
        squared_differences.fill_zero();
        all_in_focus.fill_zero();
        for (int k = 0; k < depths.images; ++k) {
            images.emplace_back(device, channels * pixels * sizeof(float));
        }
        for (int k = 0; k < depths.curves; ++k) {
            curves.emplace_back(device, pixels * sizeof(float));
        }
    }

    vulkan::Buffer& image(int k) { return images[static_cast<std::size_t>(k) % images.size()]; }
    vulkan::Buffer& curve(int k) { return curves[static_cast<std::size_t>(k) % curves.size()]; }

    template <class Push>
    void dispatch(const vulkan::Kernel& kernel, const std::vector<const vulkan::Buffer*>& buffers, const Push& push,
                  std::size_t invocations) {
        std::vector<vulkan::Binding> bindings;
        for (const vulkan::Buffer* buffer : buffers) {
            bindings.push_back({static_cast<std::uint32_t>(bindings.size()), buffer});
        }
        if (!commands) {
            commands.emplace(device);
        }
        const auto groups = static_cast<std::uint32_t>((invocations + workgroup - 1) / workgroup);
        const std::uint32_t group_rows = (groups + most_groups_in_a_row - 1) / most_groups_in_a_row;
        commands->dispatch(kernel, bindings, push, (groups + group_rows - 1) / group_rows, group_rows);
        commands->barrier();
    }

    // first_to: in values.
    template <class Plane>
    void weighted_mean(std::span<const FocusTerm> terms, const Plane& plane, const vulkan::Buffer& to,
                       std::size_t first_to, std::size_t count) {
        for (std::size_t k = 0; k < terms.size(); ++k) {
            dispatch(mean, {&plane(terms[k].image), &to},
                     Term{static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(first_to), terms[k].weight,
                          k == 0 ? 1u : 0u},
                     count);
        }
    }

    // What has been recorded since the last image, at once.
    void submit() {
        if (commands) {
            commands->submit_and_wait();
            commands.reset();
        }
    }

    FocusPlan plan;
    FocusDepths depths;
    std::size_t pixels;
    std::size_t channels;
    vulkan::Device device;
    vulkan::Kernel mean, noise, response, rows, columns, follow, select;
    vulkan::Buffer mean_image, responses, row_sums, weights, averaged, records, sharpest, brightness,
        squared_differences, all_in_focus;
    std::vector<vulkan::Buffer> images; // the last few in turn
    std::vector<vulkan::Buffer> curves; // likewise
    std::optional<vulkan::Commands> commands;
};

FocusKernels::FocusKernels(const std::string& selector, const FocusPlan& plan, std::span<const float> window_weights,
                           const FocusDepths& depths)
    : state_(std::make_unique<State>(selector, plan, window_weights, depths)) {}

FocusKernels::~FocusKernels() = default;

void FocusKernels::take(int image, std::span<const Grid<float>> channels) {
    State& s = *state_;
    s.submit();
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        s.image(image).write_values(std::span<const float>(channels[channel].values), channel * s.pixels);
    }
    const bool differences = image >= 2;
    s.dispatch(
        s.noise,
        {&s.image(image), &s.image(differences ? image - 1 : image), &s.image(differences ? image - 2 : image),
         &s.brightness, &s.squared_differences},
        NoiseSizes{static_cast<std::uint32_t>(s.pixels), static_cast<std::uint32_t>(s.channels), differences ? 1u : 0u},
        s.pixels);
}

void FocusKernels::measure(int image, std::span<const FocusTerm> terms) {
    State& s = *state_;
    const vulkan::Buffer* measured = &s.mean_image;
    if (terms.size() == 1) {
        measured = &s.image(terms[0].image);
    } else {
        s.weighted_mean(
            terms, [&](int k) -> const vulkan::Buffer& { return s.image(k); }, s.mean_image, 0, s.channels* s.pixels);
    }
    if (s.plan.measure != focus::f32::FOCUS_STANDARD_DEVIATION) {
        s.dispatch(s.response, {measured, &s.responses}, s.plan, s.pixels);
    }
    s.dispatch(s.rows, {measured, &s.responses, &s.weights, &s.row_sums}, s.plan, s.pixels);
    s.dispatch(s.columns, {&s.row_sums, &s.weights, &s.curve(image)}, s.plan, s.pixels);
}

void FocusKernels::average(int image, std::span<const FocusTerm> terms) {
    State& s = *state_;
    s.weighted_mean(
        terms, [&](int k) -> const vulkan::Buffer& { return s.curve(k); }, s.averaged,
        static_cast<std::size_t>(image % s.depths.averaged_curves) * s.pixels, s.pixels);
}

void FocusKernels::follow(int image, int images) {
    State& s = *state_;
    s.dispatch(s.follow, {&s.averaged, &s.records, &s.sharpest},
               CurveStep{s.plan, image, images, s.depths.averaged_curves}, s.pixels);
    const int first = std::max(0, image - s.plan.peak_range);
    const int last = std::min(images - 1, image + s.plan.peak_range);
    for (int k = first; k <= last; ++k) {
        s.dispatch(s.select, {&s.image(k), &s.sharpest, &s.all_in_focus},
                   Choice{static_cast<std::uint32_t>(s.pixels), static_cast<std::uint32_t>(s.channels), k}, s.pixels);
    }
}

FocusResult FocusKernels::result() {
    State& s = *state_;
    s.submit();
    const int columns = s.plan.columns, rows = s.plan.rows;
    const auto grid = [&](const auto& values) {
        Grid<typename std::decay_t<decltype(values)>::value_type> result(columns, rows);
        result.values = values;
        return result;
    };
    FocusResult result;
    result.brightness = grid(s.brightness.read_values<float>(s.pixels));
    result.squared_differences = grid(s.squared_differences.read_values<float>(s.pixels));
    result.curves = grid(s.records.read_values<CurveRecord>(s.pixels));
    for (std::size_t channel = 0; channel < s.channels; ++channel) {
        result.all_in_focus.push_back(grid(s.all_in_focus.read_values<float>(s.pixels, channel * s.pixels)));
    }
    return result;
}

bool is_hardware(const std::string& selector) {
    const auto reports = vulkan::list_devices();
    return reports[vulkan::choose_device(reports, {selector})].type != "CPU";
}

} // namespace vkfv::trace
