#include "measurement/evaluation/page_data.hpp"

#include "core/mathematics/units.hpp"
#include "report/markup.hpp"
#include "report/png.hpp"
#include "surface/material_ratio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <future>
#include <limits>
#include <span>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

constexpr double most_map_points = 420000; // over all evaluations together; a point takes 7 bytes
constexpr int most_map_side = 2048;
constexpr std::size_t most_curve_values = 512; // of a curve, over all evaluations together
constexpr int histogram_intervals = 100;

static_assert(std::endian::native == std::endian::little); // the scripts read little endian

template <class Value>
std::string base64_of(const std::vector<Value>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return report::base64(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

struct Extent {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void include(double value) {
        if (std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    bool any() const { return low <= high; }
};

Extent extent_of(const Grid<double>& values) {
    Extent extent;
    for (const double value : values.values) {
        extent.include(value);
    }
    return extent;
}

// Heights as 16 bits from the lowest (0) to the highest (65534); 65535 is a point that was not measured.
Json packed_heights(EvaluationData& data, const std::string& id, const Grid<double>& heights) {
    constexpr double steps = 65534;
    constexpr std::uint16_t nothing = 65535;
    const Extent extent = extent_of(heights);
    const double scale = extent.high > extent.low ? steps / (extent.high - extent.low) : 0;
    std::vector<std::uint16_t> packed(heights.values.size());
    std::ranges::transform(heights.values, packed.begin(), [&](double height) {
        return std::isfinite(height) ? static_cast<std::uint16_t>(std::lround((height - extent.low) * scale)) : nothing;
    });
    data.blobs.emplace_back(id, base64_of(packed));
    return {{"low", extent.any() ? extent.low * um_per_mm : 0.0},
            {"high", extent.any() ? extent.high * um_per_mm : 0.0},
            {"blob", id}};
}

// The state of each block of points: measured where any point of it was, otherwise the state of its middle.
std::vector<std::uint8_t> states_of(const topography::Topography& topography, const Grid<double>& heights, int block) {
    std::vector<std::uint8_t> states;
    states.reserve(heights.values.size());
    const auto& state = topography.state;
    for (int row = 0; row < heights.rows; ++row) {
        for (int column = 0; column < heights.columns; ++column) {
            const auto middle = state(std::min(state.columns - 1, column * block + block / 2),
                                      std::min(state.rows - 1, row * block + block / 2));
            const bool measured = std::isfinite(heights(column, row)) && middle != topography::PointState::repaired;
            states.push_back(static_cast<std::uint8_t>(measured ? topography::PointState::measured : middle));
        }
    }
    return states;
}

// The all-in-focus image in 8 bits. The brightest thousandth of the pixels is white.
std::string texture_png(const Grid<float>& image) {
    std::vector<float> values = image.values;
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, place);
    const float scale = *place > 0 ? 255 / *place : 0;
    Grid<std::uint8_t> bytes(image.columns, image.rows);
    std::ranges::transform(image.values, bytes.values.begin(), [&](float value) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(value * scale, 0.0f, 255.0f)));
    });
    return report::grey_png_bytes(bytes);
}

