#include "app/bench.hpp"

#include "report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace vkfv::app {

namespace {

using glm::dvec2;

constexpr dvec2 page{1140, 760};
constexpr dvec2 panel{350, 300};
constexpr dvec2 margin{30, 90};
constexpr dvec2 gap{15, 30};
constexpr std::array<const char*, 4> colours = {"#1f5fa8", "#c8501e", "#2f8f4e", "#7a4fa3"};

std::string with_prefix(double value) {
    const std::array<const char*, 5> prefixes = {"", " k", " M", " G", " T"};
    std::size_t thousands = 0;
    while (value >= 999.5 && thousands + 1 < prefixes.size()) {
        value /= 1000;
        ++thousands;
    }
    return fmt::format("{:.3g}{}", value, prefixes[thousands]);
}

struct Bar {
    std::string label;
    double value;
    std::string note;
    std::size_t colour = 0;
};

struct Series {
    std::string name;
    std::vector<dvec2> points;
    std::vector<double> spreads; // (maximum - minimum) / median
};

class Picture {
  public:
    void heading(const std::string& first, const std::string& second) {
        svg_.text({margin.x, 38}, first, "font-size=\"20\" fill=\"#111111\"");
        svg_.text({margin.x, 62}, second, "font-size=\"12\" fill=\"#555555\"");
    }

    void bars(const std::string& title, const std::vector<Bar>& bars) {
        if (bars.empty()) {
            return;
        }
        const dvec2 corner = next(title);
        const double label_width = 118, number_width = 92;
        const double height = std::min(24.0, (panel.y - 34) / static_cast<double>(bars.size()));
        double most = 0;
        for (const auto& bar : bars) {
            most = std::max(most, bar.value);
        }
        for (std::size_t k = 0; k < bars.size(); ++k) {
            const double y = corner.y + 30 + height * static_cast<double>(k);
            const double width = (panel.x - label_width - number_width) * bars[k].value / most;
            const double base = y + 0.5 * height + 4;
            svg_.text({corner.x + label_width - 6, base}, bars[k].label,
                      "font-size=\"11\" text-anchor=\"end\" fill=\"#222222\"");
            svg_.rectangle({corner.x + label_width, y + 2}, {std::max(width, 0.5), height - 4},
                           fmt::format("fill=\"{}\"", colours[bars[k].colour % colours.size()]));
            svg_.text({corner.x + label_width + width + 5, base}, bars[k].note, "font-size=\"11\" fill=\"#222222\"");
        }
    }

    // Rays/s over a quantity, both in decades.
    void curve(const std::string& title, const std::string& quantity, const std::vector<Series>& series) {
        dvec2 least(1e300), most(-1e300);
        for (const auto& one : series) {
            for (const dvec2& point : one.points) {
                least = glm::min(least, point);
                most = glm::max(most, point);
            }
        }
        if (least.x > most.x) {
            return;
        }
        const dvec2 corner = next(title);
        const dvec2 from{std::floor(std::log10(least.x) + 0.05), std::floor(std::log10(least.y))};
        const dvec2 to{std::max(std::ceil(std::log10(most.x) - 0.05), from.x + 1),
                       std::max(std::ceil(std::log10(most.y)), from.y + 1)};
        const dvec2 low{corner.x + 52, corner.y + panel.y - 38}, high{corner.x + panel.x - 12, corner.y + 30};
        const auto place = [&](dvec2 point) {
            const dvec2 share = (glm::log(point) / std::log(10.0) - from) / (to - from);
            return low + share * (high - low);
        };
        for (double decade = from.x; decade <= to.x; ++decade) {
            const double x = place({std::pow(10, decade), 1}).x;
            svg_.line({x, low.y}, {x, high.y}, "stroke=\"#dddddd\"");
            svg_.text({x, low.y + 15}, with_prefix(std::pow(10, decade)),
                      "font-size=\"11\" text-anchor=\"middle\" fill=\"#444444\"");
        }
        for (double decade = from.y; decade <= to.y; ++decade) {
            const double y = place({1, std::pow(10, decade)}).y;
            svg_.line({low.x, y}, {high.x, y}, "stroke=\"#dddddd\"");
            svg_.text({low.x - 6, y + 4}, with_prefix(std::pow(10, decade)),
                      "font-size=\"11\" text-anchor=\"end\" fill=\"#444444\"");
        }
        svg_.text({0.5 * (low.x + high.x), low.y + 32}, quantity,
                  "font-size=\"11\" text-anchor=\"middle\" fill=\"#444444\"");
        for (std::size_t k = 0; k < series.size(); ++k) {
            const std::string stroke = fmt::format("stroke=\"{}\" fill=\"none\" stroke-width=\"2\"", colours[k % 4]);
            std::vector<dvec2> points;
            for (std::size_t i = 0; i < series[k].points.size(); ++i) {
                const dvec2 point = series[k].points[i];
                points.push_back(place(point));
                const double half = 0.5 * series[k].spreads[i];
                svg_.line(place({point.x, point.y * std::max(1 - half, 0.1)}), place({point.x, point.y * (1 + half)}),
                          stroke);
                svg_.rectangle(points.back() - dvec2(3), {6, 6}, fmt::format("fill=\"{}\"", colours[k % 4]));
            }
            svg_.path(points, false, stroke);
            if (series.size() > 1) {
                svg_.text({low.x + 6, low.y - 8 - 15 * static_cast<double>(series.size() - 1 - k)}, series[k].name,
                          fmt::format("font-size=\"11\" fill=\"{}\"", colours[k % 4]));
            }
        }
    }

