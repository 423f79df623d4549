// Digests of data: short ones distinguish inputs, whole ones verify that a file is the one written.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace vkfv {

// SHA-256 (FIPS 180-4, by OpenSSL), equal on every machine.
class Digest {
  public:
    Digest();
    Digest& add(std::span<const std::byte> bytes);
    Digest& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }
    template <class Value>
    Digest& add_values(std::span<const Value> values) {
        return add(std::as_bytes(values));
    }
    std::string sha256() const; // 64 hexadecimal digits, of all bytes added so far
    std::string text() const;   // the first 16 digits

  private:
    struct Free {
        void operator()(evp_md_ctx_st* context) const;
    };
    std::unique_ptr<evp_md_ctx_st, Free> context_;
};

} // namespace vkfv
