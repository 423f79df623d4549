#include "report/layout.hpp"

#include "core/units.hpp"
#include "report/room_rays.hpp"
#include "report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace vkfv::report {

namespace {

using glm::dvec2;
using glm::dvec3;
using optics::Element;
using Kind = Element::Kind;

// Pixels.
constexpr double label_size = 13;
constexpr double label_spacing = 17;
constexpr double title_size = 17;
constexpr double label_room = 37; // over what a label stands over
constexpr double margin = 24;
constexpr double largest_height = 820;
constexpr double largest_width = 820;

// Okabe and Ito's colours, which colour-blind people tell apart.
constexpr const char* ink = "#222222";
constexpr const char* grey = "#8a8a8a";
struct BundleStyle {
    RoomRay::Bundle bundle;
    const char* colour;
    const char* meaning;
};
constexpr std::array<BundleStyle, 4> bundle_styles = {{
    {RoomRay::Bundle::illumination_rim, "#009e73", "illumination, rim of the source"},
    {RoomRay::Bundle::illumination_centre, "#e69f00", "illumination, middle of the source"},
    {RoomRay::Bundle::imaging_edge, "#d55e00", "imaging, edge of the field"},
    {RoomRay::Bundle::imaging_axis, "#0072b2", "imaging, middle of the field"},
}};

struct Box {
    dvec2 lower{std::numeric_limits<double>::infinity()};
    dvec2 upper{-std::numeric_limits<double>::infinity()};

    void add(dvec2 point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const Box& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    dvec2 size() const { return upper - lower; }
    dvec2 middle() const { return 0.5 * (lower + upper); }
    bool empty() const { return !(lower.x <= upper.x); }
    Box grown(double by) const { return {lower - by, upper + by}; }
    bool meets(const Box& other) const {
        return glm::all(glm::lessThan(lower, other.upper)) && glm::all(glm::lessThan(other.lower, upper));
    }
};

// In mm, of the plane of drawing: (y, z).
struct Shape {
    std::vector<dvec2> points;
    bool closed = false;
    std::string attributes;
};

struct Label {
    // Beside the picture, with a leader; over the parts of a level arm; on the back of a mirror; along a bracket.
    enum class Place { beside, over, behind, bracket } place = Place::beside;
    std::string text;
    Box part;       // mm
    dvec2 normal{}; // of a mirror, to its back
};

// Where a picture of the plane of drawing lies on the page.
struct View {
    double scale = 1; // px per mm
    dvec2 origin{};   // px, of y = z = 0
    dvec2 operator()(dvec2 p) const { return {origin.x + scale * p.x, origin.y - scale * p.y}; }
    Box operator()(const Box& box) const {
        Box result;
        result.add((*this)(box.lower));
        result.add((*this)(box.upper));
        return result;
    }
};

dvec2 flat(dvec3 point) {
    return {point.y, point.z};
}

// Helvetica's mean advance; wide enough to keep labels apart.
double width_of(const std::string& text, double size = label_size) {
    return 0.56 * size * static_cast<double>(text.size());
}

// Positions as near as possible to those wished for (ascending), each at least `spacing` behind the one before:
// isotonic regression by pooling adjacent violators.
std::vector<double> spread(const std::vector<double>& wished, const std::vector<double>& spacing) {
    struct Pool {
        double sum;
        std::size_t count;
        double mean() const { return sum / static_cast<double>(count); }
    };
    std::vector<Pool> pools;
    double offset = 0;
    std::vector<double> offsets;
    for (std::size_t i = 0; i < wished.size(); ++i) {
        offset += i > 0 ? spacing[i] : 0;
        offsets.push_back(offset);
        pools.push_back({wished[i] - offset, 1});
        while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
            pools[pools.size() - 2].sum += pools.back().sum;
            pools[pools.size() - 2].count += pools.back().count;
            pools.pop_back();
        }
    }
    std::vector<double> result;
    for (const Pool& pool : pools) {
        for (std::size_t k = 0; k < pool.count; ++k) {
            result.push_back(pool.mean() + offsets[result.size()]);
        }
    }
    return result;
}

bool has_role(const Element& element, const char* role) {
    return element.name.ends_with(role);
}

// The prescription's name without the number of its surface.
std::string prescription_of(const Element& element) {
    return element.name.substr(0, element.name.rfind(' ', element.name.find(',') - 1));
}

bool is_limited(const Element& element) {
    return (element.surface.flags & physics::f64::SURFACE_CLIPPED) != 0;
}

// The instrument as shapes and labels.
class Drawing {
  public:
    explicit Drawing(const optics::Instrument& instrument)
        : instrument_(instrument), elements_(instrument.elements), rays_(trace_room_rays(instrument)) {
        measure();
        if (is_ring()) {
            add_ring();
        }
        add_housings();
        add_camera();
        add_immersion();
        add_lenses();
        add_rays();
        add_flat_elements();
        add_specimen();
        add_detector();
        if (!is_ring()) {
            add_source();
        }
        label_parts();
    }

