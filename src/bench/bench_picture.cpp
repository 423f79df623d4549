#include "bench/bench.hpp"

#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::bench {

namespace {

using glm::dvec2;

constexpr dvec2 page{1140, 760};
constexpr dvec2 panel{350, 300};
constexpr dvec2 margin{30, 90};
constexpr dvec2 gap{15, 30};
using report::line_colours;
using report::with_prefix;

struct Bar {
    std::string label;
    double value;
    std::string note;
    std::size_t colour = 0;
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
                           fmt::format("fill=\"{}\"", line_colours[bars[k].colour % line_colours.size()]));
            svg_.text({corner.x + label_width + width + 5, base}, bars[k].note, "font-size=\"11\" fill=\"#222222\"");
        }
    }

    // Draws rays/s over a quantity, both logarithmic.
    void curves(const std::string& title, const std::string& quantity, const std::vector<report::Curve>& curves) {
        if (!curves.empty()) {
            const dvec2 corner = next("");
            report::draw_chart(svg_, corner, panel, title, report::axis_over(curves, 0, quantity, true),
                               report::axis_over(curves, 1, "", true), curves);
        }
    }

    std::string document(const std::string& title) const { return svg_.document(page, title); }

  private:
    // Draws the title of the next panel; returns the panel's upper left corner.
    dvec2 next(const std::string& title) {
        const dvec2 corner = margin + (panel + gap) * dvec2(place_ % 3, place_ / 3);
        ++place_;
        svg_.text(corner + dvec2(0, 14), title, "font-size=\"14\" fill=\"#111111\"");
        return corner;
    }

    report::Svg svg_;
    int place_ = 0;
};

// Curves of a list's entries, one for each value of `by` (one nameless curve if `by` is null).
std::vector<report::Curve> curves_of(const Json& list, const char* quantity, const char* by) {
    std::vector<report::Curve> result;
    for (const auto& entry : list) {
        const std::string name = by ? entry.at(by).get<std::string>() : "";
        auto found = std::ranges::find(result, name, &report::Curve::name);
        if (found == result.end()) {
            result.push_back({.name = name, .points = {}, .spreads = {}, .markers = true});
            found = result.end() - 1;
        }
        found->points.emplace_back(entry.at(quantity).get<double>(), entry.at("rays_per_second").get<double>());
        found->spreads.push_back(entry.at("spread").get<double>()); // (maximum - minimum) / median
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
                picture.curves(title, axis, curves_of(scaling.at(list), quantity, by));
            }
        };
        draw("rays", "rays", nullptr, "Rays/s over rays of an image", "rays");
        draw("triangles", "triangles", "traversal", "Rays/s over triangles of the specimen", "triangles");
        draw("pixels", "pixels_along_a_side", nullptr, "Rays/s over pixels", "pixels along a side");
    }
    return picture.document(title);
}

} // namespace vkfv::bench
