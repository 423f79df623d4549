// In the picture of the instrument rays lie where the elements stand, and sizes and places are those that it says.
#include "report/layout.hpp"

#include "core/mathematics/units.hpp"
#include "optics/parts.hpp"
#include "report/room_rays.hpp"

#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace vkfv {
namespace {

using optics::InstrumentDescription;
using report::RoomRay;
using test::microscope;

struct Case {
    const char* name;
    std::function<InstrumentDescription()> describe;
};

optics::FoldMirror fold(optics::FoldMirror::Path path, double distance, double azimuth) {
    optics::FoldMirror mirror;
    mirror.path = path;
    mirror.distance = distance;
    mirror.incidence = 45 * radians_per_degree;
    mirror.azimuth = azimuth * radians_per_degree;
    mirror.semi_diameter = 15;
    return mirror;
}

std::vector<Case> cases() {
    return {
        {"demo", [] { return microscope(); }},
        {"5x", [] { return microscope("5x_0.15"); }},
        {"100x", [] { return microscope("100x_0.83"); }},
        {"plate splitter",
         [] {
             auto d = microscope();
             d.splitter.kind = optics::BeamSplitter::Kind::plate;
             d.splitter.glass = d.objective.surfaces.front().medium_after;
             d.splitter.size = 3;
             return d;
         }},
        {"cube and folds",
         [] {
             auto d = microscope();
             d.splitter.kind = optics::BeamSplitter::Kind::cube;
             d.splitter.glass = d.objective.surfaces.front().medium_after;
             d.splitter.size = 25;
             d.fold_mirrors = {fold(optics::FoldMirror::Path::imaging, 80, 0),
                               fold(optics::FoldMirror::Path::illumination, 40, 180)};
             return d;
         }},
        {"fold out of the plane",
         [] {
             auto d = microscope();
             d.fold_mirrors = {fold(optics::FoldMirror::Path::imaging, 80, 90)};
             return d;
         }},
        {"ring light",
         [] {
             auto d = microscope();
             optics::RingLightDescription ring;
             ring.distance = 40;
             ring.elevation = 35 * radians_per_degree;
             ring.width = 4;
             ring.segments = 8;
             ring.fill = 0.8;
             ring.on = {true, true, true, true, false, false, true, true};
             ring.lit_radius = 0.1;
             d.source.ring = ring;
             return d;
         }},
        {"rectangle and rings",
         [] {
             auto d = microscope();
             d.source.rectangle = glm::dvec2(1.2, 1.8);
             for (const double elevation : {0.5, 1.0}) {
                 optics::SourceDescription ring;
                 ring.ring = optics::RingLightDescription{.distance = 45,
                                                          .elevation = elevation,
                                                          .width = 4,
                                                          .segments = 1,
                                                          .fill = 1,
                                                          .on = {true},
                                                          .lit_radius = 0.1};
                 d.further_sources.push_back(ring);
             }
             return d;
         }},
        {"cover glass",
         [] {
             auto d = microscope();
             d.cover_glass = optics::CoverGlass{
                 .thickness = 1, .glass = d.objective.surfaces.front().medium_after, .distance = std::nullopt};
             return d;
         }},
        {"tilted tube lens",
         [] {
             auto d = microscope();
             d.tube_lens_placement.change.tilt_x = 3 * radians_per_degree;
             d.tube_lens_placement.change.decentre_y = 2;
             d.objective_placement.change.decentre_x = 0.1;
             return d;
         }},
        {"ideal lens",
         [] {
             auto d = microscope();
             d.objective.surfaces.assign(1, {});
             d.objective.surfaces.front().ideal_power = 1 / 20.0;
             d.objective.surfaces.front().semi_diameter = 5.6;
             d.objective.surfaces.front().role = optics::PrescribedSurface::Role::aperture_stop;
             d.objective.name = "ideal";
             return d;
         }},
    };
}

struct Shown {
    optics::Instrument instrument;
    std::vector<RoomRay> rays;
    std::string picture;
};

// Each instrument is assembled and drawn once for all tests.
const Shown& shown(const Case& one) {
    static std::map<std::string, Shown> all;
    const auto [found, is_new] = all.try_emplace(one.name);
    Shown& result = found->second;
    if (is_new) {
        result.instrument = optics::assemble(one.describe());
        result.rays = report::trace_room_rays(result.instrument);
        result.picture = report::layout_svg(result.instrument, "a <name> & more");
    }
    return result;
}

class LayoutTest : public testing::TestWithParam<Case> {
  protected:
    const Shown& shown_ = shown(GetParam());
    const optics::Instrument& instrument = shown_.instrument;
};

// ISO 10110-12's sag in another form than the tracer's.
double sag(const physics::f64::Surface& s, double r) {
    const double coefficients[] = {s.a4, s.a6, s.a8, s.a10, s.a12, s.a14, s.a16};
    double sum = 0;
    for (int k = 0; k < 7; ++k) {
        sum += coefficients[k] * std::pow(r, 4 + 2 * k);
    }
    if (s.curvature == 0) {
        return sum;
    }
    const double radius = 1 / s.curvature;
    return (s.conic == -1 ? r * r / (2 * radius)
                          : (radius - std::copysign(std::sqrt(radius * radius - (1 + s.conic) * r * r), radius)) /
                                (1 + s.conic)) +
           sum;
}

TEST_P(LayoutTest, RaysBendOnTheElements) {
    int of_illumination = 0;
    int of_imaging = 0;
    for (const auto& ray : shown_.rays) {
        const bool imaging = ray.bundle == RoomRay::Bundle::imaging_axis || ray.bundle == RoomRay::Bundle::imaging_edge;
        ++(imaging ? of_imaging : of_illumination);
        ASSERT_EQ(ray.vertices.size(), ray.elements.size());
        for (std::size_t v = 0; v < ray.vertices.size(); ++v) {
            if (ray.elements[v] == RoomRay::no_element) {
                continue;
            }
            const auto& element = instrument.elements.at(static_cast<std::size_t>(ray.elements[v]));
            const glm::dvec3 p = glm::transpose(element.pose.axes) * (ray.vertices[v] - element.pose.origin);
            // The tolerance is for rounding of coordinates of some 100 mm, many times over.
            EXPECT_NEAR(p.z, sag(element.surface, std::hypot(p.x, p.y)), 1e-9) << element.name.text();
            const bool leaves_ideal_lens = v > 0 && ray.elements[v - 1] == ray.elements[v];
            if ((element.surface.flags & physics::f64::SURFACE_CLIPPED) != 0 && !leaves_ideal_lens) {
                EXPECT_LE(p.x * p.x + p.y * p.y, element.surface.semi_diameter_squared * (1 + 1e-9))
                    << element.name.text();
            }
        }
        if (imaging) {
            EXPECT_EQ(ray.vertices.front().z, 0);
            EXPECT_EQ(ray.elements.back(), static_cast<int>(instrument.elements.size()) - 1);
        } else {
            EXPECT_NEAR(ray.vertices.back().z, 0, 1e-12);
        }
    }
    EXPECT_GE(of_imaging, 10);
    EXPECT_GE(of_illumination, 5);
}

// The sequential trains, which the images come from, are unfolded; the room's ways must end where theirs do.
TEST_P(LayoutTest, RaysEndWhereTheSequentialTrainsSay) {
    const auto& constants = instrument.constants;
    for (const auto& ray : shown_.rays) {
        const glm::dvec3 first = ray.vertices[0];
        const glm::dvec3 direction = glm::normalize(ray.vertices[1] - first);
        const physics::f64::Light light{.spectral = 0, .wave_number = 1, .survival = 0};
        physics::f64::Ray start{};
        if (ray.bundle == RoomRay::Bundle::imaging_axis || ray.bundle == RoomRay::Bundle::imaging_edge) {
            start.position = first - glm::dvec3(0, 0, instrument.front_vertex_height);
            start.direction = direction * constants.specimen_index;
            const auto result = trace_train(instrument.scene(), constants.imaging_first, constants.imaging_count, start,
                                            constants.specimen_index, 0, light);
            const auto arrived = fly_to_plane(result.ray, constants.detector_distance, result.index);
            const auto& pose = instrument.elements.back().pose;
            const glm::dvec3 drawn = glm::transpose(pose.axes) * (ray.vertices.back() - pose.origin);
            // The start's direction is known from two points some 1e-14 mm exact; 1e3 mm of lever make it 1e-9.
            EXPECT_NEAR(drawn.x, arrived.position.x, 1e-9);
            EXPECT_NEAR(drawn.y, arrived.position.y, 1e-9);
            continue;
        }
        const bool ring = ray.bundle == RoomRay::Bundle::ring_light;
        if (ring && instrument.elements.front().part != optics::Part::cover_glass) {
            continue; // a straight line
        }
        const auto& pose = instrument.source_pose;
        start.position =
            ring ? glm::dvec3(first.x, -first.y, -first.z + constants.ring.aim_distance)
                 : glm::transpose(pose.axes) * (first - pose.origin) - glm::dvec3(0, 0, constants.source_distance);
        start.direction =
            ring ? glm::dvec3(direction.x, -direction.y, -direction.z) : glm::transpose(pose.axes) * direction;
        const auto result = trace_train(instrument.scene(), constants.illumination_first, constants.illumination_count,
                                        start, 1, 0, light);
        const auto arrived = fly_to_plane(result.ray, instrument.front_vertex_height, result.index);
        EXPECT_NEAR(ray.vertices.back().x, arrived.position.x, 1e-9);
        EXPECT_NEAR(ray.vertices.back().y, -arrived.position.y, 1e-9);
    }
}

// All points of every path, line, rectangle and text, in user units.
std::vector<glm::dvec2> points_of(const pugi::xml_node& node) {
    std::vector<glm::dvec2> points;
    for (const auto& found : node.select_nodes(".//path[not(ancestor::g[@clip-path])]")) {
        std::string data = found.node().attribute("d").value();
        for (char& c : data) {
            c = std::strchr("MLZ", c) != nullptr ? ' ' : c;
        }
        std::istringstream stream(data);
        for (glm::dvec2 point; stream >> point.x >> point.y;) {
            points.push_back(point);
        }
    }
    for (const auto& found : node.select_nodes(".//text|.//rect")) {
        const auto n = found.node();
        points.emplace_back(n.attribute("x").as_double(), n.attribute("y").as_double());
        points.push_back(points.back() +
                         glm::dvec2(n.attribute("width").as_double(), n.attribute("height").as_double()));
    }
    for (const auto& found : node.select_nodes(".//line")) {
        const auto n = found.node();
        points.emplace_back(n.attribute("x1").as_double(), n.attribute("y1").as_double());
        points.emplace_back(n.attribute("x2").as_double(), n.attribute("y2").as_double());
    }
    return points;
}

TEST_P(LayoutTest, IsAPictureThatHoldsAllItShows) {
    const std::string& text = shown_.picture;
    EXPECT_LT(text.size(), 300'000u);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(text.c_str()));
    const auto svg = document.child("svg");
    EXPECT_NE(std::string(svg.child("title").text().get()).find("a <name> & more: "), std::string::npos);
    glm::dvec2 corner, size;
    std::istringstream(svg.attribute("viewBox").value()) >> corner.x >> corner.y >> size.x >> size.y;
    ASSERT_GT(size.x, 0);
    const auto points = points_of(svg);
    EXPECT_GT(points.size(), 200u);
    for (const auto& point : points) {
        EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y));
        EXPECT_GE(point.x, corner.x);
        EXPECT_GE(point.y, corner.y);
        EXPECT_LE(point.x, corner.x + size.x);
        EXPECT_LE(point.y, corner.y + size.y);
    }
}

