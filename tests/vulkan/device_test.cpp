#include "vulkan/device.hpp"

#include "core/messages/error.hpp"
#include "shared_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace vkfv::vulkan {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

DeviceReport report(int index, const std::string& name, const std::string& type, std::uint64_t memory,
                    std::vector<std::string> lacking = {}) {
    DeviceReport report;
    report.index = index;
    report.name = name;
    report.type = type;
    report.api_version = "1.3.0";
    report.memory_bytes = memory;
    report.lacking = std::move(lacking);
    return report;
}

std::string message_of(const std::vector<DeviceReport>& reports, const std::string& selector) {
    try {
        choose_device(reports, {selector});
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "";
}

TEST(Devices, ListsAtLeastOneUsableAndPrefersExactlyOne) {
    const std::vector<DeviceReport> reports = list_devices();
    int preferred = 0;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        EXPECT_EQ(reports[i].index, static_cast<int>(i));
        EXPECT_THAT(reports[i].name, Not(IsEmpty()));
        EXPECT_THAT(reports[i].api_version, HasSubstr("."));
        if (reports[i].preferred) {
            ++preferred;
            EXPECT_THAT(reports[i].lacking, IsEmpty());
            EXPECT_GE(reports[i].subgroup_size, 1U);
            EXPECT_GT(reports[i].memory_bytes, 0U);
            EXPECT_GE(reports[i].max_storage_buffer_bytes, 1U << 27U); // the least that Vulkan allows
            EXPECT_THAT(reports[i].driver, Not(IsEmpty()));
        }
    }
    EXPECT_EQ(preferred, 1);
}

TEST(Devices, SelectsByIndexAndByPartOfTheName) {
    const Device& best = shared_device();
    EXPECT_TRUE(best.report().preferred);
    EXPECT_THAT(best.choice(), AllOf(HasSubstr(best.report().name), HasSubstr("usable device")));
    const Device by_index({std::to_string(best.report().index)});
    EXPECT_EQ(by_index.report().name, best.report().name);
    EXPECT_THAT(by_index.choice(), HasSubstr("selected by"));
    const Device by_name({best.report().name.substr(0, 4)});
    EXPECT_GT(by_name.seconds_between(1, 1001), 0.0);
    EXPECT_EQ(by_name.seconds_between(1001, 1), -by_name.seconds_between(1, 1001));
}

TEST(Devices, AnUnknownSelectorIsRefusedWithAllThereAre) {
    try {
        const Device device({"no such device"});
        FAIL() << "opened " << device.report().name;
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("no such device"), HasSubstr(shared_device().report().name)));
    }
}

TEST(Devices, DiscreteBeforeIntegratedBeforeVirtualBeforeCpuThenMemory) {
    std::vector<DeviceReport> reports = {report(0, "lavapipe", "CPU", 1000), report(1, "virtio", "virtual GPU", 50),
                                         report(2, "iris", "integrated GPU", 100),
                                         report(3, "radeon small", "discrete GPU", 8),
                                         report(4, "radeon large", "discrete GPU", 16)};
    for (const std::size_t expected : {4U, 3U, 2U, 1U, 0U}) {
        EXPECT_EQ(choose_device(reports, {}), expected);
        reports[expected].lacking = {"something"};
    }
    EXPECT_THROW(choose_device(reports, {}), DeviceError);
}

TEST(Devices, ASelectorIsAnIndexOrElsePartOfAName) {
    const std::vector<DeviceReport> reports = {report(0, "llvmpipe", "CPU", 1),
                                               report(1, "GeForce RTX 4090", "discrete GPU", 24),
                                               report(2, "GeForce RTX 3060", "discrete GPU", 12)};
    EXPECT_EQ(choose_device(reports, {"0"}), 0U);
    EXPECT_EQ(choose_device(reports, {"2"}), 2U);
    EXPECT_EQ(choose_device(reports, {"4090"}), 1U);
    EXPECT_EQ(choose_device(reports, {"3060"}), 2U);
    EXPECT_EQ(choose_device(reports, {"geforce"}), 1U);
    EXPECT_EQ(choose_device(reports, {"LLVM"}), 0U);
    EXPECT_THROW(choose_device(reports, {"-1"}), DeviceError);
}

