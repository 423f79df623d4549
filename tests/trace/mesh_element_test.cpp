// Elements that are meshes agree with closed forms of a plate and a prism and with Stokes' pile of plates, leak nothing
// at their edges, and give the image of the same plate as two surfaces; the device agrees with the host.
#include "trace/device/device_tracer.hpp"
#include "trace/elements.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/same_paths.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

using namespace vkfv;
using namespace vkfv::physics::f64;
using namespace vkfv::test;

namespace {

using optics::Facets;
using optics::MeshElement;
using optics::PlacedMesh;

// A body drawn out along x, its facets counter-clockwise seen from outside. `profile` has points (y, z),
// counter-clockwise seen from +x.
Facets drawn_out(const std::vector<glm::dvec2>& profile, double half_width) {
    Facets body;
    const auto corners = static_cast<std::uint32_t>(profile.size());
    for (const double x : {-half_width, half_width}) {
        for (const glm::dvec2& point : profile) {
            body.vertices.emplace_back(x, point.x, point.y);
        }
    }
    for (std::uint32_t k = 0; k < corners; ++k) {
        const std::uint32_t next = (k + 1) % corners;
        body.triangles.emplace_back(k, next, corners + next);
        body.triangles.emplace_back(k, corners + next, corners + k);
        if (k >= 2) {
            body.triangles.emplace_back(0, k, k - 1);
            body.triangles.emplace_back(corners, corners + k - 1, corners + k);
        }
    }
    return body;
}

Facets box(double half_width, double bottom, double top) {
    return drawn_out({{-half_width, bottom}, {half_width, bottom}, {half_width, top}, {-half_width, top}}, half_width);
}

// A ball: each facet of an octahedron is divided in four, and all corners put on the sphere, so many times.
Facets ball(double radius, int times) {
    Facets body{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int time = 0; time < times; ++time) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), body.vertices.size());
            if (is_new) {
                body.vertices.push_back(glm::normalize(body.vertices[a] + body.vertices[b]));
            }
            return entry->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : body.triangles) {
            const auto ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
        }
        body.triangles = std::move(finer);
    }
    for (glm::dvec3& vertex : body.vertices) {
        vertex *= radius;
    }
    return body;
}

PlacedMesh placed(Facets facets, const optics::Pose& pose, MeshElement::Kind kind, double index = 1,
                  std::uint32_t flags = 0) {
    PlacedMesh mesh{.kind = kind, .name = "body", .facets = std::move(facets)};
    mesh.closed = optics::openness_of(mesh.facets).closed();
    for (glm::dvec3& vertex : mesh.facets.vertices) {
        vertex = pose.point(vertex);
    }
    mesh.surface.index_before = 1;
    mesh.surface.index_after = index;
    mesh.surface.reflectance = 1;
    mesh.surface.flags = flags;
    return mesh;
}

// A single ray up the axis.
physics::f64::Instrument ray() {
    auto instrument = pencil(1000, 1);
    instrument.source_radius = 0;
    instrument.emission_sine = 1e-12;
    return instrument;
}

double y_at(double height, const PlacedMesh& mesh) {
    Bench bench;
    bench.add_detector(height);
    bench.add_mesh(mesh);
    const Detection end = trace_bench(bench, ray(), 1).front();
    EXPECT_EQ(end.fate.status, PATH_DETECTED);
    return end.y;
}

constexpr double rounding = 1e-5; // mm: corners are kept to 1e-6 of single precision

} // namespace

// A plate moves a ray by t sin(theta - theta') / cos(theta'); a turn about x leans the plate's normal to -y.
TEST(MeshElement, ATiltedPlateMovesARayAsSnellSays) {
    constexpr double thickness = 3, index = 1.5168;
    const double theta = 20 * pi / 180;
    const auto moved = [&](double n) {
        const double refracted = std::asin(std::sin(theta) / n);
        return -thickness * std::sin(theta - refracted) / std::cos(refracted);
    };
    const auto plate = placed(box(15, 0, thickness), optics::Pose{}.along_z(5).turned({.tilt_x = theta}),
                              MeshElement::Kind::glass, index);
    EXPECT_NEAR(y_at(60, plate), moved(index), rounding);
    EXPECT_GT(std::abs(y_at(60, plate) - moved(index + 0.02)), 100 * rounding); // wrong twin
}