// Leaders end at the elements that they name, and text does not cover text.
TEST_P(LayoutTest, LabelsKeepApart) {
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(shown_.picture.c_str()));
    struct Rectangle {
        double left, right, top, bottom;
        std::string text;
    };
    std::vector<Rectangle> labels;
    for (const auto& found : document.select_nodes("//text[@class='label']")) {
        const auto n = found.node();
        const std::string content = n.text().get();
        const double size = n.attribute("font-size").as_double();
        const double width = 0.5 * size * static_cast<double>(content.size());
        const double x = n.attribute("x").as_double();
        const double y = n.attribute("y").as_double();
        const std::string anchor = n.attribute("text-anchor").value();
        const double left = anchor == "end" ? x - width : anchor == "middle" ? x - 0.5 * width : x;
        labels.push_back({left, left + width, y - 0.7 * size, y, content});
    }
    ASSERT_GE(labels.size(), 10u);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        for (std::size_t k = i + 1; k < labels.size(); ++k) {
            const auto& a = labels[i];
            const auto& b = labels[k];
            EXPECT_FALSE(a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)
                << a.text << " / " << b.text;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Instruments, LayoutTest, testing::ValuesIn(cases()), [](const auto& info) {
    std::string name = info.param.name;
    std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
    return name;
});