    std::string document(const std::string& title) const { return svg_.document(page, title); }

  private:
    // The upper left corner of the next panel, with its title drawn.
    dvec2 next(const std::string& title) {
        const dvec2 corner = margin + (panel + gap) * dvec2(place_ % 3, place_ / 3);
        ++place_;
        svg_.text(corner + dvec2(0, 14), title, "font-size=\"14\" fill=\"#111111\"");
        return corner;
    }

    report::Svg svg_;
    int place_ = 0;
};

// A series for each value of `by` (one nameless series if there is none).
std::vector<Series> series_of(const Json& list, const char* quantity, const char* by) {
    std::vector<Series> result;
    for (const auto& entry : list) {
        const std::string name = by ? entry.at(by).get<std::string>() : "";
        auto found = std::ranges::find(result, name, &Series::name);
        if (found == result.end()) {
            result.push_back({name, {}, {}});
            found = result.end() - 1;
        }
        found->points.emplace_back(entry.at(quantity).get<double>(), entry.at("rays_per_second").get<double>());
        found->spreads.push_back(entry.at("spread").get<double>());
    }
    return result;
}

} // namespace

std::string bench_picture(const Json& report) {
    Picture picture;
    const auto word = [&](const char* key) { return report.at(key).get<std::string>(); };
    std::string title = "Speed of the trace";
    if (report.contains("whole")) {
        title += fmt::format(": {:.4g} s per 1E9 rays", report.at("whole").at("seconds_per_1e9_rays").get<double>());
    }
    if (report.contains("peer")) {
        title += fmt::format(", {:.2g} times an Embree tracer", report.at("peer").at("ratio").get<double>());
    }
    picture.heading(title, fmt::format("{} ({}); {} {}, {}; {}", word("device"), word("driver"), word("program"),
                                       word("commit"), word("date"), word("configuration")));
    std::vector<Bar> bars;
    if (report.contains("stages")) {
        const double seconds = report.at("stages").at("seconds_per_1e9_rays").get<double>();
        for (const auto& [name, share] : report.at("stages").at("shares").items()) {
            const double part = share.get<double>();
            bars.push_back({name, part, fmt::format("{:.3g} s, {:.0f} %", seconds * part, 100 * part)});
        }
    }
    picture.bars("Stages, s per 1E9 rays", bars);
    bars.clear();
    if (report.contains("hits")) {
        std::string last;
        std::size_t colour = 0;
        for (const auto& entry : report.at("hits")) {
            const auto traversal = entry.at("traversal").get<std::string>();
            colour += !last.empty() && traversal != last ? 1 : 0;
            last = traversal;
            const double rate = entry.at("hits_per_second").get<double>();
            bars.push_back({traversal + ", " + entry.at("order").get<std::string>(), rate, with_prefix(rate), colour});
        }
    }
    picture.bars("Rays tested against the specimen, 1/s", bars);
    bars.clear();
    if (report.contains("scaling") && report.at("scaling").contains("surfaces")) {
        for (const auto& entry : report.at("scaling").at("surfaces")) {
            const double rate = entry.at("ray_surfaces_per_second").get<double>();
            const bool glass = entry.at("splitter") == "glass";
            bars.push_back({entry.at("objective").get<std::string>() + (glass ? ", glass" : ", ideal"), rate,
                            fmt::format("{} ({})", with_prefix(rate), entry.at("surfaces").get<int>()),
                            glass ? std::size_t{0} : std::size_t{1}});
        }
    }
    picture.bars("Surfaces crossed, 1/s (surfaces), by splitter", bars);
    if (report.contains("scaling")) {
        const auto& scaling = report.at("scaling");
        const auto draw = [&](const char* list, const char* quantity, const char* by, const char* title,
                              const char* axis) {
            if (scaling.contains(list)) {
                picture.curve(title, axis, series_of(scaling.at(list), quantity, by));
            }
        };
        draw("rays", "rays", nullptr, "Rays/s over rays of an image", "rays");
        draw("triangles", "triangles", "traversal", "Rays/s over triangles of the specimen", "triangles");
        draw("pixels", "pixels_along_a_side", nullptr, "Rays/s over pixels", "pixels along a side");
    }
    return picture.document(title);
}

} // namespace vkfv::app
