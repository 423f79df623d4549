#include "measurement/stack_page.hpp"

#include "core/units.hpp"
#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv::measurement {

namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string text_of(const nlohmann::ordered_json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

// "rays_per_image" as "rays per image".
std::string words_of(std::string key) {
    std::ranges::replace(key, '_', ' ');
    return key;
}

void add_deviations(Rows& rows, const std::string& prefix, const std::vector<Figures>& all) {
    for (const auto& figures : all) {
        if (const auto& deviation = figures.deviation) {
            rows.push_back(
                {prefix + report::treatment_text(figures.band), report::number_text(100 * deviation->measured_share),
                 report::number_text(deviation->sq_measured * um_per_mm),
                 report::number_text(deviation->sq_true * um_per_mm),
                 report::number_text(deviation->sq_measured / deviation->sq_true),
                 report::number_text(deviation->rms * um_per_mm), report::number_text(deviation->correlation)});
        }
    }
}

void add_dimensions(report::Page& page, const char* heading, const std::vector<StandardDimension>& dimensions) {
    if (dimensions.empty()) {
        return;
    }
    page.heading(heading);
    Rows rows{{"", "rule", "unit", "nominal", "true", "measured", "deviation", "error", "standard deviation",
               "standard error"}};
    for (const auto& one : dimensions) {
        const auto row = one.in_unit();
        std::vector<std::string> cells{row.name, row.rule, row.unit};
        for (const double value : {row.nominal, row.truth, row.measured, row.deviation, row.error,
                                   row.standard_deviation, row.standard_error}) {
            cells.push_back(report::number_text(value));
        }
        rows.push_back(cells);
    }
    page.table(rows);
}

// Of all treatments side by side; those that have none (nothing was measured) are left out.
void add_parameters(report::Page& page, const std::string& prefix, const std::vector<Figures>& all) {
    Rows rows;
    std::string treatments;
    for (const auto& figures : all) {
        if (figures.measured.empty()) {
            continue;
        }
        if (rows.empty()) {
            rows.push_back({"parameter", "unit"});
            for (const auto& row : figures.measured) {
                rows.push_back({row.name, words_of(row.unit)});
            }
        }
        treatments += (treatments.empty() ? prefix : "; then ") + report::treatment_text(figures.band);
        const bool known = !figures.truth.empty();
        rows.front().emplace_back("measured");
        if (known) {
            rows.front().insert(rows.front().end(), {"true", "ratio"});
        }
        for (std::size_t k = 0; k < figures.measured.size(); ++k) {
            const auto& row = figures.measured[k];
            auto& cells = rows[k + 1];
            cells.push_back(report::number_text(row.value));
            if (known) {
                cells.push_back(report::number_text(figures.truth[k].value));
                // A ratio of directions means nothing.
                cells.push_back(row.unit == "deg" ? "-" : report::number_text(row.value / figures.truth[k].value));
            }
        }
    }
    page.paragraph(treatments.empty() ? "Nothing was measured." : treatments + ".");
    page.table(rows);
}

// The members that are there, in this order.
void add_members(report::Page& page, const nlohmann::ordered_json& object, const std::vector<const char*>& keys) {
    Rows rows{{"", ""}};
    for (const char* key : keys) {
        if (const auto found = object.find(key); found != object.end()) {
            rows.push_back({words_of(key), text_of(*found)});
        }
    }
    page.table(rows);
}

void add_members(report::Page& page, const nlohmann::ordered_json& object) {
    std::vector<const char*> keys;
    for (const auto& [key, value] : object.items()) {
        keys.push_back(key.c_str());
    }
    add_members(page, object, keys);
}

} // namespace

std::string stack_page(const StackPage& content) {
    report::Page page;
    page.picture(content.plain.svg, "Measured heights, truth, deviation and a profile");
    const auto& points = content.results.at("points");
    if (content.plain.figures.front().deviation) {
        page.heading("Deviation from the truth");
        Rows rows{{"", "measured / %", "Sq / um", "true Sq / um", "ratio", "RMS deviation / um", "correlation"}};
        add_deviations(rows, "", content.plain.figures);
        if (content.diffracted) {
            add_deviations(rows, "with diffraction, ", content.diffracted->figures);
        }
        page.table(rows);
    }
    add_dimensions(page, "Dimensions", content.plain.dimensions);
    if (content.diffracted) {
        add_dimensions(page, "Dimensions with diffraction", content.diffracted->dimensions);
    }
    page.heading("Points");
    add_members(page, points);
    page.heading("ISO 25178-2");
    add_parameters(page, "", content.plain.figures);
    if (content.diffracted) {
        add_parameters(page, "With diffraction, ", content.diffracted->figures);
        page.heading("With diffraction");
        page.picture(content.diffracted->svg, "The same after diffraction");
    }
    page.heading("Evaluation");
    add_members(page, content.results.at("topography"));
    if (const auto flatness = content.results.find("flatness"); flatness != content.results.end()) {
        page.paragraph("Field curvature, measured on a flat, was taken off:");
        add_members(page, *flatness);
    }
    page.heading("Images");
    add_members(page, content.results,
                {"stack", "first_image", "last_image", "z_start_um", "z_step_um", "pitch_um", "shuffle_seed", "images",
                 "rays_per_image", "seed", "device", "stack_digest", "evaluated_by"});
    if (const auto waves = content.results.find("waves"); waves != content.results.end()) {
        page.paragraph("How far they are from what waves make (contrast, within two depths of field):");
        add_members(page, *waves);
    }
    if (const auto camera = content.results.find("camera"); camera != content.results.end()) {
        page.paragraph("How the camera took them; noise is the root mean square over all pixels and images, of the "
                       "camera temporal, of the rays the Monte Carlo standard error of the light:");
        add_members(page, *camera);
    }
    if (!content.layout.empty()) {
        page.heading("Instrument");
        page.picture(content.layout, "The instrument to scale, with rays");
    }
    if (!content.configuration.empty()) {
        page.heading("Configuration");
        page.folded("stack.toml", content.configuration);
    }
    return page.document(content.title);
}

} // namespace vkfv::measurement
