#include "vulkan/kernel.hpp"

#include "core/messages/error.hpp"
#include "shared_device.hpp"
#include "spirv/probe_vulkan_arithmetic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <numeric>
#include <vector>

namespace vkfv::vulkan {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

// The record has the layout of probe_vulkan_arithmetic.comp.
struct Push {
    std::uint64_t base;
    vk::DeviceAddress values;
    std::uint32_t count;
    std::uint32_t tail; // C++ rounds the size to 8
};
struct Sums {
    std::uint64_t of_values;
    std::uint32_t of_invocations;
    std::uint32_t of_indices;
    std::uint32_t length_of_padded;
    std::uint32_t tail;
};

constexpr std::uint32_t workgroup = 64;

Kernel arithmetic_kernel(std::span<const std::uint32_t> spirv, std::span<const SpecializationConstant> constants) {
    return Kernel(
        shared_device(), "probe_vulkan_arithmetic", spirv,
        {{5, BindingKind::storage_buffer}, {0, BindingKind::uniform_buffer}, {2, BindingKind::storage_buffer}},
        sizeof(Push), constants);
}

Kernel arithmetic_kernel(std::uint32_t factor) {
    const SpecializationConstant constant{3, factor};
    return arithmetic_kernel(probe_vulkan_arithmetic, std::span(&constant, 1));
}

struct Arithmetic {
    Buffer offset{shared_device(), sizeof(std::uint64_t), Buffer::Memory::host};
    Buffer sums{shared_device(), sizeof(Sums)};
    Buffer padded{shared_device(), 7 * 3 * sizeof(float)};
    std::vector<Binding> bindings = {{0, &offset}, {2, &sums}, {5, &padded}};
};

std::vector<std::byte> pattern(std::size_t bytes) {
    std::vector<std::byte> data(bytes);
    std::uint32_t state = 1;
    for (std::byte& byte : data) {
        state = state * 1664525U + 1013904223U;
        byte = static_cast<std::byte>(state >> 24U);
    }
    return data;
}

// Kernels of the same code, bindings and constants share a pipeline; the wrong twins differ in one of them.
TEST(Kernels, AreCompiledOnceOnADevice) {
    const auto first = arithmetic_kernel(3);
    EXPECT_EQ(first.pipeline(), arithmetic_kernel(3).pipeline());
    EXPECT_NE(first.pipeline(), arithmetic_kernel(5).pipeline());
    const SpecializationConstant constant{3, 3};
    const Kernel with_more(shared_device(), "probe_vulkan_arithmetic", probe_vulkan_arithmetic,
                           {{5, BindingKind::storage_buffer},
                            {0, BindingKind::uniform_buffer},
                            {2, BindingKind::storage_buffer},
                            {6, BindingKind::storage_buffer}},
                           sizeof(Push), std::span(&constant, 1));
    EXPECT_NE(first.pipeline(), with_more.pipeline());
    // Several threads compile at once.
    std::vector<std::future<vk::Pipeline>> threads;
    for (int k = 0; k < 8; ++k) {
        threads.push_back(std::async(std::launch::async, [] { return arithmetic_kernel(7).pipeline(); }));
    }
    const auto seventh = arithmetic_kernel(7).pipeline();
    for (auto& thread : threads) {
        EXPECT_EQ(thread.get(), seventh);
    }
}

TEST(Buffers, ReturnWhatWasWritten) {
    for (const Buffer::Memory memory : {Buffer::Memory::device, Buffer::Memory::host}) {
        Buffer buffer(shared_device(), 1001, memory);
        EXPECT_EQ(buffer.bytes(), 1001U);
        EXPECT_NE(buffer.address(), 0U);
        const std::vector<std::byte> data = pattern(1001);
        buffer.write(data);
        EXPECT_EQ(buffer.read_values<std::byte>(1001), data);
        // A part written in the middle leaves the rest alone.
        const std::vector<std::byte> part(13, std::byte{0xAB});
        buffer.write(part, 501);
        std::vector<std::byte> expected = data;
        std::ranges::copy(part, expected.begin() + 501);
        EXPECT_EQ(buffer.read_values<std::byte>(1001), expected);
        buffer.fill_zero();
        EXPECT_THAT(buffer.read_values<std::byte>(1001), Each(std::byte{0}));
    }
}

TEST(Buffers, LargerThanAStagingCopyGoThroughInPieces) {
    const std::size_t bytes = (std::size_t{64} << 20) + 4099;
    Buffer buffer(shared_device(), bytes + 3);
    const std::vector<std::byte> data = pattern(bytes);
    buffer.write(data, 3);
    EXPECT_TRUE(buffer.read_values<std::byte>(bytes, 3) == data);
}

TEST(Buffers, MayBeEmpty) {
    Buffer buffer(shared_device(), 0);
    buffer.write({});
    EXPECT_TRUE(buffer.read_values<float>(0).empty());
}

TEST(Buffers, RefuseWhatLiesOutside) {
    for (const Buffer::Memory memory : {Buffer::Memory::device, Buffer::Memory::host}) {
        Buffer buffer(shared_device(), 16, memory);
        const std::vector<std::byte> data(17);
        EXPECT_THROW(buffer.write(data), std::logic_error);
        EXPECT_THROW(buffer.write(std::span(data).first(1), 16), std::logic_error);
        EXPECT_THROW(buffer.read_values<std::uint32_t>(2, 3), std::logic_error);
        EXPECT_NO_THROW(buffer.read_values<std::uint32_t>(1, 3));
    }
}

TEST(Buffers, LargerThanTheDeviceAreRefusedWithSizes) {
    const std::size_t bytes = std::size_t{1} << 50U;
    try {
        const Buffer buffer(shared_device(), bytes);
        FAIL() << "a buffer of 2^50 bytes";
    } catch (const RunError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr(std::to_string(bytes)), HasSubstr("trace.batch")));
    }
    EXPECT_THROW(Buffer(shared_device(), std::numeric_limits<std::size_t>::max()), RunError);
}

