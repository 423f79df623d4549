#include "specimen/gltf_uri.hpp"

#include <charconv>
#include <cstdint>

namespace vkfv::specimen::gltf {
namespace {

constexpr std::string_view data_scheme = "data:", base64_mark = ";base64,";

// 0 to 63; more for what is no digit.
std::uint32_t base64_value(char digit) {
    if (digit >= 'A' && digit <= 'Z') {
        return static_cast<std::uint32_t>(digit - 'A');
    }
    if (digit >= 'a' && digit <= 'z') {
        return static_cast<std::uint32_t>(digit - 'a' + 26);
    }
    if (digit >= '0' && digit <= '9') {
        return static_cast<std::uint32_t>(digit - '0' + 52);
    }
    return digit == '+' || digit == '-' ? 62u : digit == '/' || digit == '_' ? 63u : 64u;
}

} // namespace

bool is_data_uri(std::string_view uri) {
    return uri.starts_with(data_scheme);
}

std::optional<std::string> decoded_data_uri(std::string_view uri) {
    const auto mark = uri.find(base64_mark);
    if (!is_data_uri(uri) || mark == std::string_view::npos || mark > uri.find(',')) {
        return std::nullopt;
    }
    std::string_view digits = uri.substr(mark + base64_mark.size());
    for (int padding = 0; padding < 2 && digits.ends_with('='); ++padding) {
        digits.remove_suffix(1);
    }
    std::string bytes;
    bytes.reserve(digits.size() / 4 * 3 + 2);
    std::uint32_t group = 0;
    int bits = 0;
    for (const char digit : digits) {
        const std::uint32_t value = base64_value(digit);
        if (value > 63) {
            return std::nullopt;
        }
        group = group << 6 | value;
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(static_cast<char>(group >> bits & 0xff));
        }
    }
    // A single digit over makes no byte.
    return bits < 6 ? std::optional(std::move(bytes)) : std::nullopt;
}

std::optional<std::filesystem::path> relative_path_of(std::string_view uri) {
    const auto colon = uri.find(':');
    if (uri.empty() || uri.starts_with('/') || uri.starts_with('\\') ||
        (colon != std::string_view::npos && colon < uri.find('/'))) {
        return std::nullopt;
    }
    std::string path;
    for (std::size_t at = 0; at < uri.size(); ++at) {
        unsigned int code = 0;
        const char* digits = uri.data() + at + 1;
        if (uri[at] == '%' && at + 2 < uri.size() && std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            path.push_back(static_cast<char>(code));
            at += 2;
        } else {
            path.push_back(uri[at]);
        }
    }
    return path.find('\0') == std::string::npos && !path.starts_with('/') ? std::optional(std::filesystem::path(path))
                                                                         : std::nullopt;
}

} // namespace vkfv::specimen::gltf
