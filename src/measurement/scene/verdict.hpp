// A judgement in plain sentences: before a run of what can be measured, after it of what was measured.
#pragma once

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct Verdict {
    enum class Measurable { yes, partly, no, unknown }; // unknown: no specimen or no scan to judge
    Measurable measurable = Measurable::unknown;
    std::vector<std::string> sentences; // full sentences, the most important first
};

inline const std::array<const char*, 4>& names_of_measurable() {
    static const std::array<const char*, 4> names = {"yes", "partly", "no", "unknown"};
    return names;
}

inline const char* name_of(Verdict::Measurable measurable) {
    return names_of_measurable()[static_cast<std::size_t>(measurable)];
}

inline nlohmann::ordered_json json_of(const Verdict& verdict) {
    return {{"measurable", name_of(verdict.measurable)}, {"sentences", verdict.sentences}};
}

// The verdict that the JSON object holds. Throws nlohmann's exceptions where it holds none; an answer that is not known
// becomes `unknown`.
inline Verdict verdict_of_json(const nlohmann::ordered_json& json) {
    const std::string answer = json.at("measurable");
    const auto& names = names_of_measurable();
    const auto found = std::ranges::find(names, answer);
    return {.measurable = found == names.end() ? Verdict::Measurable::unknown
                                               : static_cast<Verdict::Measurable>(found - names.begin()),
            .sentences = json.at("sentences")};
}

} // namespace vkfv::measurement
