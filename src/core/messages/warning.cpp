#include "core/messages/warning.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

namespace vkfv {

std::vector<std::string> sentences_of(const std::vector<Warning>& warnings) {
    std::vector<std::string> sentences;
    sentences.reserve(warnings.size());
    for (const Warning& warning : warnings) {
        sentences.push_back(warning.sentence);
    }
    return sentences;
}

std::string remedy_text(const Warning& warning) {
    if (warning.key.empty()) {
        return "";
    }
    const std::string now = warning.value.empty() ? warning.key : fmt::format("{} = {}", warning.key, warning.value);
    return warning.works.empty() ? fmt::format("[{}]", now) : fmt::format("[{}; works: {}]", now, warning.works);
}

namespace {

std::mutex guard;             // guards `once`, since several threads warn
WarningsOnce* once = nullptr; // the object that was made last; null: every warning is logged

} // namespace

WarningsOnce::WarningsOnce() {
    const std::lock_guard lock(guard);
    before_ = std::exchange(once, this);
}

WarningsOnce::~WarningsOnce() {
    const std::lock_guard lock(guard);
    once = before_;
}

void log_warnings(const std::vector<Warning>& warnings) {
    const std::lock_guard lock(guard);
    for (const Warning& warning : warnings) {
        const bool again = once != nullptr && !once->codes_.insert(warning.code).second;
        spdlog::log(again ? spdlog::level::debug : spdlog::level::warn, "{}", warning.sentence);
    }
}

void append(std::vector<Warning>& warnings, const std::vector<Warning>& further) {
    for (const Warning& warning : further) {
        if (std::ranges::find(warnings, warning) == warnings.end()) {
            warnings.push_back(warning);
        }
    }
}

std::string number_text(double value, Rounding rounding) {
    constexpr int digits = 4;
    // Powers of ten that a double holds exactly enough: numbers beyond them are no key's value, and are not rounded.
    constexpr double least = 1e-300;
    constexpr double most = 1e300;
    if (!(std::abs(value) >= least && std::abs(value) <= most)) {
        return fmt::format("{:g}", value);
    }
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1 - digits);
    const double parts = value / unit;
    // A number that has few enough digits already stays, although its binary form lies a little beside it.
    constexpr double exact = 1e-9;
    const double whole = std::round(parts);
    const double rounded = rounding == Rounding::nearest || std::abs(parts - whole) < exact * std::abs(parts) ? whole
                           : rounding == Rounding::up ? std::ceil(parts)
                                                      : std::floor(parts);
    return fmt::format("{:.{}g}", rounded * unit, digits);
}

} // namespace vkfv
