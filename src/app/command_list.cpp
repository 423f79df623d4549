#include "app/commands.hpp"

#include "camera/sensors.hpp"
#include "core/files/assets.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "core/toml/toml_reader.hpp"
#include "optics/media/light_emitting_diodes.hpp"
#include "optics/prescriptions/prescription.hpp"
#include "physics/scatter_registry.hpp"
#include "specimen/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <functional>

namespace vkfv::app {

namespace {

struct ListOptions {
    std::string topic;
};

struct Listed {
    std::string name, description;
};

std::vector<Listed> prescriptions(const char* folder) {
    const auto here = std::filesystem::current_path();
    std::vector<Listed> list;
    for (const auto& name : asset_names(folder, here)) {
        list.push_back({name, optics::load_prescription(name, folder, here).title});
    }
    return list;
}

std::vector<Listed> standards() {
    constexpr const char* folder = "specimens";
    const auto here = std::filesystem::current_path();
    std::vector<Listed> list;
    for (const auto& name : asset_names(folder, here)) {
        list.push_back({name, TomlTable::open(*find_asset(name, folder, here)).string("title")});
    }
    return list;
}

std::vector<Listed> glasses() {
    constexpr double d_line_um = 0.5875618;
    const auto catalog = optics::GlassCatalog::builtin();
    std::vector<Listed> list;
    for (const auto& name : catalog.names()) {
        const auto glass = catalog.get(name);
        const auto range = glass.valid_range();
        const bool has_index = !range || (range->minimum_um <= d_line_um && d_line_um <= range->maximum_um);
        list.push_back({name, (has_index ? fmt::format("nd = {:.6f}; ", glass.index(d_line_um)) : "") + glass.source});
    }
    return list;
}

std::vector<Listed> specimens() {
    std::vector<Listed> list;
    for (const auto& kind : specimen::kinds()) {
        list.push_back({kind.name, kind.meaning});
    }
    return list;
}

std::vector<Listed> scatter_models() {
    std::vector<Listed> list;
    for (const auto& model : physics::scatter_registry) {
        std::vector<std::string> parameters;
        for (const auto& parameter : model.parameters) {
            parameters.push_back(fmt::format("{} from {} to {}, {} unless given ({})", parameter.name,
                                             parameter.minimum, parameter.maximum, parameter.fallback,
                                             parameter.meaning));
        }
        list.push_back({std::string(model.name),
                        parameters.empty() ? "no parameters" : fmt::format("{}", fmt::join(parameters, "; "))});
    }
    return list;
}

std::vector<Listed> cameras() {
    std::vector<Listed> list;
    for (const auto& sensor : camera::sensors()) {
        list.push_back(
            {std::string(sensor.name), fmt::format("{} x {} pixels of {} um, {} inch: {}", sensor.columns, sensor.rows,
                                                   sensor.pixel_um, sensor.format, sensor.source)});
    }
    return list;
}

std::vector<Listed> leds() {
    std::vector<Listed> list;
    for (const auto& colour : optics::led_colours()) {
        list.push_back({std::string(colour.name),
                        colour.full_width_um > 0 ? fmt::format("peak {:.4g} um, full width at half maximum {:.4g} um",
                                                               colour.peak_um, colour.full_width_um)
                                                 : fmt::format("blue of {:.4g} um on phosphor", colour.peak_um)});
    }
    return list;
}

using Lister = std::function<std::vector<Listed>()>;
const std::vector<std::pair<std::string, Lister>>& listers() {
    static const std::vector<std::pair<std::string, Lister>> all = {
        {"objectives", [] { return prescriptions("objectives"); }},
        {"tube-lenses", [] { return prescriptions("tube_lenses"); }},
        {"illuminators", [] { return prescriptions("illuminators"); }},
        {"cameras", cameras},
        {"leds", leds},
        {"glasses", glasses},
        {"specimens", specimens},
        {"standards", standards},
        {"scatter", scatter_models}};
    return all;
}

void run_list(const CommandOptions& options) {
    const auto topic = options.of<ListOptions>().topic;
    const auto list = std::ranges::find(listers(), topic, [](const auto& one) { return one.first; })->second();
    if (options.json) {
        auto report = nlohmann::ordered_json::array();
        for (const auto& [name, description] : list) {
            report.push_back({{"name", name}, {"description", description}});
        }
        print_text(json_text(report) + "\n");
        return;
    }
    std::size_t widest = 0;
    for (const auto& [name, description] : list) {
        widest = std::max(widest, name.size());
    }
    for (const auto& [name, description] : list) {
        print_text(fmt::format("{:<{}}  {}\n", name, widest, description));
    }
}

} // namespace

Command list_command() {
    std::vector<std::string> topics;
    for (const auto& [topic, lister] : listers()) {
        topics.push_back(topic);
    }
    return {.name = "list",
            .summary = "What a configuration can name, one a line",
            .operands = {{"WHAT", "Which names", into(&ListOptions::topic), topics}},
            .options = {json_option()},
            .run = run_list,
            .example = "vkfv list glasses",
            .about_vkfv = true};
}

} // namespace vkfv::app