constexpr std::uint32_t large_factor = 3'000'000'019U; // the products need 64 bits

// Expects the products of a kernel with the factor above.
void expect_products(const Kernel& kernel) {
    constexpr std::uint32_t count = 1000; // not a multiple of the workgroup
    constexpr std::uint64_t base = std::uint64_t{1} << 40U;
    constexpr std::uint64_t offset = 77;
    constexpr std::uint32_t factor = large_factor;
    Arithmetic memory;
    memory.offset.write_values(std::span(&offset, 1));
    const Buffer values(shared_device(), count * sizeof(std::uint64_t));
    const Push push{base, values.address(), count, 0};

    Commands commands(shared_device());
    commands.fill_zero(memory.sums);
    commands.barrier();
    commands.dispatch(kernel, memory.bindings, push, (count + workgroup - 1) / workgroup);
    commands.submit_and_wait();

    const std::vector<std::uint64_t> result = values.read_values<std::uint64_t>(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(result[i], offset + base + std::uint64_t{factor} * i) << i;
    }
    const Sums sums = memory.sums.read_values<Sums>(1).front();
    constexpr std::uint64_t sum_of_indices = std::uint64_t{count} * (count - 1) / 2;
    EXPECT_EQ(sums.of_values, count * (offset + base) + factor * sum_of_indices);
    EXPECT_EQ(sums.of_invocations, count);
    EXPECT_EQ(sums.of_indices, sum_of_indices);
    EXPECT_EQ(sums.length_of_padded, 7U); // the allocation's padding does not show
}

TEST(Kernels, ComputeWithEveryFeatureTheTraceNeeds) {
    expect_products(arithmetic_kernel(large_factor));
}

TEST(Kernels, ComputeTheSameWithTheirConstantsPutInBefore) {
    const SpecializationConstant constant{3, large_factor};
    const std::vector<std::uint32_t> spirv = specialised_spirv(probe_vulkan_arithmetic, std::span(&constant, 1));
    EXPECT_FALSE(spirv.empty());
    expect_products(arithmetic_kernel(spirv, {}));
}

TEST(Kernels, StayAsTheyAreIfTheyCannotBeRead) {
    const std::vector<std::uint32_t> spirv(100, 7);
    EXPECT_TRUE(specialised_spirv(spirv, {}).empty());
}

TEST(Kernels, RefuseBindingsAndConstantsTheyDoNotDeclare) {
    const Kernel kernel = arithmetic_kernel(1);
    Arithmetic memory;
    const Push push{};
    Commands commands(shared_device());
    const std::vector<Binding>& good = memory.bindings;
    EXPECT_NO_THROW(commands.dispatch(kernel, good, push, 1));
    EXPECT_THROW(commands.dispatch(kernel, std::span(good).first(2), push, 1), std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, std::vector<Binding>{good[0], good[1], {6, &memory.padded}}, push, 1),
                 std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, std::vector<Binding>{good[0], good[1], good[1]}, push, 1), std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, good, std::uint32_t{0}, 1), std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, good, push, 1, std::numeric_limits<std::uint32_t>::max()), std::logic_error);
    EXPECT_THROW(Kernel(shared_device(), "pushy", probe_vulkan_arithmetic, {}, 132), std::logic_error);
}

