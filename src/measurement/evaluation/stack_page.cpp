#include "measurement/evaluation/stack_page.hpp"

#include "core/messages/json_text.hpp"
#include "measurement/scene/verdict.hpp"
#include "measurement/scene/warning_json.hpp"
#include "report/declared_figures.hpp"
#include "report/page.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace vkfv::measurement {

namespace {

using Rows = std::vector<std::vector<std::string>>;

// A treatment as the page writes it: "form plane, L-filter 80 µm (Gaussian)".
std::string treatment_of(const surface::Band& band) {
    std::string text = report::treatment_text(band);
    for (auto at = text.find(" um"); at != std::string::npos; at = text.find(" um", at)) {
        text.replace(at, 3, " µm");
    }
    return text;
}

std::string text_of(const nlohmann::ordered_json& value) {
    if (value.is_number_float()) {
        return report::reader_number(value.get<double>());
    }
    if (value.is_number_integer()) {
        return report::reader_count(value.get<std::int64_t>());
    }
    if (value.is_array()) {
        std::string text;
        for (const auto& item : value) {
            text += (text.empty() ? "" : ", ") + text_of(item);
        }
        return text;
    }
    return value.is_string() ? value.get<std::string>()
           : value.is_null() ? report::reader_number(surface::undefined)
                             : json_text(value, JsonLayout::one_line);
}

// Appends columns of numbers to the rows below the head. All numbers of a column have the same form.
void add_columns(Rows& rows, const std::vector<std::vector<double>>& columns) {
    for (const auto& column : columns) {
        const auto texts = report::reader_column(column);
        for (std::size_t k = 0; k < texts.size(); ++k) {
            rows[k + 1].push_back(texts[k]);
        }
    }
}

// A name as the page writes it: "Sq / µm", "Vmp / (µm³/µm²)".
std::string with_unit(const std::string& name, const std::string& unit_in_keys) {
    const std::string unit = report::reader_unit(unit_in_keys);
    return name + (unit.empty() ? "" : unit.find('/') == std::string::npos ? " / " + unit : " / (" + unit + ")");
}

void add_deviations(report::Page& page, const StackPage& content) {
    Rows rows{{"treatment of both surfaces", "measured / %"}};
    std::vector<std::string> keys;
    for (const char* name : {"sq_true", "sq_measured", "sq_ratio", "rms_deviation", "correlation"}) {
        const auto figure = report::declared_figure("results", name);
        rows.front().push_back(with_unit(figure.title, figure.unit));
        keys.push_back(figure.key);
    }
    std::vector<std::vector<double>> columns(rows.front().size() - 1);
    const auto add = [&](const std::string& prefix, const std::vector<Figures>& all) {
        for (const auto& figures : all) {
            if (figures.deviation) {
                rows.push_back({prefix + treatment_of(figures.band)});
                columns.front().push_back(100 * figures.deviation->measured_share);
                const auto written = json_of(figures);
                for (std::size_t k = 0; k < keys.size(); ++k) {
                    columns[k + 1].push_back(written.at(keys[k]).get<double>());
                }
            }
        }
    };
    add("", content.plain.figures);
    if (content.diffracted) {
        add("with diffraction, ", content.diffracted->figures);
    }
    add_columns(rows, columns);
    page.table("Measured heights against true ones", rows);
}

void add_dimensions(report::Page& page, const char* caption, const std::vector<StandardDimension>& dimensions) {
    Rows rows{{"dimension", "rule", "unit", "nominal", "true", "measured", "measured − nominal", "measured − true",
               "standard deviation", "uncertainty by brightness", "uncertainty by the window"}};
    for (const auto& one : dimensions) {
        const auto row = one.in_unit();
        // Nominal and true values have no uncertainty, so differences from them have the uncertainty of the measured
        // value.
        const bool uncertain = row.standard_error > 0 && std::isfinite(row.measured);
        const auto exact = report::form_for(uncertain ? std::vector{row.nominal, row.truth}
                                                      : std::vector{row.nominal, row.truth, row.measured});
        const auto spread = uncertain ? report::form_for(row.measured, row.standard_error) : exact;
        const auto measured = [&](double value) {
            return uncertain ? report::reader_number(value, row.standard_error) : report::reader_number(value, exact);
        };
        rows.push_back({row.name, row.rule, report::reader_unit(row.unit), report::reader_number(row.nominal, exact),
                        report::reader_number(row.truth, exact), measured(row.measured), measured(row.deviation),
                        measured(row.error), report::reader_number(row.standard_deviation, spread),
                        report::reader_number(row.brightness_uncertainty, spread),
                        report::reader_number(row.window_uncertainty, spread)});
    }
    page.table(caption, rows);
}

// Adds a table for each treatment, except where nothing was measured.
bool add_parameters(report::Page& page, const std::string& prefix, const std::vector<Figures>& all) {
    bool any = false;
    for (const auto& figures : all) {
        if (figures.measured.empty()) {
            continue;
        }
        any = true;
        const bool known = !figures.truth.empty();
        Rows rows{known ? std::vector<std::string>{"parameter", "nominal", "measured", "deviation"}
                        : std::vector<std::string>{"parameter", "measured"}};
        for (std::size_t k = 0; k < figures.measured.size(); ++k) {
            const auto& row = figures.measured[k];
            rows.push_back({with_unit(row.name, row.unit)});
            if (known) {
                std::ranges::move(report::reader_deviation(figures.truth[k].value, row.value),
                                  std::back_inserter(rows.back()));
            } else {
                rows.back().push_back(report::reader_figure(row.value));
            }
        }
        page.table(prefix + treatment_of(figures.band), rows);
    }
    return any;
}

// Adds a table of these members, in this order, as far as the object has them.
void add_members(report::Page& page, const char* caption, const nlohmann::ordered_json& object,
                 const std::vector<std::string>& keys) {
    Rows rows{{"", "value"}};
    for (const std::string& key : keys) {
        if (const auto found = object.find(key); found != object.end()) {
            // Digests and seeds are names and not quantities.
            const bool name = key.ends_with("seed") || key.ends_with("digest");
            rows.push_back({report::reader_label(key), name && !found->is_string() ? found->dump() : text_of(*found)});
        }
    }
    page.table(caption, rows);
}

void add_members(report::Page& page, const char* caption, const nlohmann::ordered_json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) {
        keys.push_back(key);
    }
    add_members(page, caption, object, keys);
}

