#include "measurement/sweep/sweep_page.hpp"

#include "report/frames.hpp"
#include "report/markup.hpp"
#include "report/page.hpp"
#include "report/png.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

constexpr double most_picture_pixels = 6e6; // of all combinations
constexpr int most_picture_side = 400;
constexpr double brightest = 2; // over a picture's own mean, as on the contact sheet

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

// The links of a combination: a file relative to the page, and the name of the link.
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

// A title with the unit as readers write it, "height noise / µm"; sweep.js does the same.
std::string title_of(std::string name) {
    for (auto at = name.find(" um"); at != std::string::npos; at = name.find(" um", at)) {
        name.replace(at, 3, " µm");
    }
    return name;
}

std::vector<std::string> plain_values(const std::vector<std::string>& values) {
    std::vector<std::string> texts;
    std::ranges::transform(values, std::back_inserter(texts), plain_text);
    return texts;
}

void add_table(report::Page& page, const Sweep& sweep, const std::vector<SweepRow>& rows,
               const std::vector<std::string>& names) {
    std::vector<std::vector<std::string>> table(rows.size() + 1);
    const auto add_column = [&](const std::string& head, const std::vector<std::string>& cells) {
        table.front().push_back(head);
        for (std::size_t k = 0; k < cells.size(); ++k) {
            table[k + 1].push_back(cells[k]);
        }
    };
    for (std::size_t k = 0; k < sweep.parameters.size(); ++k) {
        std::vector<std::string> values;
        std::ranges::transform(rows, std::back_inserter(values),
                               [k](const SweepRow& row) { return plain_text(row.values[k]); });
        add_column(sweep.parameters[k].label, report::reader_values(values));
    }
    for (const auto& name : names) {
        std::vector<double> values;
        std::ranges::transform(rows, std::back_inserter(values), [&](const SweepRow& row) {
            const auto found = row.figures.find(name);
            return found != row.figures.end() && found->is_number() ? found->get<double>() : NAN;
        });
        add_column(title_of(name), report::reader_column(values));
    }
    page.table("Every combination (sweep.json has all digits)", table);
}

void add_run(report::Page& page, const Sweep& sweep, const std::vector<SweepRow>& rows, const Configuration& base) {
    std::vector<std::string> devices; // several if the sweep was continued on another machine
    for (const auto& row : rows) {
        if (!row.device.empty() && std::ranges::find(devices, row.device) == devices.end()) {
            devices.push_back(row.device);
        }
    }
    page.section("run", "Run and settings");
    std::vector<std::vector<std::string>> table{{"", "value"}};
    table.push_back({"combinations", report::reader_count(static_cast<std::int64_t>(rows.size()))});
    table.push_back({"each of them", sweep.stacks ? "a stack" : "an image"});
    if (sweep.repeats > 1) {
        table.push_back({"repeats, with seeds that follow each other", report::reader_count(sweep.repeats)});
    }
    if (std::ranges::find(sweep.parameters, "trace.seed", &Sweep::Parameter::key) == sweep.parameters.end()) {
        table.push_back({"seed", fmt::format("{}", base.trace.seed)});
    }
    table.push_back({"device", fmt::format("{}", fmt::join(devices, "; "))});
    table.push_back({"version", "vkfv " VKFV_VERSION});
    page.table("Sweep", table);
    page.folded("Configuration", base.canonical);
}

} // namespace

std::string sweep_page(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title,
                       const Configuration& base) {
    Json data = {{"parameters", Json::array()}, {"rows", Json::array()}};
    for (const auto& parameter : sweep.parameters) {
        const auto values = plain_values(parameter.values);
        data["parameters"].push_back(
            {{"label", parameter.label}, {"values", values}, {"written", report::reader_values(values)}});
    }
    report::Page page;
    std::vector<std::string> names;
    for (const auto& row : rows) {
        const std::string name = sweep_name(sweep, row.values);
        const std::string picture = fmt::format("picture-{}", data["rows"].size());
        page.data(picture, picture_base64(row.picture, rows.size()));
        data["rows"].push_back({{"name", name},
                                {"values", plain_values(row.values)},
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
    page.data("data", report::page_json(data));
    page.section("matrix", "Combinations");
    page.part("sweep.html");
    page.section("figure", "The figure over the last parameter");
    page.part("sweep_chart.html");
    page.section("table", "Table");
    add_table(page, sweep, rows, names);
    add_run(page, sweep, rows, base);
    for (const char* file : {"d3.min.js", "core.js", "chart.js", "sweep.js", "main.js"}) {
        page.script(file);
    }
    return page.document(title);
}

} // namespace vkfv::measurement
