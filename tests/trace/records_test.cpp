// The records as the shaders see them against the records as the host writes them, field by field.
#include "trace/device_records.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/probe_records.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

using namespace vkfv;

namespace {

// A record filled with 1, 2, 3, ... in every 4-byte field, as floats where `is_integer` says no. Returns the numbers.
template <class Record>
std::vector<float> fill(Record& record, const std::vector<std::size_t>& integers, float first) {
    constexpr std::size_t count = sizeof(Record) / 4;
    std::vector<float> numbers;
    auto* bytes = reinterpret_cast<std::byte*>(&record);
    for (std::size_t k = 0; k < count; ++k) {
        const float number = first + static_cast<float>(k);
        const auto integer = static_cast<std::uint32_t>(number);
        if (std::ranges::find(integers, k) != integers.end()) {
            std::memcpy(bytes + 4 * k, &integer, 4);
        } else {
            std::memcpy(bytes + 4 * k, &number, 4);
        }
        numbers.push_back(number);
    }
    return numbers;
}

} // namespace

TEST(Records, the_device_sees_every_field_where_the_host_wrote_it) {
    const vulkan::Device device;
    std::array<physics::f32::Surface, physics::f32::SURFACE_CAPACITY> surfaces{};
    std::array<physics::f32::SpectralBin, physics::f32::SPECTRUM_CAPACITY> bins{};
    std::array<physics::f32::Survivor, 3> survivors{};
    trace::Parameters parameters{};
    std::vector<float> expected;
    const auto append = [&](const std::vector<float>& numbers) {
        expected.insert(expected.end(), numbers.begin(), numbers.end());
    };
    append(fill(surfaces[2], {41}, 100));
    append(fill(parameters.instrument, {24, 25, 26, 27, 28, 29, 30, 31}, 200));
    append(fill(parameters.specimen, {13, 32, 51, 70, 89, 90, 91, 92, 93}, 300));
    append(fill(parameters.exposure, {1, 2}, 400));
    append(fill(bins[2], {}, 450));
    append(fill(survivors[2], {7}, 500));

    vulkan::Buffer surface_buffer(device, sizeof(surfaces));
    vulkan::Buffer parameter_buffer(device, sizeof(parameters), vulkan::Buffer::Memory::host);
    vulkan::Buffer spectrum_buffer(device, sizeof(bins));
    vulkan::Buffer survivor_buffer(device, sizeof(survivors));
    vulkan::Buffer echo(device, expected.size() * sizeof(float));
    surface_buffer.write_values(std::span<const physics::f32::Surface>(surfaces));
    parameter_buffer.write_values(std::span<const trace::Parameters>(&parameters, 1));
    spectrum_buffer.write_values(std::span<const physics::f32::SpectralBin>(bins));
    survivor_buffer.write_values(std::span<const physics::f32::Survivor>(survivors));
    using enum vulkan::BindingKind;
    const vulkan::Kernel kernel(
        device, "probe_records", ::probe_records,
        {{0, uniform_buffer}, {1, uniform_buffer}, {2, storage_buffer}, {3, storage_buffer}, {14, uniform_buffer}});
    const std::array<vulkan::Binding, 5> bindings = {
        {{0, &surface_buffer}, {1, &parameter_buffer}, {2, &survivor_buffer}, {3, &echo}, {14, &spectrum_buffer}}};
    vulkan::Commands commands(device);
    commands.dispatch(kernel, bindings, std::span<const std::byte>{}, 1);
    commands.barrier();
    commands.submit_and_wait();
    EXPECT_EQ(echo.read_values<float>(expected.size()), expected);
}