nlohmann::ordered_json ledger_json(const scan::MeanLedger& ledger) {
    auto shares = nlohmann::ordered_json::array();
    for (const auto& share : ledger.shares) {
        shares.push_back({share.name, share.power});
    }
    return {{"emitted", ledger.emitted}, {"shares", shares}, {"rays", ledger.rays}};
}

void add_light(report::Page& page, const scan::MeanLedger& ledger) {
    page.section("light", "Light from the source to the detector");
    page.part("light.html");
    Rows rows{{"where it went", "power / W", "share of the emitted / %"}};
    std::vector<std::vector<double>> columns(2);
    for (const auto& [name, power] : ledger.shares) {
        if (power != 0 || name == "detected") {
            rows.push_back({name == "residual" ? "residual: emitted less all of these" : name});
            columns[0].push_back(power);
            columns[1].push_back(100 * power / ledger.emitted);
        }
    }
    add_columns(rows, columns);
    const std::string of = ledger.rays == 0 ? "Mean of all images"
                                            : fmt::format("Of {} rays that were traced forward: the images' own "
                                                          "paths follow only light that is detected",
                                                          ledger.rays);
    page.table(of + "; what is not listed took none", rows);
}

// A reader of the report may not have seen the terminal, so the page repeats its verdict and its warnings.
void add_verdict(report::Page& page, const nlohmann::ordered_json& results) {
    const Verdict verdict = verdict_of_json(results.at("verdict"));
    std::string text;
    for (const std::string& sentence : verdict.sentences) {
        text += (text.empty() ? "" : "; ") + sentence;
    }
    page.paragraph("Verdict: " + text + ".");
    for (const Warning& warning : warnings_of_json(results.at("warnings"))) {
        const std::string remedy = remedy_text(warning);
        page.paragraph("Warning: " + warning.sentence + (remedy.empty() ? "" : " " + remedy));
    }
}

