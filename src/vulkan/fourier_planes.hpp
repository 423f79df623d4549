// Fourier transforms of planes of complex floats in a device's memory, by VkFFT.
#pragma once

#include "vulkan/kernel.hpp"

#include <memory>
#include <string>

namespace vkfv::vulkan {

// The transform of `planes` planes of columns x rows numbers (real, imaginary), one after the other at the buffer's
// beginning, in place and without a factor: forward with exp(-2 pi i ...), or its inverse. Any size; fast for products
// of primes up to 13. Its kernels are made on construction, and saved to disk as pipelines are. Throws RunError where
// the library fails. Device and buffer must outlive it.
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

// The library's name, "VkFFT 1.2.26", on which the bits of a transform depend.
std::string fourier_library();

} // namespace vkfv::vulkan