TEST(Kernels, AreBoundToAPartOfABuffer) {
    const Kernel kernel = arithmetic_kernel(large_factor);
    Arithmetic memory;
    const std::uint64_t offset = 77;
    memory.offset.write_values(std::span(&offset, 1));
    constexpr std::size_t part = binding_alignment;
    const Buffer three(shared_device(), 3 * part);
    const Buffer values(shared_device(), sizeof(std::uint64_t));
    const auto bound_to = [&](std::size_t first, std::size_t bytes) {
        std::vector<Binding> bindings = memory.bindings;
        for (Binding& binding : bindings) {
            if (binding.slot == 2) {
                binding = {.slot = 2, .resource = &three, .first_byte = first, .bytes = bytes};
            }
        }
        return bindings;
    };
    Commands commands(shared_device());
    commands.fill_zero(three);
    commands.barrier();
    const Push push{0, values.address(), 1, 0};
    commands.dispatch(kernel, bound_to(part, part), push, 1);
    EXPECT_THROW(commands.dispatch(kernel, bound_to(part, 2 * part + 1), push, 1), std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, bound_to(4 * part, part), push, 1), std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, bound_to(part / 2, part), push, 1), std::logic_error);
    EXPECT_THROW(commands.dispatch(kernel, bound_to(part, 0), push, 1), std::logic_error);
    commands.submit_and_wait();
    const auto words = three.read_values<std::uint64_t>(3 * part / sizeof(std::uint64_t));
    const auto of_part = static_cast<std::ptrdiff_t>(part / sizeof(std::uint64_t));
    EXPECT_EQ(words[part / sizeof(std::uint64_t)], offset); // its sum of values
    EXPECT_THAT(std::vector(words.begin(), words.begin() + of_part), Each(0u));
    EXPECT_THAT(std::vector(words.begin() + 2 * of_part, words.end()), Each(0u));
}

TEST(Kernels, RefuseABufferLargerThanADescriptorSpans) {
    const Kernel kernel = arithmetic_kernel(1);
    Arithmetic memory;
    const Buffer large(shared_device(), shared_device().physical().getProperties().limits.maxUniformBufferRange + 64U);
    memory.bindings[0].resource = &large;
    Commands commands(shared_device());
    EXPECT_THROW(commands.dispatch(kernel, memory.bindings, Push{}, 1), DeviceError);
}

TEST(Commands, CopyBetweenBuffersWithinTheirBounds) {
    Buffer from(shared_device(), 100, Buffer::Memory::host);
    const Buffer to(shared_device(), 50, Buffer::Memory::host);
    const std::vector<std::byte> data = pattern(100);
    from.write(data);
    Commands commands(shared_device());
    commands.copy(from, to, 30, 70, 20);
    EXPECT_THROW(commands.copy(from, to, 31, 70, 0), std::logic_error);
    EXPECT_THROW(commands.copy(from, to, 31, 0, 20), std::logic_error);
    commands.submit_and_wait();
    EXPECT_THROW(commands.submit_and_wait(), std::logic_error);
    EXPECT_EQ(to.read_values<std::byte>(30, 20), std::vector<std::byte>(data.begin() + 70, data.end()));
}

TEST(Commands, TimestampsRiseAndStayWithinTheWallClock) {
    const Kernel kernel = arithmetic_kernel(1);
    Arithmetic memory;
    constexpr std::uint32_t count = 1U << 20U;
    const Buffer values(shared_device(), count * sizeof(std::uint64_t));
    const Push push{0, values.address(), count, 0};
    Commands commands(shared_device(), 3);
    for (int i = 0; i < 2; ++i) {
        commands.timestamp();
        commands.dispatch(kernel, memory.bindings, push, count / workgroup);
        commands.barrier();
    }
    commands.timestamp();
    EXPECT_THROW(commands.timestamp(), std::logic_error);
    EXPECT_THROW(static_cast<void>(commands.seconds()), std::logic_error);
    const auto start = std::chrono::steady_clock::now();
    commands.submit_and_wait();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    const std::vector<double> seconds = commands.seconds();
    ASSERT_EQ(seconds.size(), 3U);
    EXPECT_EQ(seconds[0], 0.0);
    EXPECT_GT(seconds[1], 0.0);
    EXPECT_GT(seconds[2], seconds[1]);
    EXPECT_LE(seconds[2], wall.count());
}

} // namespace
} // namespace vkfv::vulkan
