// A device for all tests of the program: opening one costs more than most tests.
#pragma once

#include "vulkan/device.hpp"

inline const vkfv::vulkan::Device& shared_device() {
    static const vkfv::vulkan::Device device;
    return device;
}