// A prism of 60 degrees at the least deviation obeys n = sin((A + D) / 2) / sin(A / 2).
TEST(MeshElement, APrismTurnsLightByItsDeviation) {
    constexpr double index = 1.5168;
    static constexpr double apex = pi / 3;
    const auto deviation = [](double n) { return 2 * std::asin(n * std::sin(apex / 2)) - apex; };
    // The prism's apex points to -y; the ray meets the middle of its first face from below, at the angle of incidence
    // (A + D) / 2.
    const double height = 10 * std::sqrt(3.0);
    const Facets prism = drawn_out({{-height / 2, 0}, {height / 2, -10}, {height / 2, 10}}, 10);
    // Without a turn the first face's outward normal is at A / 2 from -z towards -y.
    const double incidence = (apex + deviation(index)) / 2;
    const auto turned = placed(prism, optics::Pose{}.along_z(20).turned({.tilt_x = apex / 2 - incidence}),
                               MeshElement::Kind::glass, index);
    const double slope = (y_at(42, turned) - y_at(36, turned)) / 6;
    EXPECT_NEAR(std::abs(std::atan(slope)), deviation(index), 1e-6); // facets of 10 mm, corners to 1e-6 mm
    EXPECT_GT(std::abs(std::abs(std::atan(slope)) - deviation(index + 0.02)), 1e-3); // wrong twin
}

// A roof of two mirrors at right angles sends light back the way it came, displaced, however it is tilted about its
// ridge.
TEST(MeshElement, ARoofOfTwoMirrorsSendsLightBack) {
    for (const double tilt : {0.0, 0.2}) {
        Facets roof{{{-10, -10, -10}, {10, -10, -10}, {10, 0, 0}, {-10, 0, 0}, {10, 10, -10}, {-10, 10, -10}},
                    {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}}};
        Bench bench;
        Element detector{};
        detector.kind = ELEMENT_DETECTOR;
        detector.surface.index_before = detector.surface.index_after = 1;
        bench.add(detector, optics::Pose{}.along_z(-20).half_turn()); // looks up
        bench.add_mesh(
            placed(roof, optics::Pose{{0, 2, 30}, glm::dmat3(1)}.turned({.tilt_x = tilt}), MeshElement::Kind::mirror));
        const Detection end = trace_bench(bench, ray(), 1).front();
        EXPECT_EQ(end.fate.status, PATH_DETECTED);
        EXPECT_NEAR(std::abs(end.y), 4, rounding); // it leaves as far beyond the ridge as it came in before it
    }
}

// Light of one facet stays parallel, so a lens of facets makes spots as wide as these: half as wide, half the spot. The
// lens is a ball, whose focus is at n R / (2 (n - 1)) from its centre.
TEST(MeshElement, ALensMakesSpotsAsWideAsItsFacets) {
    constexpr double index = 1.5, radius = 7;
    const auto spot = [&](int times) { // root mean square distance from the axis, mm
        Bench bench;
        bench.add_detector(10 + index * radius / (2 * (index - 1)));
        bench.add_mesh(placed(ball(radius, times), optics::Pose{}.along_z(10).turned({.tilt_x = 0.2, .tilt_y = 0.1}),
                              MeshElement::Kind::glass, index));
        auto beam = pencil(100, 1);
        beam.source_radius = 1.2;
        double sum = 0;
        constexpr std::uint32_t paths = 4000;
        for (const Detection& end : trace_bench(bench, beam, paths)) {
            EXPECT_EQ(end.fate.status, PATH_DETECTED);
            sum += end.x * end.x + end.y * end.y;
        }
        return std::sqrt(sum / paths);
    };
    const double coarse = spot(3), fine = spot(4), finest = spot(5);
    const double width = radius * pi / 2 / 32; // of the finest facets
    EXPECT_NEAR(coarse / fine, 2, 0.4);
    EXPECT_NEAR(fine / finest, 2, 0.4);
    EXPECT_GT(finest, 0.2 * width);
    EXPECT_LT(finest, width);
}