TEST(Devices, SeveralByAListOrAll) {
    const std::vector<DeviceReport> reports = {
        report(0, "llvmpipe (LLVM 15, 256 bits)", "CPU", 1), report(1, "H200", "discrete GPU", 140),
        report(2, "H200", "discrete GPU", 140), report(3, "H200", "discrete GPU", 140, {"something"}),
        report(4, "A2", "discrete GPU", 16)};
    EXPECT_THAT(choose_devices(reports, "all"), ElementsAre(1, 2));
    EXPECT_THAT(choose_devices(reports, "2,1"), ElementsAre(2, 1));
    EXPECT_THAT(choose_devices(reports, "0, 0"), ElementsAre(0, 0));      // a device twice
    EXPECT_THAT(choose_devices(reports, "LLVM 15, 256"), ElementsAre(0)); // a comma of the name's own
    EXPECT_THAT(choose_devices(reports, ""), ElementsAre(1));
    EXPECT_EQ(choose_device(reports, {"2,1"}), 2U);
    EXPECT_THROW(choose_devices(reports, "0,1"), DeviceError); // devices of different models
    EXPECT_THROW(choose_devices(reports, "1,3"), DeviceError); // unusable
    EXPECT_THROW(choose_devices(reports, "1,"), DeviceError);
    EXPECT_THROW(choose_devices(reports, "1,,2"), DeviceError);
    EXPECT_THROW(choose_devices(reports, "1,host"), DeviceError);
}

TEST(Devices, AnErrorSaysWhatEachDeviceLacksAndTheRemedy) {
    const std::vector<DeviceReport> reports = {
        report(0, "Old Card", "discrete GPU", 1, {"Vulkan 1.2 (it offers 1.1.0)"}),
        report(1, "Phone", "integrated GPU", 1, {"64-bit integers in shaders (shaderInt64)", "subgroup ballot"})};
    EXPECT_THAT(message_of(reports, ""),
                AllOf(HasSubstr("[0] Old Card"), HasSubstr("lacks Vulkan 1.2"), HasSubstr("[1] Phone"),
                      HasSubstr("shaderInt64"), HasSubstr("subgroup ballot"), HasSubstr("mesa-vulkan-drivers")));
    EXPECT_THAT(message_of(reports, "phone"), AllOf(HasSubstr("\"phone\" is not usable"), HasSubstr("shaderInt64")));
    EXPECT_THAT(message_of(reports, "radeon"), HasSubstr("No Vulkan device matches \"radeon\""));
}

// The loader reads its environment once a process, so each of these tests runs in its own.
class DeviceDeathTest : public ::testing::Test {
  protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

[[noreturn]] void report_missing_driver(const char* variable, const char* value) {
    ::unsetenv("VK_DRIVER_FILES");
    ::unsetenv("VK_ICD_FILENAMES");
    ::setenv(variable, value, 1);
    try {
        list_devices();
    } catch (const DeviceError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        std::_Exit(3);
    }
    std::_Exit(0);
}

TEST_F(DeviceDeathTest, DriverFilesThatPointNowhereAreNamedWithTheRemedy) {
    EXPECT_EXIT(report_missing_driver("VK_DRIVER_FILES", "/nonexistent/driver.json"), ::testing::ExitedWithCode(3),
                "No Vulkan driver can be used.*VK_DRIVER_FILES=/nonexistent/driver.json.*mesa-vulkan-drivers");
}

TEST_F(DeviceDeathTest, ADriverSelectionThatMatchesNothingIsNamedWithTheRemedy) {
    EXPECT_EXIT(report_missing_driver("VK_LOADER_DRIVERS_SELECT", "*no_such_driver*"), ::testing::ExitedWithCode(3),
                "VK_LOADER_DRIVERS_SELECT=.no_such_driver.*mesa-vulkan-drivers");
}

#ifdef VKFV_VALIDATION
TEST_F(DeviceDeathTest, AValidationMessageIsFatal) {
    EXPECT_DEATH(
        {
            const Device device;
            const vk::raii::Buffer empty(device.handle(),
                                         vk::BufferCreateInfo({}, 0, vk::BufferUsageFlagBits::eStorageBuffer));
        },
        "Vulkan validation: .*VUID-VkBufferCreateInfo-size");
}

// Two copies go into one place without a barrier: only synchronisation validation sees it.
TEST_F(DeviceDeathTest, AMissingBarrierIsFatal) {
    EXPECT_DEATH(
        {
            const Device device;
            const vk::raii::Buffer buffer(device.handle(),
                                          vk::BufferCreateInfo({}, 64, vk::BufferUsageFlagBits::eTransferDst));
            const vk::MemoryRequirements needed = buffer.getMemoryRequirements();
            const vk::raii::DeviceMemory memory(
                device.handle(), vk::MemoryAllocateInfo(needed.size, device.memory_type(needed.memoryTypeBits, {})));
            buffer.bindMemory(*memory, 0);
            const vk::raii::CommandPool pool(device.handle(), vk::CommandPoolCreateInfo({}, device.queue_family()));
            const vk::raii::CommandBuffers commands(
                device.handle(), vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1));
            commands.front().begin(vk::CommandBufferBeginInfo());
            commands.front().fillBuffer(*buffer, 0, VK_WHOLE_SIZE, 1);
            commands.front().fillBuffer(*buffer, 0, VK_WHOLE_SIZE, 2);
        },
        "SYNC-HAZARD-WRITE");
}
#endif

} // namespace
} // namespace vkfv::vulkan
