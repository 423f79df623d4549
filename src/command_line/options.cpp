// Options that several commands take.
#include "command_line/command.hpp"

#include "core/parsing/text_encoding.hpp"
#include "surface/band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vkfv::command_line {

namespace {

// A text of the command line as TOML. Bytes that are no UTF-8 stay as they are, so that the reader of overrides refuses
// them.
std::string toml_text_of(const std::string& value) {
    return is_utf8(value) ? toml_quoted(value) : value;
}

// Stores a value as an override of the configuration's key. An empty value overrides nothing.
Take<std::string> to_key(const std::string& option, const std::string& key, bool text) {
    return [option, key, text](CommandOptions& options, const std::string& value) {
        if (!value.empty()) {
            options.overrides.push_back({key, text ? toml_text_of(value) : value, option});
        }
    };
}

Option setting_option() {
    const auto take = [](CommandOptions& options, const std::vector<std::string>& settings) {
        for (const auto& setting : settings) {
            const auto equals = setting.find('=');
            if (equals == std::string::npos) {
                refuse_argument("--set " + setting, "KEY=VALUE", "Write for example --set trace.rays=1e8.");
            }
            options.overrides.push_back({setting.substr(0, equals), setting.substr(equals + 1), "--set"});
        }
    };
    return {.name = "--set",
            .value = "KEY=VALUE",
            .description = "Any key of the configuration, for example --set specimen.material.g=0.65; may be repeated",
            .target = Take<std::vector<std::string>>(take),
            .setting = true};
}

double nesting_index(double um) {
    if (!(std::isfinite(um) && um >= 0)) {
        refuse_argument(fmt::format("a nesting index of {} um", um), "a positive length, or 0 for no filter",
                        "Correct --s_filter_um or --l_filter_um.");
    }
    return um / um_per_mm;
}

void take_form(CommandOptions& options, const std::string& name) {
    const auto form = surface::parse_form(name);
    if (!form) {
        refuse_argument("--form " + name, "none, plane, polynomial-1 to polynomial-20, sphere or truth",
                        "Name one of these, or leave it out for a plane.");
    }
    options.of<surface::Band>().form = *form;
}

} // namespace

// The options are in the order in which they override each other, with the strongest last.
std::vector<Option> configuration_options() {
    return {setting_option(),
            {.name = "--rays",
             .value = "N",
             .description = "Rays launched per image, 1e7 or 10000000",
             .target = to_key("--rays", "trace.rays", false)},
            {.name = "--seed",
             .value = "N",
             .description = "Seed of the trace",
             .target = to_key("--seed", "trace.seed", false)},
            {.name = "--traversal",
             .value = "NAME",
             .description = "How rays find the specimen",
             .target = to_key("--traversal", "trace.traversal", true),
             .choices = {"auto", "ray-query", "quadtree", "bvh"},
             .choices_checked = false},
            {.name = "--estimator",
             .value = "NAME",
             .description = "Start of the paths, source or pixels",
             .target = to_key("--estimator", "trace.estimator", true),
             .choices = {"forward", "backward"},
             .choices_checked = false},
            {.name = "--device",
             .value = "DEVICE",
             .description = "Index or part of a name; \"0,1\" or \"all\": several; \"host\": the CPU reference in "
                            "double precision",
             .target = to_key("--device", "trace.device", true)}};
}

Option out_option(std::string description) {
    const auto take = [](CommandOptions& options, const std::string& path) {
        if (!path.empty()) {
            options.out = path;
            options.overrides.push_back({"output.directory", toml_text_of(path), "--out"});
        }
    };
    return {.name = "--out",
            .value = "PATH",
            .description = std::move(description),
            .target = Take<std::string>(take),
            .file = true};
}

Option json_option() {
    return {.name = "--json",
            .value = "",
            .description = "Machine-readable output",
            .target = into(&CommandOptions::json),
            .foremost = "check"};
}

Option small_option(std::string description) {
    return {
        .name = "--small", .value = "", .description = std::move(description), .target = into(&CommandOptions::small)};
}

Option markdown_option() {
    return {.name = "--markdown",
            .value = "",
            .description = "All of it, as a page",
            .target = into(&CommandOptions::markdown)};
}

Option pitch_option() {
    return {.name = "--pitch_um,--pitch-um",
            .value = "UM",
            .description = "Distance of the pixels of an image on the specimen",
            .target = in_mm(&PixelPitch::value)};
}

Option accept_checksum_option() {
    return {.name = "--accept-checksum",
            .value = "",
            .description = "Read X3P files whose contents do not have the checksums that they state, with a warning",
            .target = into(&AcceptChecksum::value)};
}

std::vector<Option> band_options() {
    const auto take_l_filter = [](CommandOptions& options, double um) {
        options.of<surface::Band>().l_filter = nesting_index(um);
        if (um > 0 && options.of<surface::Band>().l_filter <= options.of<surface::Band>().s_filter) {
            // The length has all the digits that were written, without the rounding of its unit's conversion.
            refuse_argument(fmt::format("--s_filter_um {:.15g} with --l_filter_um {}",
                                        options.of<surface::Band>().s_filter * um_per_mm, um),
                            "an L-filter longer than the S-filter", "Exchange them, or leave one out.");
        }
    };
    std::vector<Option> options = {
        {.name = "--form",
         .value = "NAME",
         .description =
             "Removed first: none, plane, polynomial-1 to polynomial-20, sphere; of what is compared also truth: "
             "the plane of the deviation",
         .target = Take<std::string>(take_form),
         .fallback = "plane"},
        {.name = "--s_filter_um,--s-filter-um",
         .value = "UM",
         .description = "Nesting index of the S-filter: shorter waves are removed",
         .target = Take<double>(
             [](CommandOptions& options, double um) { options.of<surface::Band>().s_filter = nesting_index(um); }),
         .fallback = "0, no filter"},
        {.name = "--l_filter_um,--l-filter-um",
         .value = "UM",
         .description = "Nesting index of the L-filter: longer waves are removed",
         .target = Take<double>(take_l_filter),
         .fallback = "0, no filter"},
        {.name = "--filter",
         .value = "NAME",
         .description = "Which S-filter and L-filter; a spline's ends are natural (ISO 16610-22) or mirrored; robust: "
                        "ISO 16610-71",
         .target = Take<std::string>([](CommandOptions& options, const std::string& name) {
             surface::take_filter(options.of<surface::Band>(), name);
         }),
         .fallback = "gaussian",
         .choices = {surface::filter_names.begin(), surface::filter_names.end()}}};
    for (auto& option : options) {
        option.foremost = "surface";
    }
    return options;
}

std::vector<Option> together(std::vector<std::vector<Option>> lists) {
    std::vector<Option> all;
    for (auto& list : lists) {
        std::ranges::move(list, std::back_inserter(all));
    }
    return all;
}

void refuse_argument(std::string found, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = "command line"},
                      .key = "",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

} // namespace vkfv::command_line
