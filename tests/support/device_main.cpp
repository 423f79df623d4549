// Runs the tests of rooms that open devices: all that run in one process share its devices and what they compiled.
#include "vulkan/device.hpp"

#include <gtest/gtest.h>

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    const vkfv::vulkan::DriverScope drivers;
    const vkfv::vulkan::DeviceScope devices;
    return RUN_ALL_TESTS();
}
