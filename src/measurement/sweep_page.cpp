#include "measurement/sweep_page.hpp"

#include "report/frames.hpp"
#include "report/markup.hpp"
#include "report/page.hpp"
#include "report/png.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

constexpr double most_picture_pixels = 6e6; // of all combinations
constexpr int most_picture_side = 400;
constexpr double brightest = 2; // of a picture's own mean, as on the contact sheet

std::string picture_base64(const Grid<float>& picture, std::size_t combinations) {
    const int block = report::block_for(picture.columns, picture.rows,
                                        most_picture_pixels / static_cast<double>(combinations), most_picture_side);
    const auto small = report::block_means(picture, block);
    double sum = 0;
    for (const float value : small.values) {
        sum += value;
    }
    const double scale = sum > 0 ? 255 / (brightest * sum / static_cast<double>(small.values.size())) : 0;
    Grid<std::uint8_t> bytes(small.columns, small.rows);
    std::ranges::transform(small.values, bytes.values.begin(), [&](float value) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(value * scale, 0.0, 255.0)));
    });
    return report::base64(report::grey_png_bytes(bytes));
}

// File relative to the page, and what the link is called.
Json links_of(const Sweep& sweep, const std::string& name) {
    Json links = Json::array();
    if (!sweep.stacks) {
        links.push_back({name + "/image.tif", "Image (TIFF)"});
    } else if (sweep.repeats == 1) {
        links.push_back({name + "/report.html", "Report of the stack"});
    } else {
        for (int repeat = 0; repeat < sweep.repeats; ++repeat) {
            links.push_back({fmt::format("{}/repeat_{:03}/report.html", name, repeat),
                             fmt::format("Report of the stack, repeat {}", repeat + 1)});
        }
    }
    return links;
}

std::string cell_of(const Json& value) {
    return value.is_number() ? report::reader_number(value.get<double>())
           : value.is_null() ? report::reader_number(NAN)
                             : value.get<std::string>();
}

void add_table(report::Page& page, const Sweep& sweep, const std::vector<SweepRow>& rows,
               const std::vector<std::string>& names) {
    std::vector<std::vector<std::string>> table(1);
    for (const auto& parameter : sweep.parameters) {
        table.front().push_back(parameter.label);
    }
    table.front().insert(table.front().end(), names.begin(), names.end());
    for (const auto& row : rows) {
        auto& cells = table.emplace_back();
        std::ranges::transform(row.values, std::back_inserter(cells), plain_text);
        for (const auto& name : names) {
            cells.push_back(cell_of(row.figures.contains(name) ? row.figures.at(name) : Json()));
        }
    }
    page.table("Every combination (sweep.csv has all digits)", table);
}

} // namespace

std::string sweep_page(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title,
                       const std::string& configuration) {
    Json data = {{"parameters", Json::array()}, {"rows", Json::array()}};
    for (const auto& parameter : sweep.parameters) {
        Json values = Json::array();
        for (const auto& value : parameter.values) {
            values.push_back(plain_text(value));
        }
        data["parameters"].push_back({{"label", parameter.label}, {"values", values}});
    }
    report::Page page;
    std::vector<std::string> names;
    for (const auto& row : rows) {
        const std::string name = sweep_name(sweep, row.values);
        const std::string picture = fmt::format("picture-{}", data["rows"].size());
        page.data(picture, picture_base64(row.picture, rows.size()));
        Json values = Json::array();
        for (const auto& value : row.values) {
            values.push_back(plain_text(value));
        }
        data["rows"].push_back({{"name", name},
                                {"values", values},
                                {"figures", row.figures},
                                {"picture", picture},
                                {"links", links_of(sweep, name)}});
        for (const auto& [figure, value] : row.figures.items()) {
            if (std::ranges::find(names, figure) == names.end()) {
                names.push_back(figure);
            }
        }
    }
    data["figures"] = names;
    page.data("data", report::json_text(data));
    page.section("matrix", "Combinations");
    page.part("sweep.html");
    page.section("figure", "The figure over the last parameter");
    page.part("sweep_chart.html");
    page.section("table", "Table");
    add_table(page, sweep, rows, names);
    page.folded("Configuration", configuration);
    for (const char* file : {"d3.min.js", "core.js", "chart.js", "sweep.js", "main.js"}) {
        page.script(file);
    }
    return page.document(title);
}

} // namespace vkfv::measurement