    const std::vector<Shape>& shapes() const { return shapes_; }
    const std::vector<Label>& labels() const { return labels_; }
    bool is_ring() const { return (instrument_.features & physics::f64::FEATURE_RING) != 0; }
    bool has(RoomRay::Bundle bundle) const { return std::ranges::find(rays_, bundle, &RoomRay::bundle) != rays_.end(); }

    Box bounds() const {
        Box box;
        for (const Shape& shape : shapes_) {
            for (const dvec2& point : shape.points) {
                box.add(point);
            }
        }
        return box;
    }

    // The specimen and all that follows up to the objective's back.
    Box objective_region() const {
        Box box = part_box("objective");
        box.add(part_box("cover glass"));
        const double half = 0.5 * box.size().x;
        box.add(dvec2(-half, 0));
        box.add(dvec2(half, -slab_thickness_));
        return box;
    }
    std::vector<Label> objective_labels() const {
        std::vector<Label> chosen;
        for (const Label& label : labels_) {
            if (label.text.starts_with("objective") || label.text == "cover glass" || label.text == "specimen" ||
                label.text == "aperture stop") {
                chosen.push_back(label);
            }
        }
        return chosen;
    }

  private:
    void add(std::vector<dvec2> points, bool closed, std::string attributes) {
        shapes_.push_back({std::move(points), closed, std::move(attributes)});
    }

    // The direction across an element's axis in the plane of drawing; none: it is seen along its axis.
    static std::optional<dvec3> across(const optics::Pose& pose) {
        const dvec3 direction = glm::cross(dvec3(1, 0, 0), pose.axes[2]);
        const double length = glm::length(direction);
        constexpr double least = 0.5; // sine of 30 degrees
        return length < least ? std::nullopt : std::optional(direction / length);
    }

    // Across the axis and along it.
    static dvec2 at(const optics::Pose& pose, double radius, double height) {
        return flat(pose.origin + across(pose).value_or(dvec3(0, 1, 0)) * radius + pose.axes[2] * height);
    }

    double sag(std::size_t i, double radius) const {
        return physics::f64::asphere_sag(elements_[i].surface, radius * radius).sag;
    }

    dvec2 on_surface(std::size_t i, double radius) const {
        return at(elements_[i].pose, radius, sag(i, std::clamp(radius, -radii_[i], radii_[i])));
    }

    std::vector<dvec2> profile(std::size_t i, double from, double to) const {
        const bool plane =
            elements_[i].surface.curvature == 0 && (elements_[i].surface.flags & physics::f64::SURFACE_ASPHERIC) == 0;
        const int pieces = plane ? 1 : 28;
        std::vector<dvec2> points;
        for (int k = 0; k <= pieces; ++k) {
            points.push_back(on_surface(i, from + (to - from) * k / pieces));
        }
        return points;
    }

    std::vector<dvec2> rim(const optics::Pose& pose, double radius) const {
        std::vector<dvec2> points;
        constexpr int pieces = 48;
        for (int k = 0; k < pieces; ++k) {
            const double angle = 2 * pi * k / pieces;
            points.push_back(flat(pose.point({radius * std::cos(angle), radius * std::sin(angle), 0})));
        }
        return points;
    }

    // Semi-diameters; what has none is as large as the light needs.
    void measure() {
        std::vector<double> lit(elements_.size(), 0);
        backs_.assign(elements_.size(), 1);
        for (const RoomRay& ray : rays_) {
            for (std::size_t v = 0; v < ray.vertices.size(); ++v) {
                if (ray.elements[v] != RoomRay::no_element) {
                    const auto i = static_cast<std::size_t>(ray.elements[v]);
                    const dvec3 inside =
                        glm::transpose(elements_[i].pose.axes) * (ray.vertices[v] - elements_[i].pose.origin);
                    lit[i] = std::max(lit[i], std::hypot(inside.x, inside.y));
                    backs_[i] = glm::dot(ray.vertices[v] - ray.vertices[v - 1], elements_[i].pose.axes[2]) < 0 ? -1 : 1;
                }
            }
        }
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            const auto& surface = elements_[i].surface;
            constexpr double spare = 1.25;
            const double equator = std::sqrt(std::max(0.0, 1 + surface.conic)) * std::abs(surface.curvature);
            double radius = is_limited(elements_[i]) ? std::sqrt(surface.semi_diameter_squared) : spare * lit[i];
            if (elements_[i].kind == Kind::detector) {
                radius = instrument_.constants.detector_half_size;
            }
            radii_.push_back(equator > 0 ? std::min(radius, 0.999 / equator) : radius);
        }
        extent_ = 0;
        for (const Element& element : elements_) {
            extent_ = std::max(extent_, glm::length(flat(element.pose.origin)));
        }
        slab_thickness_ = 0.012 * extent_;
    }

