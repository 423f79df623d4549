#include "measurement/scene/configured_numbers.hpp"

#include "core/toml/toml_reader.hpp"

namespace vkfv::measurement {

namespace {
namespace of_configured_numbers { // files of a unity build share the unnamed namespace

std::optional<double> number_of(const TomlTable& root, const std::string& key) {
    const auto dot = key.find('.');
    if (dot == std::string::npos) {
        return root.optional_number(key);
    }
    const auto below = root.optional_table(key.substr(0, dot));
    return below ? number_of(*below, key.substr(dot + 1)) : std::nullopt;
}

} // namespace of_configured_numbers
} // namespace

std::optional<double> number_in(const Configuration& configuration, const std::string& key) {
    return of_configured_numbers::number_of(TomlTable::parse(configuration.canonical, configuration.file), key);
}

std::map<std::string, std::uint32_t> seeds_in(const Configuration& configuration,
                                              const std::vector<std::string>& keys) {
    const auto table = TomlTable::parse(configuration.canonical, configuration.file);
    std::map<std::string, std::uint32_t> seeds;
    for (const std::string& key : keys) {
        if (const auto value = of_configured_numbers::number_of(table, key)) {
            seeds.emplace(key, static_cast<std::uint32_t>(*value));
        }
    }
    return seeds;
}

} // namespace vkfv::measurement
