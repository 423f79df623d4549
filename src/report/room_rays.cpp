#include "report/room_rays.hpp"

#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vkfv::report {

namespace {

using optics::Element;
using physics::f64::TrainResult;
using Bundle = RoomRay::Bundle;

// An element on the path of light, which passes it or is reflected by it.
struct Meeting {
    std::size_t element = 0;
    bool reflects = false;
};
using Way = std::vector<Meeting>;

// The index at which the imaging's elements begin; those before are the illumination's alone.
std::size_t imaging_begin(const std::vector<Element>& elements) {
    const auto first = std::ranges::find_if(elements, [](const Element& element) {
        return element.part == optics::Part::cover_glass || element.part == optics::Part::objective;
    });
    return static_cast<std::size_t>(first - elements.begin());
}

Way imaging_way(const std::vector<Element>& elements) {
    Way way;
    for (std::size_t i = imaging_begin(elements); i < elements.size(); ++i) {
        way.push_back({i, elements[i].kind == Element::Kind::mirror});
    }
    return way;
}

// The path of illumination: to the splitter, and from there against the imaging's direction.
Way illumination_way(const std::vector<Element>& elements, bool is_ring) {
    Way way;
    const std::size_t begin = imaging_begin(elements);
    for (std::size_t i = 0; i < begin && !is_ring; ++i) {
        way.push_back({i, elements[i].kind == Element::Kind::mirror});
    }
    std::size_t end = begin;
    if (is_ring) {
        while (end < elements.size() && elements[end].part == optics::Part::cover_glass) {
            ++end;
        }
    } else {
        while (end < elements.size() && elements[end].kind != Element::Kind::splitter) {
            ++end;
        }
        end = std::min(end + 1, elements.size());
    }
    for (std::size_t i = end; i-- > begin;) {
        way.push_back({i, elements[i].kind == Element::Kind::splitter});
    }
    return way;
}

class RoomTracer {
  public:
    RoomTracer(const std::vector<Element>& elements, const Way& way) {
        for (const Meeting& meeting : way) {
            const Element& element = elements[meeting.element];
            Stand stand{.element = static_cast<int>(meeting.element),
                        .reflects = meeting.reflects,
                        .is_ideal_lens = element.kind == Element::Kind::ideal_lens,
                        .ahead = {element.surface, element.pose, element.name},
                        .astern = {}};
            stand.astern = optics::reversed({stand.ahead}).front();
            for (optics::PlacedSurface* placed : {&stand.ahead, &stand.astern}) {
                placed->surface.distance = 0;
                if (meeting.reflects) {
                    placed->surface.index_after = placed->surface.index_before;
                }
            }
            way_.push_back(stand);
        }
    }

    // Traces a ray. direction: unit. None if the ray does not pass; the status of its end is not needed.
    std::optional<RoomRay> trace(glm::dvec3 position, glm::dvec3 direction, double index, Bundle bundle) {
        RoomRay room_ray{.bundle = bundle, .vertices = {position}, .elements = {RoomRay::no_element}};
        TrainResult state{};
        state.index = index;
        state.transmitted = 1;
        direction *= index;
        for (const Stand& stand : way_) {
            const bool is_ahead = glm::dot(direction, stand.ahead.pose.axes[2]) > 0;
            const optics::PlacedSurface& placed = is_ahead ? stand.ahead : stand.astern;
            const optics::Pose& pose = placed.pose;
            const glm::dmat3 back = glm::transpose(pose.axes);
            state.ray.position = back * (position - pose.origin);
            state.ray.direction = back * direction;
            const glm::dvec3 start = state.ray.position;
            const glm::dvec3 before = state.ray.direction;
            state = trace_surface(placed.surface, 0, state, 1, light, physics::f64::FEATURE_IDEAL_LENS);
            if (state.status != physics::f64::PATH_ALIVE) {
                return std::nullopt;
            }
            const auto add_vertex = [&](const glm::dvec3& inside) {
                room_ray.vertices.push_back(pose.point(inside));
                room_ray.elements.push_back(stand.element);
            };
            glm::dvec3 after = state.ray.direction;
            glm::dvec3 point = state.ray.position;
            if (stand.is_ideal_lens) {
                add_vertex(start - before * (start.z / before.z));
                point -= after * (point.z / after.z);
            } else if (stand.reflects) {
                after.z = -after.z; // mirrors are plane
            }
            add_vertex(point);
            position = pose.point(point);
            direction = pose.direction(after);
        }
        direction_ = direction;
        return room_ray;
    }

    // Traces a ray and extends it to the plane of best focus.
    std::optional<RoomRay> trace_to_focus(glm::dvec3 position, glm::dvec3 direction, double index, Bundle bundle) {
        auto ray = trace(position, direction, index, bundle);
        if (ray) {
            const glm::dvec3 last = ray->vertices.back();
            ray->vertices.push_back(last - direction_ * (last.z / direction_.z));
            ray->elements.push_back(RoomRay::no_element);
        }
        return ray;
    }