    Box part_box(const std::string& part) const {
        Box box;
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            if (elements_[i].part == part) {
                box.add(on_surface(i, -radii_[i]));
                box.add(on_surface(i, 0));
                box.add(on_surface(i, radii_[i]));
            }
        }
        return box;
    }

    double part_radius(const std::string& part) const {
        double radius = 0;
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            radius = std::max(radius, elements_[i].part == part ? radii_[i] : 0.0);
        }
        return radius;
    }

    // Tubes about objective and tube lens: as wide as the widest lens, the objective's nose tapered.
    void add_housings() {
        constexpr const char* look = "fill=\"#f0f0f0\" stroke=\"#cfcfcf\" stroke-width=\"0.8\"";
        for (const std::string part : {"objective", "tube lens"}) {
            std::size_t first = elements_.size();
            std::size_t last = 0;
            std::size_t widest = 0;
            for (std::size_t i = 0; i < elements_.size(); ++i) {
                if (elements_[i].part == part) {
                    widest = first == elements_.size() || radii_[i] > radii_[widest] * 1.001 ? i : widest;
                    first = std::min(first, i);
                    last = i;
                }
            }
            if (first == last || first == elements_.size() || !across(elements_[first].pose)) {
                continue;
            }
            const double wall = 0.15 * radii_[widest];
            const double radius = radii_[widest] + wall;
            const bool is_objective = part == "objective";
            const double nose = is_objective ? radii_[first] + wall : radius;
            const auto& front = elements_[first].pose;
            const auto& back = elements_[last].pose;
            const double before = std::min(sag(first, radii_[first]), 0.0) - 0.5 * wall;
            const double behind = std::max(sag(last, radii_[last]), 0.0) + wall;
            const auto& shoulder = elements_[widest].pose;
            std::vector<dvec2> outline = {at(front, -nose, before)};
            if (is_objective && nose < radius) {
                outline.push_back(at(shoulder, -radius, 0));
            }
            outline.insert(outline.end(), {at(back, -radius, behind), at(back, radius, behind)});
            if (is_objective && nose < radius) {
                outline.push_back(at(shoulder, radius, 0));
            }
            outline.push_back(at(front, nose, before));
            add(std::move(outline), true, look);
        }
    }

    // The camera's body, open to the light.
    void add_camera() {
        const auto& pose = elements_.back().pose;
        if (!across(pose)) {
            return;
        }
        const double wide = std::max(1.5 * radii_.back(), 0.035 * extent_);
        const double gap = 0.012 * extent_;
        const double deep = 0.05 * extent_;
        add({at(pose, -wide, -gap), at(pose, -wide, deep), at(pose, wide, deep), at(pose, wide, -gap)}, false,
            fmt::format("fill=\"#f0f0f0\" stroke=\"{}\" stroke-width=\"1.2\" stroke-linejoin=\"round\"", grey));
        for (const dvec2& point : shapes_.back().points) {
            detector_.add(point);
        }
    }

    static std::string glass(double index) {
        // From crown to heavy flint.
        const double depth = std::clamp((index - 1.4) / 0.5, 0.0, 1.0);
        const auto mixed = [&](double light, double dark) {
            return static_cast<int>(std::lround(light + depth * (dark - light)));
        };
        return fmt::format("#{:02x}{:02x}{:02x}", mixed(222, 128), mixed(239, 176), mixed(249, 214));
    }

    void add_immersion() {
        const double index = instrument_.constants.specimen_index;
        const Box objective = part_box("objective");
        if (index < 1.1 || objective.empty()) {
            return;
        }
        std::size_t front = 0;
        while (elements_[front].part != "objective") {
            ++front;
        }
        const double half = radii_[front];
        add({{-half, 0}, {half, 0}, on_surface(front, half), on_surface(front, -half)}, true,
            fmt::format("fill=\"{}\" fill-opacity=\"0.6\"", glass(index)));
    }

    // The cube's faces stand around its coating; a plate has none in front.
    std::optional<std::size_t> cube_coating() const {
        for (std::size_t i = 1; i + 1 < elements_.size(); ++i) {
            if (elements_[i].kind == Kind::splitter && elements_[i - 1].part == "beam splitter" &&
                elements_[i - 1].surface.index_after > 1 && elements_[i + 1].part == "beam splitter") {
                return i;
            }
        }
        return std::nullopt;
    }

    void add_lenses() {
        constexpr const char* edge = "stroke=\"#40627a\" stroke-width=\"0.9\" stroke-linejoin=\"round\"";
        const auto coating = cube_coating();
        if (coating) {
            const auto& front = elements_[*coating - 1].pose;
            const double size = glm::length(elements_[*coating + 1].pose.origin - front.origin);
            add({at(front, -0.5 * size, 0), at(front, 0.5 * size, 0), at(front, 0.5 * size, size),
                 at(front, -0.5 * size, size)},
                true, fmt::format("fill=\"{}\" {}", glass(elements_[*coating].surface.index_before), edge));
        }
        for (std::size_t i = 0; i + 1 < elements_.size(); ++i) {
            const bool is_glass = elements_[i].part == elements_[i + 1].part && elements_[i].surface.index_after > 1 &&
                                  elements_[i].surface.index_after == elements_[i + 1].surface.index_before;
            const bool in_cube = coating && elements_[i].part == "beam splitter";
            if (!is_glass || in_cube) {
                continue;
            }
            const std::string attributes = fmt::format("fill=\"{}\" {}", glass(elements_[i].surface.index_after), edge);
            if (!across(elements_[i].pose)) {
                add(rim(elements_[i].pose, radii_[i]), true, attributes);
                continue;
            }
            // Ground to one diameter: each surface goes on flat to the wider one's rim.
            const double radius = std::max(radii_[i], radii_[i + 1]);
            std::vector<dvec2> outline = profile(i, -radii_[i], radii_[i]);
            if (radii_[i] < radius) {
                outline.insert(outline.begin(), on_surface(i, -radius));
                outline.push_back(on_surface(i, radius));
            }
            if (radii_[i + 1] < radius) {
                outline.push_back(on_surface(i + 1, radius));
            }
            const auto second = profile(i + 1, radii_[i + 1], -radii_[i + 1]);
            outline.insert(outline.end(), second.begin(), second.end());
            if (radii_[i + 1] < radius) {
                outline.push_back(on_surface(i + 1, -radius));
            }
            add(std::move(outline), true, attributes);
        }
    }

    void add_rays() {
        for (const BundleStyle& style : bundle_styles) {
            for (const RoomRay& ray : rays_) {
                if (ray.bundle == style.bundle) {
                    std::vector<dvec2> points;
                    for (const dvec3& vertex : ray.vertices) {
                        points.push_back(flat(vertex));
                    }
                    add(std::move(points), false,
                        fmt::format("class=\"ray\" stroke=\"{}\" stroke-width=\"0.8\" stroke-opacity=\"0.85\"",
                                    style.colour));
                }
            }
        }
    }

    void add_bars(std::size_t i, double outer, double width) {
        for (const double side : {-1.0, 1.0}) {
            const double height = sag(i, radii_[i]);
            add({at(elements_[i].pose, side * radii_[i], height), at(elements_[i].pose, side * outer, height)}, false,
                fmt::format("stroke=\"{}\" stroke-width=\"{}\"", ink, width));
        }
    }

    // Stops, mirrors, the splitter and ideal lenses.
    void add_flat_elements() {
        const auto coating = cube_coating();
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            const Element& element = elements_[i];
            const auto& pose = element.pose;
            const double radius = radii_[i];
            const bool limits = has_role(element, "aperture stop") || has_role(element, "field stop");
            if (is_limited(element) && (limits || element.kind == Kind::stop) && across(pose)) {
                add_bars(i, std::max(1.12 * part_radius(element.part), radius + 0.004 * extent_), limits ? 2.6 : 1.4);
            }
            if (element.kind == Kind::splitter) {
                const double half = coating
                                        ? std::min(radius, std::sqrt(0.5) * glm::length(elements_[i + 1].pose.origin -
                                                                                        elements_[i - 1].pose.origin))
                                        : radius;
                add({at(pose, -half, 0), at(pose, half, 0)}, false, "stroke=\"#7a3e9d\" stroke-width=\"2\"");
            }
            if (element.kind == Kind::mirror) {
                if (!across(pose)) {
                    add(rim(pose, radius), true,
                        fmt::format("fill=\"#e4e4e4\" stroke=\"{}\" stroke-width=\"1.6\"", ink));
                    continue;
                }
                add({at(pose, -radius, 0), at(pose, radius, 0)}, false,
                    fmt::format("stroke=\"{}\" stroke-width=\"2\"", ink));
                const double hatch = std::max(0.12 * radius, 0.006 * extent_);
                const int hatches = std::clamp(static_cast<int>(2 * radius / hatch), 4, 40);
                for (int k = 0; k < hatches; ++k) {
                    const double r = radius * (2.0 * (k + 0.5) / hatches - 1);
                    add({at(pose, r, 0), at(pose, r - hatch, backs_[i] * hatch)}, false,
                        fmt::format("stroke=\"{}\" stroke-width=\"0.8\"", grey));
                }
            }
            if (element.kind == Kind::ideal_lens) {
                add({at(pose, -radius, 0), at(pose, radius, 0)}, false, "stroke=\"#40627a\" stroke-width=\"1.8\"");
                const double head = std::min(0.2 * radius, 0.015 * extent_);
                const double back = element.surface.power > 0 ? -head : head;
                for (const double side : {-1.0, 1.0}) {
                    add({at(pose, side * (radius + back), -head), at(pose, side * radius, 0),
                         at(pose, side * (radius + back), head)},
                        false, "stroke=\"#40627a\" stroke-width=\"1.8\"");
                }
            }
        }
    }

    void add_specimen() {
        const double half = std::max(1.3 * part_radius("objective"), 0.02 * extent_);
        add({{-half, 0}, {half, 0}, {half, -slab_thickness_}, {-half, -slab_thickness_}}, true,
            "fill=\"#d9cdb8\" stroke=\"#7d6b4a\" stroke-width=\"0.9\"");
        const double field = instrument_.first_order.field_edge;
        add({{-field, 0}, {field, 0}}, false, "class=\"field\" stroke=\"#a3123a\" stroke-width=\"3\"");
        specimen_.add(dvec2(-half, -slab_thickness_));
        specimen_.add(dvec2(half, 0));
    }

    void add_detector() {
        const Element& detector = elements_.back();
        const double half = instrument_.constants.detector_half_size;
        if (!across(detector.pose)) {
            return;
        }
        add({at(detector.pose, -half, 0), at(detector.pose, half, 0)}, false,
            fmt::format("class=\"detector\" stroke=\"{}\" stroke-width=\"4\"", ink));
    }

    // The band where the plane of drawing cuts it, on both sides, lit where the segment there is.
    void add_ring() {
        const auto& ring = instrument_.constants.ring;
        const double depth = 0.012 * extent_; // of its body, behind the band
        for (const double side : {-1.0, 1.0}) {
            const double turns = side > 0 ? 0.25 : 0.75;
            const int segment = static_cast<int>(turns * ring.segments);
            const bool on = (ring.switched_on >> segment & 1u) != 0;
            const dvec2 outward(side * ring.elevation_cosine, ring.elevation_sine);
            const dvec2 across(-side * ring.elevation_sine, ring.elevation_cosine);
            const dvec2 middle = ring.distance * outward;
            const dvec2 inner = middle + ring.half_width * across;
            const dvec2 outer = middle - ring.half_width * across;
            add({inner, outer, outer + depth * outward, inner + depth * outward}, true,
                on ? lit_look : "fill=\"#e4e4e4\" stroke=\"#8a8a8a\" stroke-width=\"0.8\"");
            for (const dvec2& point : shapes_.back().points) {
                source_.add(point);
            }
        }
    }

    void add_source() {
        const auto& pose = instrument_.source_pose;
        const double radius = instrument_.constants.source_radius;
        if (!across(pose)) {
            add(rim(pose, radius), true, lit_look);
            return;
        }
        const double wide = std::max(1.5 * radius, 0.012 * extent_);
        add({at(pose, -wide, 0), at(pose, wide, 0), at(pose, wide, -wide), at(pose, -wide, -wide)}, true,
            "fill=\"#f0f0f0\" stroke=\"#8a8a8a\" stroke-width=\"1\"");
        for (const dvec2& point : shapes_.back().points) {
            source_.add(point);
        }
        add({at(pose, -radius, 0), at(pose, radius, 0)}, false,
            "class=\"source\" stroke=\"#e6ac00\" stroke-width=\"4\"");
    }

    static constexpr const char* lit_look = "fill=\"#f0c929\" stroke=\"#8a6d00\" stroke-width=\"0.8\"";

    static bool is_upright(const optics::Pose& pose) { return std::abs(pose.axes[2].z) >= std::abs(pose.axes[2].y); }

    void label(std::string text, const Box& part, bool upright) {
        labels_.push_back({upright ? Label::Place::beside : Label::Place::over, std::move(text), part});
    }

    void label_parts() {
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            const Element& element = elements_[i];
            Box own;
            own.add(on_surface(i, -radii_[i]));
            own.add(on_surface(i, radii_[i]));
            const bool upright = is_upright(element.pose);
            const bool starts = i == 0 || elements_[i - 1].part != element.part;
            if (starts && (element.part == "objective" || element.part == "tube lens")) {
                label(element.part + " " + prescription_of(element), part_box(element.part), upright);
            } else if (starts && element.part == "cover glass") {
                label(element.part, part_box(element.part), upright);
            } else if (starts && element.part == "illuminator") {
                const std::size_t lens = element.name == "illumination aperture" ? i + 1 : i;
                labels_.push_back(
                    {Label::Place::bracket, "illuminator " + prescription_of(elements_[lens]), part_box(element.part)});
            } else if (element.kind == Kind::mirror) {
                labels_.push_back({Label::Place::behind, "fold mirror", own, flat(element.pose.axes[2]) * backs_[i]});
            } else if (element.kind == Kind::splitter) {
                Box end;
                end.add(on_surface(i, 0.8 * radii_[i])); // the lower one
                label("beam splitter", cube_coating() ? part_box("beam splitter") : end, true);
            }
            for (const char* stop : {"aperture stop", "field stop", "illumination aperture"}) {
                if (has_role(element, stop) && is_limited(element)) {
                    label(stop, own, upright);
                }
            }
        }
        label("specimen", specimen_, true);
        label("detector", detector_, is_upright(elements_.back().pose));
        label(is_ring() ? "ring light" : "source", source_, is_ring() || is_upright(instrument_.source_pose));
        std::erase_if(labels_, [](const Label& label) { return label.part.empty(); });
    }

    const optics::Instrument& instrument_;
    const std::vector<Element>& elements_;
    std::vector<RoomRay> rays_;
    std::vector<double> radii_; // mm, of the elements
    std::vector<double> backs_; // of mirrors: 1 where light comes towards their z, else -1
    double extent_ = 0;         // mm, of the instrument: what housings are measured by
    double slab_thickness_ = 0;
    std::vector<Shape> shapes_;
    std::vector<Label> labels_;
    Box specimen_, detector_, source_;
};

