#include "core/files/digest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <array>
#include <new>
#include <stdexcept>

namespace vkfv {

namespace {

constexpr std::size_t short_digits = 16;
constexpr std::size_t sha256_bytes = 32;

void require(int success) {
    if (success != 1) {
        throw std::runtime_error("OpenSSL refuses SHA-256");
    }
}

} // namespace

void Digest::Free::operator()(evp_md_ctx_st* context) const {
    EVP_MD_CTX_free(context);
}

Digest::Digest() : context_(EVP_MD_CTX_new()) {
    if (!context_) {
        throw std::bad_alloc();
    }
    require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

Digest& Digest::add(std::span<const std::byte> bytes) {
    require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
    return *this;
}

std::string Digest::sha256() const {
    const std::unique_ptr<evp_md_ctx_st, Free> copy(EVP_MD_CTX_new());
    if (!copy) {
        throw std::bad_alloc();
    }
    std::array<unsigned char, sha256_bytes> sum{};
    require(EVP_MD_CTX_copy_ex(copy.get(), context_.get()));
    require(EVP_DigestFinal_ex(copy.get(), sum.data(), nullptr));
    return fmt::format("{:02x}", fmt::join(sum, ""));
}

std::string Digest::text() const {
    return sha256().substr(0, short_digits);
}

} // namespace vkfv
