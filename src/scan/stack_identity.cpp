#include "scan/stack_identity.hpp"

#include "core/files/file.hpp"
#include "core/messages/error.hpp"
#include "scan/store.hpp"

#include <fmt/format.h>

#include <map>
#include <sstream>
#include <vector>

namespace vkfv::scan {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view identity_prefix = "#: ";
constexpr std::string_view digest_label = " (digest ";
constexpr std::size_t digest_digits = 16;

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    std::istringstream stream{std::string(text)};
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

// The name of the table of a header line in messages. arrays: number of tables of each array so far. "[[source]]"
// becomes "source[1]" if it is the second, and "[source.spectrum]" below it "source[1].spectrum".
std::string table_of(const std::string& header, std::map<std::string, int>& arrays) {
    const bool one_of_several = header.starts_with("[[");
    const std::size_t brackets = one_of_several ? 2 : 1;
    const std::string name = header.substr(brackets, header.find(']') - brackets);
    if (one_of_several) {
        return fmt::format("{}[{}]", name, arrays[name]++);
    }
    for (auto end = name.rfind('.'); end != std::string::npos && end > 0; end = name.rfind('.', end - 1)) {
        if (const auto array = arrays.find(name.substr(0, end)); array != arrays.end()) {
            return fmt::format("{}[{}]{}", array->first, array->second - 1, name.substr(end));
        }
    }
    return name;
}

// Values by full keys: "[trace]" and "seed = 1" become "trace.seed" -> "1".
std::map<std::string, std::string> values_by_key(std::string_view identity) {
    std::map<std::string, std::string> values;
    std::map<std::string, int> arrays;
    std::string table;
    for (const std::string& line : lines_of(identity)) {
        const auto equals = line.find(" = ");
        if (line.starts_with('[')) {
            table = table_of(line, arrays) + ".";
        } else if (equals != std::string::npos) {
            values[table + line.substr(0, equals)] = line.substr(equals + 3);
        }
    }
    return values;
}

} // namespace

// The comments leave out the empty lines that an identity has before headers (Section, image_identity()).
std::string identity_in(std::string_view stack_text) {
    std::string identity;
    for (const std::string& line : lines_of(stack_text)) {
        if (line.starts_with(identity_prefix)) {
            const std::string own = line.substr(identity_prefix.size());
            identity += (own.starts_with('[') ? "\n" : "") + own + "\n";
        }
    }
    return identity;
}

std::string digest_in(std::string_view stack_text) {
    const auto place = stack_text.find(digest_label);
    return std::string(place == std::string_view::npos ? std::string_view()
                                                       : stack_text.substr(place + digest_label.size(), digest_digits));
}

std::string stack_text(const StackDescription& description) {
    std::string text =
        fmt::format("# A stack of vkfv: its configuration, every default spelled out. `vkfv stack` takes this file.\n"
                    "# What its images depend on{}{}); a run that differs in any of it is refused here:\n",
                    digest_label, description.digest);
    for (const std::string& line : lines_of(description.identity)) {
        if (!line.empty()) {
            text += fmt::format("{}{}\n", identity_prefix, line);
        }
    }
    return text + "\n" + description.configuration;
}

std::string identity_differences(std::string_view there, std::string_view here) {
    const auto old_values = values_by_key(there);
    auto new_values = values_by_key(here);
    std::string text;
    for (const auto& [key, old_value] : old_values) {
        const auto found = new_values.find(key);
        if (found == new_values.end()) {
            text += fmt::format("\n  {}: {} there, absent here", key, old_value);
        } else {
            if (found->second != old_value) {
                text += fmt::format("\n  {}: {} there, {} here", key, old_value, found->second);
            }
            new_values.erase(found);
        }
    }
    for (const auto& [key, new_value] : new_values) {
        text += fmt::format("\n  {}: absent there, {} here", key, new_value);
    }
    return text;
}

std::string stored_identity(const fs::path& folder) {
    const fs::path path = folder / configuration_name;
    std::string identity = identity_in(read_file(path, {.expected = "the configuration of a stack"}));
    if (identity.empty()) {
        refuse_file(path, "", "a file without the identity of a stack", "the stack.toml of a stack that vkfv traced",
                    "Give another --out: the configuration belongs outside of the output folder.");
    }
    return identity;
}

std::string stored_digest(const fs::path& folder) {
    return digest_in(read_file(folder / configuration_name));
}

} // namespace vkfv::scan
