// Fourier transforms of planes of complex floats in a device's memory, by VkFFT.
#pragma once

#include "vulkan/kernel.hpp"

#include <memory>
#include <string>

namespace vkfv::vulkan {

// Of `planes` planes of columns x rows numbers (real, imaginary), one after the other at the buffer's beginning, in
// place and without a factor: forward with exp(-2 pi i ...), or its inverse. Any size; quick for products of primes up
// to 13. Its kernels are made when it is constructed, and kept on disk as pipelines are. Throws RunError where the
// library fails. Device and buffer must outlive it.
class FourierPlanes {
  public:
    enum class Direction { forward, inverse };
    FourierPlanes(const Device& device, const Buffer& buffer, int columns, int rows, int planes, Direction direction);
    ~FourierPlanes();
    FourierPlanes(FourierPlanes&&) noexcept;
    FourierPlanes& operator=(FourierPlanes&&) noexcept;

    void record(Commands& commands) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// "VkFFT 1.2.26": the bits of a transform are its.
std::string fourier_library();

} // namespace vkfv::vulkan
