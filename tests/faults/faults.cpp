#include "faults/faults.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

namespace vkfv::test {

std::string text_of(const Fault& fault) {
    return fmt::format("{} {}{} {} {}", fault.call, fault.number, fault.lasts ? " and on" : "", fault.effect,
                       fault.subject);
}

std::vector<Fault> counted_calls(const std::filesystem::path& log) {
    std::vector<Fault> calls;
    std::map<std::string, int> counts;
    std::ifstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        const auto space = line.find(' ');
        const std::string call = line.substr(0, space);
        calls.push_back(
            {.call = call, .number = ++counts[call], .effect = {}, .lasts = false, .subject = line.substr(space + 1)});
    }
    return calls;
}

bool every_fault() {
    return std::getenv("VKFV_EVERY_FAULT") != nullptr;
}

void add(Environment& environment, const Fault& fault) {
    environment["VKFV_FAULT_CALL"] = fault.call;
    environment["VKFV_FAULT_NUMBER"] = std::to_string(fault.number);
    environment["VKFV_FAULT_LASTS"] = fault.lasts ? "1" : "";
    environment["VKFV_FAULT_EFFECT"] = fault.effect;
}

Files files_below(const std::filesystem::path& folder) {
    Files files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const auto name = entry.path().filename();
        if (entry.is_regular_file() && name != "timings.csv" && name != "timings.js" &&
            !name.string().starts_with(".lock")) {
            files[entry.path().lexically_relative(folder).generic_string()] = read_file(entry.path());
        }
    }
    return files;
}

std::vector<std::string> differing(const Files& some, const Files& others) {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : some) {
        const auto other = others.find(name);
        if (other == others.end() || other->second != bytes) {
            names.push_back(name);
        }
    }
    for (const auto& [name, bytes] : others) {
        if (!some.contains(name)) {
            names.push_back(name);
        }
    }
    return names;
}

} // namespace vkfv::test