Json map_data(EvaluationData& data, const std::string& name, const Evaluation& evaluation, int count) {
    const LevelledMaps& maps = evaluation.levelled;
    const auto& place = maps.pair.measured;
    const int block = report::block_for(place.columns(), place.rows(), most_map_points / count, most_map_side);
    const auto measured = report::block_means(place.height, block);
    const double beside = (block - 1) / 2.0;
    Json json = {{"columns", measured.columns},
                 {"rows", measured.rows},
                 {"block", block},
                 {"x0", (place.x0 + beside * place.pitch_x) * um_per_mm},
                 {"y0", (place.y0 + beside * place.pitch_y) * um_per_mm},
                 {"pitch", {block * place.pitch_x * um_per_mm, block * place.pitch_y * um_per_mm}}};
    json["layers"]["measured"] = packed_heights(data, name + "-measured", measured);
    if (maps.truth) {
        json["layers"]["truth"] = packed_heights(data, name + "-truth", report::block_means(maps.truth->height, block));
    }
    if (maps.deviation) {
        json["layers"]["deviation"] =
            packed_heights(data, name + "-deviation", report::block_means(maps.deviation->height, block));
    }
    data.blobs.emplace_back(name + "-states", base64_of(states_of(evaluation.topography, measured, block)));
    json["states"] = name + "-states";
    data.blobs.emplace_back(
        name + "-texture",
        report::base64(texture_png(report::block_means(topography::grey(evaluation.topography.all_in_focus), block))));
    json["texture"] = name + "-texture";
    return json;
}

// Each curve in 8 bits from its lowest value to its highest.
Json curves_data(EvaluationData& data, const std::string& name, const Evaluation& evaluation, int count) {
    const auto& curves = evaluation.topography.curves;
    const std::size_t heights = curves.z.size();
    const std::size_t points = curves.peaks.size();
    if (heights == 0 || points == 0) {
        return nullptr;
    }
    const std::size_t most = most_curve_values / static_cast<std::size_t>(count);
    const std::size_t every = (heights + most - 1) / most;
    const std::size_t kept = (heights + every - 1) / every;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(points * kept);
    // Numbers of a curve: the lowest and the highest value, the peak and its standard uncertainty in um, and the fit as
    // the image in its middle, its half width in images, its largest value and its coefficients.
    std::vector<float> numbers;
    for (std::size_t point = 0; point < points; ++point) {
        const auto curve = std::span(curves.values).subspan(point * heights, heights);
        const auto [low, high] = std::ranges::minmax(curve);
        const float scale = high > low ? 255 / (high - low) : 0;
        for (std::size_t k = 0; k < heights; k += every) {
            bytes.push_back(static_cast<std::uint8_t>(std::lround((curve[k] - low) * scale)));
        }
        const auto& fit = curves.fits[point];
        const double uncertainty = evaluation.topography.height_uncertainty(
            curves.columns[point % curves.columns.size()], curves.rows[point / curves.columns.size()]);
        for (const double number :
             {static_cast<double>(low), static_cast<double>(high), curves.peaks[point] * um_per_mm,
              uncertainty * um_per_mm, static_cast<double>(fit.at), static_cast<double>(fit.range), fit.largest,
              fit.coefficients[0], fit.coefficients[1], fit.coefficients[2]}) {
            numbers.push_back(static_cast<float>(number));
        }
    }
    data.blobs.emplace_back(name + "-curves", base64_of(bytes));
    data.blobs.emplace_back(name + "-fits", base64_of(numbers));
    std::vector<double> z;
    std::ranges::transform(curves.z, std::back_inserter(z), [](double height) { return height * um_per_mm; });
    using topography::PeakMethod;
    const bool gaussian =
        evaluation.options.peak == PeakMethod::gaussian || evaluation.options.peak == PeakMethod::gaussian_fit;
    return {{"columns", curves.columns},
            {"rows", curves.rows},
            {"z", z},
            {"every", every},
            {"values", name + "-curves"},
            {"fits", name + "-fits"},
            {"gaussian", gaussian},
            {"method", name_of(evaluation.options.peak)}};
}

struct Distribution {
    std::vector<double> shares;  // of the points, for each interval
    std::vector<double> heights; // um, exceeded on 0, 1 ... 100 % of the area
};