// 1, 2 or 5 times a power of ten, the largest that is not more.
double round_length(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

class Page {
  public:
    Page(const optics::Instrument& instrument, const std::string& name)
        : instrument_(instrument), drawing_(instrument), title_(title_of(instrument, name)) {}

    std::string document() {
        place_main();
        svg_.text({margin, margin + title_size}, title_,
                  fmt::format("font-size=\"{}\" font-weight=\"bold\" fill=\"{}\"", title_size, ink));
        used_.add(dvec2(margin + width_of(title_, title_size), margin));
        svg_.open_group("id=\"microscope\"");
        draw_shapes(main_, std::nullopt);
        draw_labels(main_, drawing_.labels(), content_, false);
        svg_.close_group();
        const double bottom = used_.upper.y + 2 * label_spacing;
        draw_scale_bar("scale-bar", {margin, bottom}, main_.scale);
        draw_inset();
        draw_legend(std::max(bottom, used_.upper.y));
        const dvec2 size = glm::ceil(used_.upper + margin);
        return svg_.document(size, title_);
    }

  private:
    static std::string title_of(const optics::Instrument& instrument, const std::string& name) {
        const auto& first_order = instrument.first_order;
        return fmt::format("{}: {:.3g}x, NA {:.3g}, {:.4g} nm, working distance {:.3g} mm", name,
                           std::abs(first_order.magnification), first_order.numerical_aperture,
                           1e3 / std::sqrt(instrument.constants.spectrum_centre), first_order.working_distance);
    }

    bool on_left(const Label& label) const { return main_(label.part).middle().x <= content_.middle().x; }

    void place_main() {
        const Box bounds = drawing_.bounds();
        main_.scale = std::min(largest_height / bounds.size().y, largest_width / bounds.size().x);
        double left = 0;
        double over = 0;
        for (const Label& label : drawing_.labels()) {
            const bool at_top =
                label.place != Label::Place::beside && main_.scale * (bounds.upper.y - label.part.upper.y) < label_room;
            over = at_top ? label_room : over;
            left = std::max(left, label.place == Label::Place::beside ? width_of(label.text) : 0.0);
        }
        const dvec2 corner(margin + left + 46, 2 * margin + title_size + over);
        main_.origin = {corner.x - main_.scale * bounds.lower.x, corner.y + main_.scale * bounds.upper.y};
        content_ = main_(bounds);
        occupied_.clear();
        used_.add(content_);
    }

    void draw_shapes(const View& view, const std::optional<Box>& only) {
        svg_.open_group("fill=\"none\"");
        for (const Shape& shape : drawing_.shapes()) {
            std::vector<dvec2> points;
            Box box;
            for (const dvec2& point : shape.points) {
                points.push_back(view(point));
                box.add(points.back());
            }
            if (only && !box.grown(1).meets(*only)) {
                continue;
            }
            svg_.path(points, shape.closed, shape.attributes);
            if (!only) {
                occupy(points);
            }
        }
        svg_.close_group();
    }

    void occupy(const std::vector<dvec2>& points) {
        constexpr double piece = 8; // px
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const int pieces = static_cast<int>(std::ceil(glm::length(points[i + 1] - points[i]) / piece)) + 1;
            for (int k = 0; k < pieces; ++k) {
                Box box;
                box.add(glm::mix(points[i], points[i + 1], static_cast<double>(k) / pieces));
                box.add(glm::mix(points[i], points[i + 1], static_cast<double>(k + 1) / pieces));
                occupied_.push_back(box.grown(1));
            }
        }
    }

    void write_label(dvec2 at, const std::string& text, const char* anchor) {
        svg_.text(
            at, text,
            fmt::format("class=\"label\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"", label_size, anchor, ink));
        const double width = width_of(text);
        const double left = anchor == std::string("end")      ? at.x - width
                            : anchor == std::string("middle") ? at.x - 0.5 * width
                                                              : at.x;
        const Box box{{left, at.y - label_size}, {left + width, at.y + 4}};
        occupied_.push_back(box);
        used_.add(box);
    }

    void leader(const std::vector<dvec2>& points) {
        svg_.path(points, false,
                  fmt::format("class=\"leader\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.7\"", grey));
        occupy(points);
    }

    struct Row {
        const Label* label;
        Box box; // px
    };

    void draw_labels(const View& view, const std::vector<Label>& labels, const Box& frame, bool all_right) {
        std::vector<Row> left, right, over;
        for (const Label& label : labels) {
            const Row row{&label, view(label.part)};
            switch (label.place) {
            case Label::Place::beside:
                (all_right || !on_left(label) ? right : left).push_back(row);
                break;
            case Label::Place::over:
                over.push_back(row);
                break;
            case Label::Place::behind:
                label_behind(row);
                break;
            case Label::Place::bracket:
                draw_bracket(row);
                break;
            }
        }
        label_beside(left, frame.lower.x, -1);
        label_beside(right, frame.upper.x, 1);
        // Each arm of its own.
        constexpr double same_arm = 40; // px
        std::ranges::stable_sort(over, {}, [](const Row& row) { return row.box.middle().y; });
        for (auto first = over.begin(); first != over.end();) {
            auto last = first + 1;
            while (last != over.end() && last->box.middle().y - (last - 1)->box.middle().y < same_arm) {
                ++last;
            }
            label_over({first, last});
            first = last;
        }
    }

    void label_beside(std::vector<Row> rows, double edge, double side) {
        std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.box.middle().y; });
        std::vector<double> wished;
        for (const Row& row : rows) {
            wished.push_back(row.box.middle().y);
        }
        const auto heights = spread(wished, std::vector<double>(rows.size(), label_spacing));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const Box& box = rows[i].box;
            leader({{side < 0 ? box.lower.x : box.upper.x, box.middle().y},
                    {edge + side * 10, heights[i]},
                    {edge + side * 22, heights[i]}});
            write_label({edge + side * 26, heights[i] + 0.35 * label_size}, rows[i].label->text,
                        side < 0 ? "end" : "start");
        }
    }

    void label_over(std::vector<Row> rows) {
        std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.box.middle().x; });
        std::vector<double> wished, spacing;
        double top = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            wished.push_back(rows[i].box.middle().x);
            spacing.push_back(
                i == 0 ? 0 : 0.5 * (width_of(rows[i - 1].label->text) + width_of(rows[i].label->text)) + label_size);
            top = std::min(top, rows[i].box.lower.y);
        }
        const double height = top - label_room;
        const auto places = spread(wished, spacing);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            leader({{wished[i], rows[i].box.lower.y}, {places[i], height + 14}, {places[i], height + 5}});
            write_label({places[i], height}, rows[i].label->text, "middle");
        }
    }

    void label_behind(const Row& row) {
        const dvec2 normal(row.label->normal.x, -row.label->normal.y); // px: y down
        const bool level = std::abs(normal.x) > 0.4;
        const dvec2 at = row.box.middle() + normal * 22.0 + dvec2(0, 0.35 * label_size);
        write_label(at, row.label->text, !level ? "middle" : normal.x < 0 ? "end" : "start");
    }

    // Under a level part, to the right of an upright one, from end to end.
    void draw_bracket(const Row& row) {
        constexpr double gap = 14;
        constexpr double tooth = 5;
        const Box& box = row.box;
        if (box.size().x > box.size().y) {
            const double y = box.upper.y + gap;
            leader({{box.lower.x, y - tooth}, {box.lower.x, y}, {box.upper.x, y}, {box.upper.x, y - tooth}});
            write_label({box.middle().x, y + label_spacing}, row.label->text, "middle");
        } else {
            const double x = box.upper.x + gap;
            leader({{x - tooth, box.lower.y}, {x, box.lower.y}, {x, box.upper.y}, {x - tooth, box.upper.y}});
            write_label({x + tooth, box.middle().y + 0.35 * label_size}, row.label->text, "start");
        }
    }

    void draw_scale_bar(const char* id, dvec2 at, double scale) {
        constexpr double longest = 140;
        const double length = round_length(longest / scale);
        const dvec2 end = at + dvec2(length * scale, 0);
        svg_.line(at, end, fmt::format("id=\"{}\" stroke=\"{}\" stroke-width=\"3\"", id, ink));
        write_label({end.x + 8, end.y + 0.35 * label_size}, fmt::format("{:g} mm", length), "start");
    }

    // The objective and the specimen, larger, where there is room or to the right of all.
    void draw_inset() {
        const Box region = drawing_.objective_region();
        if (region.empty()) {
            return;
        }
        constexpr double tallest = 400;
        constexpr double widest = 260;
        constexpr double border = 14;
        const auto labels = drawing_.objective_labels();
        double text = 0;
        for (const Label& label : labels) {
            text = std::max(text, width_of(label.text));
        }
        const dvec2 shown = region.size() * dvec2(1.35, 1.2);
        View view;
        view.scale = std::min(tallest / shown.y, widest / shown.x);
        const dvec2 picture = view.scale * shown;
        constexpr double dimension = 90; // room for the working distance
        const dvec2 size(dimension + picture.x + text + 40 + border, picture.y + 3 * border + label_spacing);

        const dvec2 corner = free_place(size);
        const Box frame{corner, corner + size};
        const Box window{corner + dvec2(dimension, border), corner + dvec2(dimension, border) + picture};
        view.origin = window.middle() - view.scale * dvec2(region.middle().x, -region.middle().y);
        svg_.open_group("id=\"inset\"");
        svg_.rectangle(frame.lower, frame.size(),
                       fmt::format("fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"0.8\"", grey));
        svg_.clip_rectangle("inset-window", window.lower, window.size());
        svg_.open_group("clip-path=\"url(#inset-window)\"");
        draw_shapes(view, window);
        svg_.close_group();
        used_.add(frame);
        draw_labels(view, labels, window, true);
        const double front = view({0, instrument_.front_vertex_height}).y;
        const double focus = view({0, 0}).y;
        const double x = window.lower.x - 8;
        for (const double height : {front, focus}) {
            svg_.line({x - 5, height}, {window.middle().x, height},
                      fmt::format("stroke=\"{}\" stroke-width=\"0.5\" stroke-dasharray=\"3 3\"", grey));
        }
        svg_.line({x, front}, {x, focus}, fmt::format("stroke=\"{}\" stroke-width=\"1\"", ink));
        write_label({x - 6, 0.5 * (front + focus) + 0.35 * label_size},
                    fmt::format("{:.3g} mm", instrument_.first_order.working_distance), "end");
        draw_scale_bar("inset-scale-bar", {corner.x + border, frame.upper.y - border}, view.scale);
        svg_.close_group();
        // What of the whole it shows.
        const Box marked = main_(region).grown(6);
        svg_.rectangle(marked.lower, marked.size(),
                       fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\" stroke-dasharray=\"4 3\"", grey));
    }

    // The upper left corner of the free rectangle of this size that is furthest left, at the top or the bottom.
    dvec2 free_place(dvec2 size) const {
        dvec2 best(std::numeric_limits<double>::infinity());
        for (const double y : {content_.lower.y, content_.upper.y - size.y}) {
            for (double x = content_.lower.x; x < best.x; x += 4) {
                const Box box = Box{{x, y}, dvec2(x, y) + size}.grown(16);
                if (std::ranges::none_of(occupied_, [&](const Box& other) { return box.meets(other); })) {
                    best = {x, y};
                }
            }
        }
        return best;
    }

    void draw_legend(double bottom) {
        double x = margin;
        const double y = bottom + 2 * label_spacing;
        for (const BundleStyle& style : bundle_styles) {
            if (!drawing_.has(style.bundle)) {
                continue;
            }
            const std::string meaning = drawing_.is_ring() && style.bundle == RoomRay::Bundle::illumination_centre
                                            ? "illumination"
                                            : style.meaning;
            svg_.line({x, y}, {x + 26, y}, fmt::format("stroke=\"{}\" stroke-width=\"2.5\"", style.colour));
            write_label({x + 32, y + 0.35 * label_size}, meaning, "start");
            x += 60 + width_of(meaning);
        }
    }

    const optics::Instrument& instrument_;
    Drawing drawing_;
    std::string title_;
    Svg svg_;
    View main_;
    Box content_; // px, of the main picture
    Box used_;
    std::vector<Box> occupied_;
};

} // namespace

std::string layout_svg(const optics::Instrument& instrument, const std::string& name) {
    return Page(instrument, name).document();
}

} // namespace vkfv::report
