// A short fingerprint of data, to tell one input from another (not a defence against intent).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vkfv::app {

// FNV-1a, 64 bits (Fowler, Noll, Vo; http://www.isthe.com/chongo/tech/comp/fnv): the same on every machine.
class Digest {
  public:
    Digest& add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) {
            state_ = (state_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
        }
        return *this;
    }
    Digest& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }
    template <class Value>
    Digest& add_values(std::span<const Value> values) {
        return add(std::as_bytes(values));
    }
    std::string text() const; // 16 hexadecimal digits

  private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

} // namespace vkfv::app