glm::dvec4 line_of(const pugi::xml_node& node) {
    return {node.attribute("x1").as_double(), node.attribute("y1").as_double(), node.attribute("x2").as_double(),
            node.attribute("y2").as_double()};
}

glm::dvec4 two_points(const pugi::xml_node& path) {
    glm::dvec4 result(NAN);
    std::sscanf(path.attribute("d").value(), "M%lf %lfL%lf %lf", &result.x, &result.y, &result.z, &result.w);
    return result;
}

TEST(Layout, IsTheSameTwice) {
    const auto instrument = optics::assemble(microscope());
    EXPECT_EQ(report::layout_svg(instrument, "name"), report::layout_svg(instrument, "name"));
    EXPECT_NE(report::layout_svg(instrument, "name"), report::layout_svg(instrument, "other"));
}

// Lengths are measured with the picture's own scale bar, as a reader would.
TEST(Layout, IsToScale) {
    const auto instrument = optics::assemble(microscope());
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(report::layout_svg(instrument, "demo").c_str()));
    for (const auto& [group, bar_id] : {std::pair("microscope", "scale-bar"), std::pair("inset", "inset-scale-bar")}) {
        const auto bar_node = document.select_node(("//line[@id='" + std::string(bar_id) + "']").c_str()).node();
        ASSERT_TRUE(bar_node);
        const auto bar = line_of(bar_node);
        const double millimetres = std::stod(bar_node.next_sibling("text").text().get());
        const double scale = (bar.z - bar.x) / millimetres;
        const std::string in_group = "//g[@id='" + std::string(group) + "']";
        // Coordinates are rounded to 0.01.
        const auto field = two_points(document.select_node((in_group + "//path[@class='field']").c_str()).node());
        EXPECT_NEAR(field.z - field.x, scale * 2 * instrument.first_order.field_edge, 0.011 + 1e-4 * scale);
        if (std::string(group) == "microscope") {
            const auto sensor =
                two_points(document.select_node((in_group + "//path[@class='detector']").c_str()).node());
            EXPECT_NEAR(std::abs(sensor.z - sensor.x), scale * 1.3, 0.02);
            const double height = instrument.elements.back().pose.origin.z;
            EXPECT_GT(height, 300);
            // The bar's own rounding counts in proportion.
            EXPECT_NEAR(field.y - sensor.y, scale * height, 0.02 * height / millimetres + 0.02);
            const auto source = two_points(document.select_node((in_group + "//path[@class='source']").c_str()).node());
            EXPECT_NEAR(std::abs(source.w - source.y), scale * 2 * 0.96, 0.02);
            EXPECT_NEAR(source.x - 0.5 * (field.x + field.z), scale * instrument.source_pose.origin.y,
                        0.02 * instrument.source_pose.origin.y / millimetres + 0.02);
        }
    }
}