  private:
    static constexpr physics::f64::Light light{.spectral = 0, .wave_number = 1, .survival = 0};
    // A surface in both orientations, as surfaces are met towards their z.
    struct Stand {
        int element = 0;
        bool reflects = false;
        bool is_ideal_lens = false;
        optics::PlacedSurface ahead;
        optics::PlacedSurface astern;
    };
    std::vector<Stand> way_;
    glm::dvec3 direction_{}; // direction of the last ray after the last element
};

// The rays `trace_at(sine)` for `count` sines from margin to margin of the widest passing stretch in [-greatest,
// greatest].
template <class Trace>
std::vector<RoomRay> fan(const Trace& trace_at, double greatest, int count) {
    constexpr int steps = 2000; // a stretch of a thousandth of the range is still found
    const auto sine_at = [&](int step) { return greatest * (2.0 * step / steps - 1); };
    int best_first = 0;
    int best_length = 0;
    int length = 0;
    for (int step = 0; step <= steps; ++step) {
        length = trace_at(sine_at(step)) ? length + 1 : 0;
        if (length > best_length) {
            best_length = length;
            best_first = step - length + 1;
        }
    }
    if (best_length == 0) {
        return {};
    }
    const auto margin = [&](double passing, double stopped) {
        for (int bisection = 0; bisection < 40; ++bisection) {
            const double middle = 0.5 * (passing + stopped);
            (trace_at(middle) ? passing : stopped) = middle;
        }
        return passing;
    };
    const int best_last = best_first + best_length - 1;
    const double lowest = best_first == 0 ? -greatest : margin(sine_at(best_first), sine_at(best_first - 1));
    const double highest = best_last == steps ? greatest : margin(sine_at(best_last), sine_at(best_last + 1));
    std::vector<RoomRay> rays;
    for (int i = 0; i < count; ++i) {
        if (auto ray = trace_at(lowest + (highest - lowest) * i / (count - 1))) {
            rays.push_back(std::move(*ray));
        }
    }
    return rays;
}

glm::dvec3 in_plane(double sine) {
    return {0, sine, std::sqrt(std::max(0.0, 1 - sine * sine))};
}

void append(std::vector<RoomRay>& rays, std::vector<RoomRay> more) {
    std::ranges::move(more, std::back_inserter(rays));
}

constexpr double steepest_sine = 0.999;

void add_imaging(std::vector<RoomRay>& rays, const optics::Instrument& instrument) {
    RoomTracer tracer(instrument.elements, imaging_way(instrument.elements));
    const auto from = [&](double height, Bundle bundle, int count) {
        append(rays,
               fan(
                   [&](double sine) {
                       return tracer.trace({0, height, 0}, in_plane(sine), instrument.constants.specimen_index, bundle);
                   },
                   steepest_sine, count));
    };
    from(0, Bundle::imaging_axis, 7);
    from(instrument.first_order.field_edge, Bundle::imaging_edge, 5);
}

void add_disc(std::vector<RoomRay>& rays, const optics::Instrument& instrument) {
    const auto& constants = instrument.constants;
    const bool is_rectangle = (instrument.features & physics::f64::FEATURE_RECTANGLE) != 0;
    const double half_height = is_rectangle ? constants.source_half_height : constants.source_radius;
    RoomTracer tracer(instrument.elements, illumination_way(instrument.elements, false));
    const optics::Pose& source = instrument.source_pose;
    const auto from = [&](double height, Bundle bundle, int count) {
        const double greatest =
            std::min(constants.emission_sine + std::abs(constants.emission_shift * height), steepest_sine);
        return fan(
            [&](double sine) {
                return tracer.trace_to_focus(source.point({0, height, 0}), source.direction(in_plane(sine)), 1, bundle);
            },
            greatest, count);
    };
    append(rays, from(0, Bundle::illumination_centre, 5));
    // A source may be larger than the pupil, so rays start at the rim of its passing part.
    for (const double side : {1.0, -1.0}) {
        constexpr int heights = 40;
        std::vector<RoomRay> rim;
        for (int step = heights; step > 0 && rim.empty(); --step) {
            rim = from(side * half_height * step / heights, Bundle::illumination_rim, 3);
        }
        append(rays, std::move(rim));
    }
}

void add_ring(std::vector<RoomRay>& rays, const optics::Instrument& instrument) {
    RoomTracer tracer(instrument.elements, illumination_way(instrument.elements, true));
    const auto& ring = instrument.constants.ring;
    const double index = instrument.constants.specimen_index;
    for (const double side : {1.0, -1.0}) {
        // The lit point of the band nearest to the plane of drawing on this side.
        double nearest = 0.5 * pi;
        std::optional<double> azimuth;
        for (int segment = 0; segment < ring.segments; ++segment) {
            if ((ring.switched_on >> segment & 1u) == 0) {
                continue;
            }
            const double middle = 2 * pi * (segment + 0.5) / ring.segments;
            const double reach = pi * ring.fill / ring.segments;
            const double off = std::remainder(side * 0.5 * pi - middle, 2 * pi);
            const double inside = std::clamp(off, -reach, reach);
            if (std::abs(off - inside) < nearest) {
                nearest = std::abs(off - inside);
                azimuth = middle + inside;
            }
        }
        if (!azimuth) {
            continue;
        }
        const double radius = ring.distance * ring.elevation_cosine;
        const glm::dvec3 start(radius * std::cos(*azimuth), radius * std::sin(*azimuth),
                               ring.distance * ring.elevation_sine);
        for (const double height : {-1.0, 0.0, 1.0}) {
            const glm::dvec3 aim(0, height * instrument.first_order.field_edge, 0);
            if (auto ray = tracer.trace_to_focus(start, glm::normalize(aim - start), index, Bundle::ring_light)) {
                rays.push_back(std::move(*ray));
            }
        }
    }
}

} // namespace

std::vector<RoomRay> trace_room_rays(const optics::Instrument& instrument) {
    std::vector<RoomRay> rays;
    for (const optics::Instrument* light : instrument.lights()) {
        if ((light->features & physics::f64::FEATURE_RING) != 0) {
            add_ring(rays, *light);
        } else {
            add_disc(rays, *light);
        }
    }
    add_imaging(rays, instrument);
    return rays;
}

} // namespace vkfv::report