void add_run(report::Page& page, const StackPage& content) {
    const auto& results = content.results;
    page.section("run", "Run and settings");
    add_members(page, "Images", results,
                {"stack", "first_image", "last_image", "z_start_um", "z_step_um", "pitch_um", "dark", "flat_field",
                 "dead_pixels", "shuffle_seed", "images", "rays_per_image", "seed", "device", "stack_digest",
                 "field_curvature_uncorrected_um", "evaluated_by"});
    add_members(page, "Points by what became of them", results.at("points"));
    add_members(page, "Evaluation", results.at("topography"));
    constexpr std::array<std::pair<const char*, const char*>, 5> tables = {
        {{"image_faults", "What the images themselves tell of the light, the exposure and the stage"},
         {"flatness", "Field curvature, measured on a flat, that was taken off"},
         {"waves", "How far the images are from what waves make (contrast, within two depths of field)"},
         {"camera", "How the camera took them; noise is the root mean square over all pixels and images, of the "
                    "camera temporal, of the rays the Monte Carlo standard error of the light"},
         {"stage", "Errors of the stage"}}};
    for (const auto& [key, caption] : tables) {
        if (const auto found = results.find(key); found != results.end()) {
            add_members(page, caption, *found);
        }
    }
    if (!content.configuration.empty()) {
        page.folded("Configuration (stack.toml)", content.configuration);
    }
}

} // namespace

std::string stack_page(const StackPage& content) {
    report::Page page;
    const auto& plain = content.plain;
    page.section("results", "Results");
    add_verdict(page, content.results);
    if (plain.figures.front().deviation) {
        add_deviations(page, content);
    } else {
        page.paragraph(fmt::format("Measured: {} % of the points.",
                                   report::reader_figure(100 * plain.figures.front().measured_share)));
    }
    if (!plain.dimensions.empty()) {
        add_dimensions(page, "Dimensions of the standard", plain.dimensions);
    }
    if (content.diffracted && !content.diffracted->dimensions.empty()) {
        add_dimensions(page, "Dimensions with diffraction", content.diffracted->dimensions);
    }
    page.section("heights", "Heights");
    page.part("maps.html");
    page.section("profile", "Profile");
    page.part("profile.html");
    page.section("focus", "Images and focus curve");
    page.part("focus.html");
    page.section("surface", "Surface");
    page.part("surface.html");
    page.section("distributions", "Distribution of heights");
    page.part("distributions.html");
    page.section("parameters", "ISO 25178-2 parameters");
    if (std::ranges::any_of(plain.figures, [](const Figures& each) { return !each.truth.empty(); })) {
        page.paragraph("Nominal values are those of the true surface at the same points, treated alike.");
    }
    const bool measured = add_parameters(page, "", plain.figures);
    page.paragraph(measured ? std::string(report::std_direction) + "." : "Nothing was measured.");
    if (content.diffracted) {
        add_parameters(page, "With diffraction, ", content.diffracted->figures);
    }
    if (!content.ledger.shares.empty()) {
        add_light(page, content.ledger);
    }
    if (!content.layout.empty()) {
        page.section("instrument", "Instrument");
        page.picture(content.layout, "The instrument to scale, with rays");
    }
    page.section("timings", "Timings");
    page.part("timings.html");
    add_run(page, content);
    std::vector<EvaluationData> evaluations{plain.data};
    if (content.diffracted) {
        evaluations.push_back(content.diffracted->data);
    }
    add_data(page, content.frames, evaluations, ledger_json(content.ledger));
    const auto device = content.results.find("device");
    return page.document(content.title, content.summary.empty() || device == content.results.end()
                                            ? content.summary
                                            : content.summary + " Traced by " + device->get<std::string>() + ".");
}

} // namespace vkfv::measurement
