// A judgement in plain sentences: of what can be measured, before, and of what was measured, after.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

struct Verdict {
    enum class Measurable { yes, partly, no };
    Measurable measurable = Measurable::yes;
    std::vector<std::string> sentences; // whole, the most important first
};

inline const char* name_of(Verdict::Measurable measurable) {
    return measurable == Verdict::Measurable::yes ? "yes" : measurable == Verdict::Measurable::partly ? "partly" : "no";
}

inline nlohmann::ordered_json json_of(const Verdict& verdict) {
    return {{"measurable", name_of(verdict.measurable)}, {"sentences", verdict.sentences}};
}

// Throws nlohmann's exceptions where it is none.
inline Verdict verdict_of_json(const nlohmann::ordered_json& json) {
    const std::string answer = json.at("measurable");
    Verdict verdict{.measurable = answer == "yes"      ? Verdict::Measurable::yes
                                  : answer == "partly" ? Verdict::Measurable::partly
                                                       : Verdict::Measurable::no,
                    .sentences = json.at("sentences")};
    return verdict;
}

} // namespace vkfv::measurement