// Stokes' formula for a pile of plates, as in Nonsequential.FivePlatesPassWhatStokesSays, holds for plates of meshes
// too.
TEST(MeshElement, FivePlatesPassWhatStokesSays) {
    const auto passed = [](double index) {
        const double reflectance = (index - 1) * (index - 1) / ((index + 1) * (index + 1));
        return (1 - reflectance) / (1 + 9 * reflectance);
    };
    Bench bench;
    bench.add_detector(20);
    for (int plate = 0; plate < 5; ++plate) {
        bench.add_mesh(placed(box(10, 0, 1), optics::Pose{}.along_z(2.0 * plate), MeshElement::Kind::glass, 1.5168,
                              SURFACE_FRESNEL));
    }
    constexpr std::uint32_t paths = 30000;
    const double share = detected_share(trace_bench(bench, pencil(1, 4), paths));
    EXPECT_LT(test::share_z(share * paths, paths, passed(1.5168)), 4); // false-positive rate 6e-5
    EXPECT_GT(test::share_z(share * paths, paths, passed(1.5368)), 4); // wrong twin
}

// Rays from within, straight at every corner and at points of every edge, and anywhere, each meet a facet, whichever of
// the neighbours it is: in double, and in the arithmetic of the device.
TEST(MeshElement, NoRayPassesBetweenFacets) {
    optics::Room room;
    room.add_mesh(placed(ball(7, 2), optics::Pose{{1, 2, 300}, glm::dmat3(1)}, MeshElement::Kind::absorber));
    room.grow_facet_tree();
    const glm::dvec3 origin(1.5, 1.25, 299);
    std::vector<glm::dvec3> aims;
    for (const Facet& facet : room.facets) {
        for (const double share : {0.0, 0.125, 0.3, 0.5}) {
            aims.push_back(glm::mix(facet.corner_a, facet.corner_b, share));
            aims.push_back(glm::mix(facet.corner_b, facet.corner_c, share));
            aims.push_back(glm::mix(facet.corner_c, facet.corner_a, share));
        }
    }
    for (const glm::dvec3& aim : aims) {
        const glm::dvec3 direction = glm::normalize(aim - origin);
        EXPECT_GE(optics::nearest_element(room, origin, direction, {-1, -1, 0}).facet, 0);
        const auto frame = physics::f32::ray_frame(glm::vec3(origin), glm::normalize(glm::vec3(direction)));
        bool met = false;
        for (const Facet& facet : room.facets) {
            physics::f32::Facet rounded{};
            rounded.corner_a = facet.corner_a;
            rounded.corner_b = facet.corner_b;
            rounded.corner_c = facet.corner_c;
            const auto meeting = physics::f32::meet_facet(frame, rounded);
            met = met || (meeting.found && meeting.distance > 0);
        }
        EXPECT_TRUE(met);
    }
}

namespace {

// Elements and facets in the device's arithmetic; it counts what light within glass meets.
struct SingleBench {
    explicit SingleBench(const optics::Room& room) {
        for (const Element& element : room.elements) {
            physics::f32::Element rounded{};
            rounded.kind = element.kind;
            rounded.surface.index_before = static_cast<float>(element.surface.index_before);
            rounded.surface.index_after = static_cast<float>(element.surface.index_after);
            rounded.surface.flags = element.surface.flags;
            elements.push_back(rounded);
        }
        for (const Facet& facet : room.facets) {
            facets.push_back({.corner_a = facet.corner_a,
                              .corner_b = facet.corner_b,
                              .corner_c = facet.corner_c,
                              .normal = facet.normal,
                              .element = facet.element,
                              .closed = facet.closed});
        }
    }
    physics::f32::Surface surface_at(int) const { return {}; }
    std::uint32_t features() const { return FEATURE_FACETS; }
    physics::f32::SpectralBin spectral_bin(int) const { return {}; }
    physics::f32::Hit specimen_hit(glm::vec3, glm::vec3) const { return {}; }
    float pattern_point(const physics::f32::Pattern&, int, int) const { return 1; }
    float material_number(int) const { return 0; }
    physics::f32::LightField light_field() const { return {}; }
    physics::f32::Element element_at(int index) const { return elements[static_cast<std::size_t>(index)]; }
    physics::f32::Facet facet_at(int index) const { return facets[static_cast<std::size_t>(index)]; }
    physics::f32::ElementHit nearest_element(glm::vec3 origin, glm::vec3 direction,
                                             physics::f32::PathPlace from) const {
        const auto frame = physics::f32::ray_frame(origin, direction);
        auto nearest = physics::f32::no_element(1e6f);
        for (std::size_t k = 0; k < facets.size(); ++k) {
            nearest = physics::f32::consider_facet(nearest, frame, facets[k], static_cast<int>(k), from,
                                                   physics::f32::least_distance(origin));
        }
        const auto hit = nearest_hit(nearest, from);
        inside += from.inside >= 0 ? 1 : 0;
        beside += hit.index == physics::f32::ASTRAY ? 1 : 0;
        return hit;
    }