// On the axis a point is imaged to a point, so all its rays meet at the detector; Koehler's light from one point of the
// source is parallel on the specimen, and from all of the source as wide.
TEST(Layout, RaysShowTheImageAndKoehlersIllumination) {
    const auto instrument = optics::assemble(microscope());
    double margin = 0;
    double slopes[2] = {INFINITY, -INFINITY};
    for (const auto& ray : report::trace_room_rays(instrument)) {
        if (ray.bundle == RoomRay::Bundle::imaging_axis) {
            // At the least RMS focus the margin's ray is off by some micrometres times the magnification.
            EXPECT_NEAR(ray.vertices.back().y, 0, 0.05);
            const auto direction = glm::normalize(ray.vertices[1] - ray.vertices[0]);
            margin = std::max(margin, direction.y);
        } else if (ray.bundle == RoomRay::Bundle::illumination_centre) {
            const auto last = ray.vertices.end()[-1] - ray.vertices.end()[-2];
            slopes[0] = std::min(slopes[0], last.y / last.z);
            slopes[1] = std::max(slopes[1], last.y / last.z);
        }
    }
    EXPECT_NEAR(margin, instrument.first_order.numerical_aperture, 1e-3);
    EXPECT_LT(slopes[1] - slopes[0], 0.02);
}

} // namespace
} // namespace vkfv
