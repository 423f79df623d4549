// Warnings as JSON, in one form for all commands.
#pragma once

#include "core/messages/warning.hpp"

#include <nlohmann/json.hpp>

#include <vector>

namespace vkfv::measurement {

inline nlohmann::ordered_json json_of(const std::vector<Warning>& warnings) {
    auto json = nlohmann::ordered_json::array();
    for (const Warning& warning : warnings) {
        json.push_back({{"code", warning.code},
                        {"key", warning.key},
                        {"value", warning.value},
                        {"works", warning.works},
                        {"sentence", warning.sentence}});
    }
    return json;
}

// The warnings that the JSON holds. Throws nlohmann's exceptions where it is no list of warnings.
inline std::vector<Warning> warnings_of_json(const nlohmann::ordered_json& json) {
    std::vector<Warning> warnings;
    for (const auto& one : json) {
        warnings.push_back({.code = one.at("code"),
                            .key = one.at("key"),
                            .value = one.at("value"),
                            .works = one.at("works"),
                            .sentence = one.at("sentence")});
    }
    return warnings;
}

} // namespace vkfv::measurement