    std::vector<physics::f32::Element> elements;
    std::vector<physics::f32::Facet> facets;
    mutable int inside = 0, beside = 0;
};

} // namespace

// Light is caught by total reflection in a grain of glass far from the origin, where a start is rounded to a thousandth
// of the grain: it never gets out but through a facet. A path that rounding puts beside an edge ends as numerical.
TEST(MeshElement, LightLeavesGlassThroughFacetsAlone) {
    int inside = 0, beside = 0, numerical = 0;
    for (const Facets& body : {ball(0.05, 2), box(0.02, -0.02, 0.02)}) {
        optics::Room room;
        room.add_mesh(placed(body, optics::Pose{{0.3, -0.2, 330}, glm::dmat3(1)}.turned({.tilt_x = 0.5, .tilt_y = 0.3}),
                             MeshElement::Kind::glass, 1.8, SURFACE_FRESNEL));
        const SingleBench bench(room);
        physics::f32::Instrument source{};
        source.source_radius = 0.06f;
        source.emission_sine = 1e-3f;
        source.spectrum_centre = 4;
        source.spectrum_half_width = 1;
        source.detector_columns = source.detector_rows = 1;
        physics::f32::SourceFrame frame{{0.3f, -0.2f, 329}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        physics::f32::Exposure exposure{};
        exposure.seed = 5;
        for (std::uint32_t path = 0; path < 4000; ++path) {
            const auto end = physics::f32::trace_nonsequential(bench, source, physics::f32::SpecimenRecord{}, exposure,
                                                               frame, glm::uvec2(path, 0));
            numerical += end.fate.status == PATH_NUMERICAL ? 1 : 0;
            EXPECT_TRUE(end.fate.status == PATH_ESCAPED || end.fate.status == PATH_INTERACTION_LIMIT ||
                        end.fate.status == PATH_NUMERICAL);
        }
        beside += bench.beside;
        inside += bench.inside;
    }
    EXPECT_GT(inside, 10000);
    EXPECT_GT(beside, 0); // the test has rays of this case
    EXPECT_EQ(beside, numerical);
    EXPECT_LT(beside, inside / 1000);
}

TEST(MeshElement, OpenAndTurnedMeshesAreTold) {
    Facets whole = ball(1, 1);
    EXPECT_TRUE(optics::openness_of(whole).closed());
    Facets open = whole;
    open.triangles.pop_back();
    EXPECT_EQ(optics::openness_of(open).open_edges, 3u);
    Facets turned = whole;
    std::swap(turned.triangles[5].x, turned.triangles[5].y);
    EXPECT_EQ(optics::openness_of(turned).turned_edges, 3u);
    for (glm::uvec3& triangle : whole.triangles) {
        std::swap(triangle.x, triangle.y);
    }
    const Facets outward = optics::turned_outward(whole);
    const auto normals = optics::normals_of(outward);
    for (std::size_t k = 0; k < normals.size(); ++k) {
        EXPECT_GT(glm::dot(normals[k], outward.vertices[outward.triangles[k].x]), 0.8);
    }
}

// The bodies are a ball with a hole in which another ball stands, and one beside them; each of them either way round.
TEST(MeshElement, EachBodyOfAFileIsTurnedByItself) {
    struct Body {
        double radius, x;
        bool hole;
    };
    const Body bodies[] = {{3, 0, false}, {2, 0, true}, {1, 0.2, false}, {1.5, 8, false}};
    for (int ways = 0; ways < 16; ++ways) {
        Facets file;
        std::vector<const Body*> of;
        for (int k = 0; k < 4; ++k) {
            const Facets body = ball(bodies[k].radius, 1);
            const auto first = static_cast<std::uint32_t>(file.vertices.size());
            for (const glm::dvec3& vertex : body.vertices) {
                file.vertices.push_back(vertex + glm::dvec3(bodies[k].x, 0, 0));
            }
            for (const glm::uvec3& t : body.triangles) {
                file.triangles.push_back(first + ((ways >> k & 1) != 0 ? glm::uvec3(t.y, t.x, t.z) : t));
                of.push_back(&bodies[k]);
            }
        }
        const Facets turned = optics::turned_outward(file);
        const auto normals = optics::normals_of(turned);
        for (std::size_t k = 0; k < normals.size(); ++k) {
            const glm::dvec3 from_centre = turned.vertices[turned.triangles[k].x] - glm::dvec3(of[k]->x, 0, 0);
            EXPECT_GT(glm::dot(normals[k], from_centre) * (of[k]->hole ? -1 : 1), 0.5) << ways << ' ' << k;
        }
    }
}

namespace {

MeshElement element(Facets facets, const optics::Pose& pose, MeshElement::Kind kind, const char* name) {
    MeshElement mesh{.kind = kind, .name = name, .facets = std::move(facets), .pose = pose};
    if (kind == MeshElement::Kind::glass) {
        mesh.glass = optics::Medium::constant("glass", 1.5168, "test");
    }
    return mesh;
}

// A microscope with a wedge, and a baffle that reaches into the light, between objective and beam splitter.
optics::InstrumentDescription microscope_with_meshes() {
    auto description = coarse_microscope();
    description.interfaces.model = optics::Interfaces::Model::fresnel;
    const auto bare = optics::assemble(description);
    const auto is_splitter = [](const optics::Element& part) { return part.part == optics::Part::beam_splitter; };
    const auto splitter = std::ranges::find_if(bare.elements, is_splitter);
    double back = 0;
    for (const optics::Element& part : bare.elements) {
        back = part.part == optics::Part::objective ? std::max(back, part.pose.origin.z) : back;
    }
    const double middle = 0.5 * (back + splitter->pose.origin.z);
    description.meshes.push_back(element(drawn_out({{-14, 0}, {14, 0}, {14, 1.02}, {-14, 1}}, 14),
                                         optics::Pose{{0.5, 0.3, middle}, glm::dmat3(1)}.turned({.tilt_x = 0.05}),
                                         MeshElement::Kind::glass, "wedge"));
    description.meshes.push_back(
        element(ball(3, 1), optics::Pose{{2, 6.5, middle + 6}, glm::dmat3(1)}, MeshElement::Kind::absorber, "baffle"));
    return description;
}

} // namespace

TEST(MeshElement, HostAndDeviceTraceTheSamePaths) {
    expect_same_paths(optics::assemble(microscope_with_meshes()));
}

// A cover glass as two surfaces and as a box of six faces, in otherwise equal microscopes, give the same image, and the
// ledger closes.
TEST(MeshElement, ACoverGlassOfFacetsGivesTheImageOfOneOfSurfaces) {
    auto description = ideal_microscope_description();
    description.detector_pixels = ImageSize::square(8);
    description.field_stop_radius = 0.4; // whose image ends within the field, so that a wrong focus shows
    const auto without = optics::assemble(description);
    auto covered = description;
    covered.cover_glass =
        optics::CoverGlass{.thickness = 1, .glass = optics::Medium::constant("g", 1.5168, "test"), .distance = {}};
    const auto with_surfaces = optics::assemble(covered);
    const auto height_of = [](const optics::Instrument& instrument, optics::Part part) {
        return std::ranges::find(instrument.elements, part, &optics::Element::part)->pose.origin.z;
    };
    // The specimen is as far from the objective in both.
    const double lower =
        height_of(with_surfaces, optics::Part::objective) - height_of(without, optics::Part::objective);
    const double face =
        height_of(with_surfaces, optics::Part::cover_glass) - lower + without.first_order.best_focus_offset;
    description.meshes.push_back(
        element(box(12, 0, 1), optics::Pose{}.along_z(face), MeshElement::Kind::glass, "cover"));
    const auto with_mesh = optics::assemble(description);
    const auto specimen = smooth_specimen();
    const auto image = [&](const optics::Instrument& instrument, double height, std::uint32_t number) {
        return trace::make_device_tracer(instrument, specimen, options(trace::Traversal::bvh))->expose(height, number);
    };
    const auto of_surfaces = image(with_surfaces, 0.001, 2);
    const auto of_mesh = image(with_mesh, 0.001 + lower, 3);
    EXPECT_GT(of_mesh.detected, 5000u);
    EXPECT_GT(same_expectation_p(of_surfaces, of_mesh), 1e-4); // false-positive rate
    EXPECT_LT(std::abs(of_mesh.ledger.residual()), 1e-12 * of_mesh.ledger.emitted);
    // The wrong twin has no glass at all, and is a third of a millimetre out of focus.
    EXPECT_LT(same_expectation_p(of_surfaces, image(without, 0.001 + lower, 3)), 1e-4);
}
