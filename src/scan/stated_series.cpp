#include "scan/stated_series.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/parsing/length_unit.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

namespace vkfv::scan {

namespace {

// Length in mm of a unit by its name in ImageJ and OME; 0 if it is no length ("pixel", "reference frame").
double length_of(std::string_view unit) {
    return mm_per_length_unit(unit).value_or(0);
}

// A finite number, with spaces around it or a plus sign before it or not, whatever the locale here is: programs write
// the decimal comma of theirs. Commas between thousands are refused.
std::optional<double> number_in(std::string_view given) {
    const auto first = given.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return std::nullopt;
    }
    std::string text(given.substr(first, given.find_last_not_of(" \t") + 1 - first));
    text.erase(0, text.front() == '+' && text.size() > 1 && text[1] != '-' ? 1 : 0);
    if (std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos) {
        text[text.find(',')] = '.';
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value) ? std::optional(value)
                                                                                            : std::nullopt;
}

int count_in(std::string_view text) {
    const double value = number_in(text).value_or(1);
    return value >= 1 && value <= 1e9 ? static_cast<int>(value) : 1;
}

// The pages along three axes, the first axis the fastest.
std::vector<int> pages_of(std::string_view order, int channels, int heights, int frames) {
    std::vector<int> pages(static_cast<std::size_t>(channels) * static_cast<std::size_t>(heights) *
                           static_cast<std::size_t>(frames));
    std::map<char, int> strides;
    int stride = 1;
    for (const char axis : order) {
        strides[axis] = stride;
        stride *= axis == 'C' ? channels : axis == 'Z' ? heights : frames;
    }
    std::size_t next = 0;
    for (int height = 0; height < heights; ++height) {
        for (int channel = 0; channel < channels; ++channel) {
            for (int frame = 0; frame < frames; ++frame) {
                pages[next++] = height * strides['Z'] + channel * strides['C'] + frame * strides['T'];
            }
        }
    }
    return pages;
}

double planes_of(const StatedSeries& stated) {
    return static_cast<double>(stated.channels) * stated.heights * stated.frames;
}

[[noreturn]] void refuse_counts(const std::filesystem::path& file, const StatedSeries& stated, int pages) {
    refuse_file(file, "",
                fmt::format("{} pages, where {} states heights: {}, channels: {}, frames: {}", pages, stated.by,
                            stated.heights, stated.channels, stated.frames),
                "as many pages as it states",
                "Save it anew as a TIFF with a page for each image: beyond 4 GB ImageJ writes one page for all.");
}

// The values of lines KEY=VALUE, by key.
std::map<std::string, std::string> lines_of(const std::string& description) {
    std::map<std::string, std::string> values;
    for (std::size_t at = 0; at < description.size();) {
        const std::size_t end = std::min(description.find_first_of("\r\n", at), description.size());
        const std::string line = description.substr(at, end - at);
        if (const auto equals = line.find('='); equals != std::string::npos) {
            values.emplace(line.substr(0, equals), line.substr(equals + 1));
        }
        at = end + 1;
    }
    return values;
}

double unit_length(images::ImageStatement::Unit unit) {
    using Unit = images::ImageStatement::Unit;
    return unit == Unit::inch ? 25.4 : unit == Unit::centimetre ? 10.0 : 0.0;
}

// Takes the pitch from the numbers of columns and rows in a unit of these lengths. Inches and centimetres are not used
// if they are a resolution for printers, as cameras and programs write it for any image.
void take_pitch(StatedSeries& stated, const images::ImageStatement& statement, double along_x, double along_y) {
    if (statement.columns_per_unit <= 0 || statement.rows_per_unit <= 0 || along_x <= 0 || along_y <= 0) {
        return;
    }
    const double x = along_x / statement.columns_per_unit, y = along_y / statement.rows_per_unit;
    constexpr double coarsest = 0.02; // mm, a little finer than 1200 pixels an inch
    if (statement.unit != images::ImageStatement::Unit::none && std::max(x, y) > coarsest) {
        stated.doubts.push_back(
            fmt::format("states pixels of {:.4g} um, as for a printer, which is not used", x * um_per_mm));
        return;
    }
    stated.pitch_x = x;
    stated.pitch_y = y;
}

StatedSeries by_imagej(const images::ImageStatement& statement, int pages, const std::filesystem::path& file) {
    StatedSeries stated{.by = "ImageJ's description"};
    auto lines = lines_of(statement.description);
    const auto count = [&](const char* key) { return lines.contains(key) ? count_in(lines.at(key)) : 1; };
    stated.channels = count("channels");
    stated.heights = count("slices");
    stated.frames = count("frames");
    const int images = count("images");
    if (stated.channels == 1 && stated.heights == 1 && stated.frames > 1) {
        stated.doubts.push_back(fmt::format("states {} frames of one slice, the same height at other times; they are "
                                            "taken as {} heights",
                                            stated.frames, stated.frames));
        stated.heights = std::exchange(stated.frames, 1);
    }
    if (stated.channels == 1 && stated.frames == 1) { // a plain stack may state its images alone
        stated.heights = std::max(stated.heights, images);
    }
    if (pages != StatedSeries::uncounted) {
        if (planes_of(stated) != pages) {
            refuse_counts(file, stated, pages);
        }
        stated.pages = pages_of("CZT", stated.channels, stated.heights, stated.frames);
    }
    const auto unit_of = [&](const char* key) {
        return lines.contains(key)      ? length_of(lines.at(key))
               : lines.contains("unit") ? length_of(lines.at("unit"))
                                        : 0;
    };
    // A unit in the tags takes precedence over the description's; ImageJ itself writes lengths only into the
    // description.
    const double by_tags = unit_length(statement.unit);
    const double along_x = by_tags > 0 ? by_tags : lines.contains("unit") ? unit_of("unit") : 0;
    const double along_y = by_tags > 0 ? by_tags : lines.contains("yunit") ? unit_of("yunit") : along_x;
    take_pitch(stated, statement, along_x, along_y);
    const auto spacing = lines.contains("spacing") ? number_in(lines.at("spacing")) : std::nullopt;
    if (lines.contains("spacing") && !spacing) {
        stated.doubts.push_back(fmt::format("states a spacing of \"{}\", which is no number and is not used",
                                            lines.at("spacing").substr(0, 40)));
    }
    if (spacing) {
        const double unit = lines.contains("zunit")  ? unit_of("zunit")
                            : lines.contains("unit") ? unit_of("unit")
                                                     : by_tags;
        const double step = spacing.value_or(0) * unit;
        if (unit > 0 && step != 0) {
            stated.z_step = step;
            // The slice of height 0, counted from the first.
            const auto origin = lines.contains("zorigin") ? number_in(lines.at("zorigin")) : std::nullopt;
            stated.z_start = origin ? std::optional(-*origin * step + 0.0) : std::nullopt;
        } else {
            stated.doubts.push_back(
                fmt::format("states a spacing of {} without a unit of length, which is not used", lines.at("spacing")));
        }
    }
    return stated;
}

std::optional<double> length_in(const pugi::xml_node& node, const std::string& name) {
    const auto value = number_in(node.attribute(name.c_str()).value());
    const double unit = length_of(node.attribute((name + "Unit").c_str()).as_string("\u00b5m"));
    return value && *value != 0 && unit > 0 ? std::optional(*value * unit) : std::nullopt;
}

// The page of each plane, as the file states it, else by the order of its dimensions.
void take_pages(const pugi::xml_node& pixels, StatedSeries& stated, int pages, const std::filesystem::path& file) {
    std::string order = pixels.attribute("DimensionOrder").as_string("XYZCT");
    order = order.size() == 5 ? order.substr(2) : "ZCT";
    const auto in_order = pages_of(order, stated.channels, stated.heights, stated.frames);
    stated.pages = in_order;
    std::vector<bool> known(stated.pages.size(), false);
    const auto all = pixels.children("TiffData");
    if (std::distance(all.begin(), all.end()) > pages) {
        refuse_counts(file, stated, pages);
    }
    for (const pugi::xml_node data : all) {
        const std::string other = data.child("UUID").attribute("FileName").value();
        if (!other.empty() && other != file.filename().string()) {
            refuse_file(file, "", fmt::format("planes in other files, {} among them", other), "all planes in one file",
                        "Save it as one OME-TIFF.");
        }
        const int first_page = data.attribute("IFD").as_int(0);
        const int planes = data.attribute("PlaneCount").as_int(data.attribute("IFD") ? 1 : pages);
        const int height = data.attribute("FirstZ").as_int(0), channel = data.attribute("FirstC").as_int(0),
                  frame = data.attribute("FirstT").as_int(0);
        if (height < 0 || height >= stated.heights || channel < 0 || channel >= stated.channels || frame < 0 ||
            frame >= stated.frames || first_page < 0 || first_page >= pages || planes < 0) {
            refuse_counts(file, stated, pages);
        }
        const auto index_of = [&](int z, int c, int t) {
            return static_cast<std::size_t>((z * stated.channels + c) * stated.frames + t);
        };
        const int begin = in_order[index_of(height, channel, frame)];
        for (std::size_t k = 0; k < in_order.size(); ++k) {
            if (in_order[k] >= begin && in_order[k] - begin < planes) {
                stated.pages[k] = first_page + in_order[k] - begin;
                known[k] = true;
            }
        }
    }
    const bool some = std::ranges::find(known, true) != known.end();
    if (std::ranges::any_of(stated.pages, [&](int page) { return page >= pages; }) ||
        (some && std::ranges::find(known, false) != known.end())) {
        refuse_counts(file, stated, pages);
    }
}

// Heights of single planes take precedence over the step that the whole file states.
void take_positions(const pugi::xml_node& pixels, StatedSeries& stated) {
    std::vector<std::optional<double>> positions(static_cast<std::size_t>(stated.heights));
    for (const pugi::xml_node plane : pixels.children("Plane")) {
        const int height = plane.attribute("TheZ").as_int(-1);
        const auto value = number_in(plane.attribute("PositionZ").value());
        const double unit = length_of(plane.attribute("PositionZUnit").as_string("reference frame"));
        if (height >= 0 && height < stated.heights && plane.attribute("TheC").as_int(0) == 0 &&
            plane.attribute("TheT").as_int(0) == 0 && value && unit > 0) {
            positions[static_cast<std::size_t>(height)] = *value * unit;
        }
    }
    if (stated.heights < 2 ||
        !std::ranges::all_of(positions, [](const auto& position) { return position.has_value(); })) {
        return;
    }
    const double first = *positions.front(), step = (*positions.back() - first) / (stated.heights - 1);
    if (step == 0) {
        return; // a stage that moved while its position was not read
    }
    double worst = 0;
    for (int height = 0; height < stated.heights; ++height) {
        worst = std::max(worst, std::abs(*positions[static_cast<std::size_t>(height)] - first - height * step));
    }
    if (worst > 0.1 * std::abs(step)) {
        stated.doubts.push_back(
            fmt::format("states heights of its planes that stand up to {:.3g} um from equal steps of "
                        "{:.6g} um, which are used",
                        worst * um_per_mm, step * um_per_mm));
    }
    stated.z_step = step;
    stated.z_start = first;
}

StatedSeries by_ome(const pugi::xml_node& pixels, int pages, const std::filesystem::path& file) {
    StatedSeries stated{.by = "OME-XML"};
    const auto count = [&](const char* name) { return count_in(pixels.attribute(name).as_string("1")); };
    stated.heights = count("SizeZ");
    stated.frames = count("SizeT");
    // A channel of several samples, such as colour, is one page.
    std::int64_t samples = 0;
    int channels = 0;
    for (const pugi::xml_node channel : pixels.children("Channel")) {
        samples += std::max(1, channel.attribute("SamplesPerPixel").as_int(1));
        channels += 1;
    }
    const int size = count("SizeC");
    stated.channels = channels > 0 && samples == size ? channels : size;
    const bool counted = pages != StatedSeries::uncounted;
    if (counted) {
        if (planes_of(stated) != pages) {
            refuse_counts(file, stated, pages);
        }
        take_pages(pixels, stated, pages, file);
    }
    stated.pitch_x = length_in(pixels, "PhysicalSizeX");
    stated.pitch_y = length_in(pixels, "PhysicalSizeY");
    stated.z_step = length_in(pixels, "PhysicalSizeZ");
    if (counted) {
        take_positions(pixels, stated);
    }
    return stated;
}

// "2026:01:31 12:00:00" as xsd:dateTime; empty for any other text.
std::string date_of(const std::string& date) {
    constexpr std::string_view pattern = "0000:00:00 00:00:00";
    if (date.size() < pattern.size()) {
        return {};
    }
    std::string text = date.substr(0, pattern.size());
    for (std::size_t k = 0; k < pattern.size(); ++k) {
        const bool digit = text[k] >= '0' && text[k] <= '9';
        if (pattern[k] == '0' ? !digit : text[k] != pattern[k]) {
            return {};
        }
    }
    text[4] = text[7] = '-';
    text[10] = 'T';
    return text;
}

StatedSeries by_description(const images::ImageStatement& statement, int pages, const std::filesystem::path& file) {
    if (statement.description.starts_with("ImageJ=")) {
        return by_imagej(statement, pages, file);
    }
    if (statement.description.find("<OME") != std::string::npos) {
        pugi::xml_document document;
        if (document.load_buffer(statement.description.data(), statement.description.size())) {
            const auto images = document.document_element().children("Image");
            if (std::distance(images.begin(), images.end()) > 1) {
                refuse_file(file, "", "OME-XML of several images", "one image of several planes",
                            "Save the one to be measured as a file of its own.");
            }
            if (const pugi::xml_node pixels = document.document_element().child("Image").child("Pixels")) {
                StatedSeries stated = by_ome(pixels, pages, file);
                stated.date = document.document_element().child("Image").child_value("AcquisitionDate");
                return stated;
            }
        }
    }
    StatedSeries stated;
    stated.heights = pages;
    stated.pages.resize(static_cast<std::size_t>(pages));
    std::iota(stated.pages.begin(), stated.pages.end(), 0);
    const double unit = unit_length(statement.unit);
    take_pitch(stated, statement, unit, unit);
    stated.by = stated.pitch_x ? "the resolution tags" : "";
    return stated;
}

} // namespace

StatedSeries stated_series(const images::ImageStatement& statement, int pages, const std::filesystem::path& file) {
    StatedSeries stated = by_description(statement, pages, file);
    if (stated.date.empty()) {
        stated.date = date_of(statement.date);
    }
    return stated;
}

} // namespace vkfv::scan