Distribution distribution_of(const surface::HeightMap& map, const Extent& extent) {
    Distribution result{.shares = std::vector<double>(histogram_intervals), .heights = {}};
    double points = 0;
    const double width = std::max(extent.high - extent.low, std::numeric_limits<double>::min()) / histogram_intervals;
    for (const double height : map.height.values) {
        if (std::isfinite(height)) {
            const int interval =
                std::clamp(static_cast<int>((height - extent.low) / width), 0, histogram_intervals - 1);
            result.shares[static_cast<std::size_t>(interval)] += 1;
            points += 1;
        }
    }
    for (double& share : result.shares) {
        share /= std::max(1.0, points);
    }
    const surface::MaterialRatioCurve curve(map);
    for (int percent = 0; percent <= 100; ++percent) {
        result.heights.push_back(curve.height(percent / 100.0) * um_per_mm);
    }
    return result;
}

Json distributions_data(const LevelledMaps& maps) {
    Extent extent = extent_of(maps.pair.measured.height);
    if (maps.truth) {
        const Extent truth = extent_of(maps.truth->height);
        extent.include(truth.low);
        extent.include(truth.high);
    }
    if (!extent.any()) {
        return nullptr;
    }
    Json json = {{"low", extent.low * um_per_mm}, {"high", extent.high * um_per_mm}};
    std::future<Distribution> truth;
    if (maps.truth) {
        truth = std::async(std::launch::async, [&] { return distribution_of(*maps.truth, extent); });
    }
    const auto measured = distribution_of(maps.pair.measured, extent);
    json["measured"] = {{"shares", measured.shares}, {"heights", measured.heights}};
    if (truth.valid()) {
        const auto of_truth = truth.get();
        json["truth"] = {{"shares", of_truth.shares}, {"heights", of_truth.heights}};
    }
    return json;
}

} // namespace

EvaluationData evaluation_data(const std::string& name, const Evaluation& evaluation, int count) {
    EvaluationData data;
    const auto& height = evaluation.topography.height;
    auto distributions = std::async(std::launch::async, [&] { return distributions_data(evaluation.levelled); });
    data.json = {{"name", name},
                 {"pixels",
                  {{"columns", height.columns()},
                   {"rows", height.rows()},
                   {"x0", height.x0 * um_per_mm},
                   {"y0", height.y0 * um_per_mm},
                   {"pitch", {height.pitch_x * um_per_mm, height.pitch_y * um_per_mm}}}},
                 {"map", map_data(data, name, evaluation, count)},
                 {"curves", curves_data(data, name, evaluation, count)}};
    data.json["distributions"] = distributions.get();
    return data;
}

EvaluationData frames_data(const report::Frames& frames, const std::string& unit) {
    EvaluationData data;
    std::string all;
    for (const std::string& png : frames.pngs) {
        all += report::base64(png) + "\n";
    }
    std::vector<double> z;
    std::ranges::transform(frames.z, std::back_inserter(z), [](double height) { return height * um_per_mm; });
    data.blobs.emplace_back("frames", std::move(all));
    data.json = {{"columns", frames.columns},
                 {"rows", frames.rows},
                 {"block", frames.block},
                 {"every", frames.every},
                 {"white", frames.white},
                 {"unit", unit},
                 {"z", z},
                 {"blob", "frames"}};
    return data;
}

void add_data(report::Page& page, const EvaluationData& frames, const std::vector<EvaluationData>& evaluations,
              const Json& ledger) {
    Json json = {{"frames", frames.json}, {"evaluations", Json::array()}, {"ledger", ledger}};
    for (const auto& evaluation : evaluations) {
        json["evaluations"].push_back(evaluation.json);
        for (const auto& [id, text] : evaluation.blobs) {
            page.data(id, text);
        }
    }
    for (const auto& [id, text] : frames.blobs) {
        page.data(id, text);
    }
    page.data("data", report::page_json(json));
    for (const char* file : {"d3.min.js", "d3-sankey.min.js", "three.min.js", "OrbitControls.js", "core.js", "chart.js",
                             "maps.js", "profile.js", "frames.js", "curve.js", "surface.js", "distributions.js",
                             "light.js", "timings.js", "main.js"}) {
        page.script(file);
    }
}

} // namespace vkfv::measurement
