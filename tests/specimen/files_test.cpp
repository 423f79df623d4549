// Specimens from files are what was written, a letter reads as the letter, and damage is named.
#include "specimen/description.hpp"
#include "specimen/files.hpp"
#include "specimen/kinds.hpp"
#include "specimen/shapes.hpp"

#include "images/image_file.hpp"
#include "support/surface_files.hpp"
#include "temporary_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace vkfv::specimen {
namespace {

using test::base64;
using test::raw;
using testing::HasSubstr;
using Files = test::TemporaryFiles;

// A tetrahedron with corners that floats hold exactly.
const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0.25f}, {0, 2, -0.5f}, {0.5f, 0.5f, 4}};
const std::vector<glm::uvec3> faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

std::string binary_stl() {
    // The word solid in the header does not make it text.
    std::string bytes = "solid but binary";
    bytes.resize(80, ' ');
    bytes += raw(static_cast<std::uint32_t>(faces.size()));
    for (const glm::uvec3& face : faces) {
        bytes += raw(glm::vec3(0));
        for (int i = 0; i < 3; ++i) {
            bytes += raw(corners[face[i]]);
        }
        bytes += std::string(2, '\0');
    }
    return bytes;
}

std::string ascii_stl() {
    std::string text = "solid tetrahedron\n";
    for (const glm::uvec3& face : faces) {
        text += " facet normal 0 0 +1.0\n  outer loop\n";
        for (int i = 0; i < 3; ++i) {
            const glm::vec3& p = corners[face[i]];
            text +=
                "   vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + "\t" + std::to_string(p.z) + "\r\n";
        }
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid tetrahedron\n";
}

void expect_tetrahedron(const FileMesh& mesh, const std::function<glm::dvec3(glm::dvec3)>& placed) {
    ASSERT_EQ(mesh.vertices.size(), 4u); // equal vertices are one
    ASSERT_EQ(mesh.triangles.size(), faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 expected = placed(glm::dvec3(corners[faces[i][k]]));
            EXPECT_NEAR(glm::length(mesh.vertices[mesh.triangles[i][k]] - expected), 0, 1e-14);
        }
    }
}

TEST_F(Files, StlBinaryAndAsciiAreTheMeshThatWasWritten) {
    const auto same = [](glm::dvec3 p) { return p; };
    expect_tetrahedron(read_stl(write("binary.stl", binary_stl()), {}), same);
    expect_tetrahedron(read_stl(write("ascii.stl", ascii_stl()), {}), same);
    std::string upper = ascii_stl();
    for (char& c : upper) {
        c = static_cast<char>(std::toupper(c));
    }
    expect_tetrahedron(read_stl(write("upper.stl", upper), {}), same);
    EXPECT_EQ(read_stl(write("two.stl", ascii_stl() + ascii_stl()), {}).triangles.size(), 8u);
}

struct Gltf {
    std::string nodes = R"([{"mesh": 0}])";
    int point_count = 4;
    int view_length = 48;
    int position = 0;
    std::uint16_t first_index = 0;
    float first_coordinate = 0;
    int mode = 4;

    std::string text() const {
        std::string data;
        for (glm::vec3 p : corners) {
            p.x = data.empty() ? first_coordinate : p.x;
            data += raw(p);
        }
        for (const glm::uvec3& face : faces) {
            for (int i = 0; i < 3; ++i) {
                data += raw(static_cast<std::uint16_t>(data.size() == 48 ? first_index : face[i]));
            }
        }
        return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": )" + nodes +
               R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": )" + std::to_string(position) +
               R"(}, "indices": 1, "mode": )" + std::to_string(mode) +
               R"(}]}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
               std::to_string(point_count) +
               R"(}, {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 12}],)"
               R"("bufferViews": [{"buffer": 0, "byteLength": )" +
               std::to_string(view_length) + R"(}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],)" +
               R"("buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,)" + base64(data) +
               R"("}]})";
    }
};

TEST_F(Files, GltfIsTheMeshWithItsNodesTransforms) {
    Gltf gltf;
    expect_tetrahedron(read_gltf(write("plain.gltf", gltf.text()), {}), [](glm::dvec3 p) { return p; });
    // A parent node moves; its child scales and then turns by 90 degrees about z: x to y, y to -x.
    gltf.nodes = R"([{"translation": [10, 20, 30], "children": [1]},
                     {"mesh": 0, "scale": [2, 3, 4], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}])";
    expect_tetrahedron(read_gltf(write("nodes.gltf", gltf.text()), {}),
                       [](glm::dvec3 p) { return glm::dvec3(10 - 3 * p.y, 20 + 2 * p.x, 30 + 4 * p.z); });
    gltf.nodes = R"([{"mesh": 0, "matrix": [0,2,0,0, -3,0,0,0, 0,0,4,0, 10,20,30,1]}])";
    expect_tetrahedron(read_gltf(write("matrix.gltf", gltf.text()), {}),
                       [](glm::dvec3 p) { return glm::dvec3(10 - 3 * p.y, 20 + 2 * p.x, 30 + 4 * p.z); });
}

// The letter's stem is at the left, its long arm on top, its short one in the middle.
void expect_letter(const Specimen& specimen, double low, double high) {
    struct Place {
        double x, y;
        bool on_letter;
    };
    const Place places[] = {
        {-0.03, -0.05, true}, {-0.03, 0.0, true},   {-0.03, 0.05, true}, {0.03, 0.05, true},  {0.01, 0.0, true},
        {0.03, 0.0, false},   {0.03, -0.05, false}, {0.0, 0.025, false}, {0.0, -0.05, false}, {0.07, 0.0, false},
    };
    for (const Place& place : places) {
        const auto map = truth(specimen, 1, 1, place.x, place.y, 0.002, 0.002);
        EXPECT_NEAR(map.height(0, 0), place.on_letter ? high : low, 1e-7) << place.x << ", " << place.y;
    }
}

TEST(ExampleSpecimens, ReadAsTheLetterF) {
    const std::filesystem::path folder = std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "specimens";
    const Image image{.file = folder / "letter_F.png", .pitch = 0.002, .height = 0.005};
    expect_letter(make({.shape = image}), 0, 0.005);
    specimen::Stl stl;
    stl.file = folder / "letter_F.stl";
    stl.centre = false;
    expect_letter(make({.shape = stl}), 0, 0.005);
    specimen::Gltf gltf;
    gltf.file = folder / "letter_F.glb";
    gltf.unit = 1000;
    gltf.centre = false;
    expect_letter(make({.shape = gltf}), 0, 0.005);
    // Centred, the mean of the uppermost surface is at 0. The letter covers (22 x 120 + 58 x 22 + 38 x 22) um^2 of 200
    // x 200; of the 1280 lines of points that measure it each edge may be one off.
    gltf.centre = true;
    const double share = (22.0 * 120 + 58 * 22 + 38 * 22) / 40000;
    const auto centred = truth(make({.shape = gltf}), 1, 1, -0.03, 0, 0.002, 0.002);
    EXPECT_NEAR(centred.height(0, 0), 0.005 * (1 - share), 0.005 * 0.002);
}

TEST_F(Files, ImageRowsStartAtTheTopAndValuesScale) {
    // The image has 3 x 2 points of 8 bits: the file's first row is the highest y.
    const auto file =
        write("map.pgm", std::string("P5 3 2 255\n") + '\x00' + '\x33' + '\xff' + '\x66' + '\x99' + '\xcc');
    const Grid<float> grid = read_image(file, {});
    ASSERT_EQ(grid.columns, 3);
    ASSERT_EQ(grid.rows, 2);
    EXPECT_FLOAT_EQ(grid(0, 1), 0.0f);
    EXPECT_FLOAT_EQ(grid(2, 1), 1.0f);
    EXPECT_FLOAT_EQ(grid(0, 0), 0.4f);
    EXPECT_FLOAT_EQ(grid(2, 0), 0.8f);
    const Image image{.file = file, .pitch = 0.01, .height = -0.1};
    const HeightField field = std::get<HeightField>(make({.shape = image}).geometry);
    EXPECT_FLOAT_EQ(field.heights(1, 1), -0.02f);
    EXPECT_DOUBLE_EQ(field.x_min, -0.01);
    EXPECT_DOUBLE_EQ(field.y_max(), 0.005);
    // Floats are taken as they are.
    Grid<float> heights(2, 2);
    heights.values = {1.5f, -2.5f, 1000.0f, 0.0f};
    surface::write_tiff(folder_ / "float.tif", heights);
    EXPECT_EQ(read_image(folder_ / "float.tif", {}).values, heights.values);
}

TEST_F(Files, TrianglesWithoutAreaAreDropped) {
    std::string text = ascii_stl();
    text.insert(text.find(" facet"), " facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 1 1\n vertex 2 2 2\n"
                                     " endloop\n endfacet\n");
    specimen::Stl stl;
    stl.file = write("line.stl", text);
    EXPECT_EQ(std::get<Mesh>(make({.shape = stl}).geometry).triangles.size(), faces.size());
}

std::string message_of(const Description& description) {
    try {
        make(description);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

struct BadFile {
    const char* file;
    std::string bytes;
    std::vector<std::string> message; // parts of it
};

TEST_F(Files, DamageIsNamedWithItsPlace) {
    const auto with_float = [](std::string bytes, std::size_t offset, float value) {
        std::memcpy(bytes.data() + offset, &value, sizeof value);
        return bytes;
    };
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const auto with_count = [](std::uint32_t count) {
        std::string bytes = binary_stl();
        std::memcpy(bytes.data() + 80, &count, sizeof count);
        bytes[0] = '\x01'; // surely not text
        return bytes;
    };
    const auto gltf = [](const std::function<void(Gltf&)>& change) {
        Gltf file;
        change(file);
        return file.text();
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const std::string flat = "solid flat\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 1 1 2\n"
                             "endloop\nendfacet\nendsolid\n";
    const std::vector<BadFile> cases = {
        {"none.stl", "", {"none.stl@0", "84"}},
        {"short.stl", std::string(50, '\x01'), {"short.stl@50", "84"}},
        {"cut.stl", with_count(4).substr(0, 200), {"cut.stl@80", "4 triangles in 200 bytes"}},
        {"count.stl", with_count(0xFFFFFFFFu), {"count.stl@80", "4294967295 triangles"}},
        {"nan.stl", with_float(binary_stl(), 84 + 12, nan), {"nan.stl@96", "triangle 0", "nan"}},
        {"inf.stl", with_float(binary_stl(), 84 + 50 + 12 + 16, inf), {"inf.stl@162", "triangle 1", "inf"}},
        {"empty.stl", std::string(84, '\0'), {"empty.stl", "0 triangles"}},
        {"solid.stl", "solid nothing\nendsolid nothing\n", {"solid.stl", "0 triangles"}},
        {"end.stl", ascii_stl().substr(0, 150), {"end.stl:", "the end of the file"}},
        {"word.stl", replaced(ascii_stl(), "vertex 0.000000", "vertex zero"), {"word.stl:4:", "`zero`", "finite"}},
        {"text.stl", replaced(ascii_stl(), "vertex 0.000000", "vertex nan"), {"text.stl:4:", "`nan`", "finite"}},
        {"loop.stl", replaced(ascii_stl(), "outer loop", "outer hoop"), {"loop.stl:3:", "`loop`"}},
        {"flat.stl", flat, {"footprint"}},
        {"none.gltf", "", {"none.gltf", "glTF 2.0"}},
        {"json.gltf", Gltf().text().substr(0, 100), {"json.gltf"}},
        {"cut.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12), {"cut.glb"}},
        {"count.gltf", gltf([](Gltf& g) { g.point_count = 2000000000; }), {"accessor 0", "2000000000 elements"}},
        {"view.gltf", gltf([](Gltf& g) { g.view_length = 4096; }), {"accessor 0"}},
        {"index.gltf", gltf([](Gltf& g) { g.first_index = 4; }), {"index 0", "below 4"}},
        {"position.gltf", gltf([](Gltf& g) { g.position = 7; }), {"accessor = 7"}},
        {"type.gltf", gltf([](Gltf& g) { g.position = 1; }), {"accessor 1", "positions"}},
        {"nan.gltf", gltf([&](Gltf& g) { g.first_coordinate = nan; }), {"nan.gltf", "vertex 0", "nan"}},
        {"lines.gltf", gltf([](Gltf& g) { g.mode = 1; }), {"0 triangles"}},
        {"cycle.gltf", gltf([](Gltf& g) { g.nodes = R"([{"children": [0]}])"; }), {"node 0", "tree"}},
        {"child.gltf", gltf([](Gltf& g) { g.nodes = R"([{"children": [9]}])"; }), {"node = 9"}},
        {"text.png", "no image", {"text.png"}},
        {"cut.pgm", "P5 4 200 255\n" + std::string(400, 'x'), {"cut.pgm", "4 x 200 pixels in 401 bytes", "800 bytes"}},
        {"huge.pgm", "P5 16000 16000 255\nonly this", {"huge.pgm", "16000 x 16000 pixels in 10 bytes", "256000000"}},
        {"vast.pgm", "P5 1000000 1000000 255\nonly this", {"vast.pgm", "1000000 x 1000000 points"}},
        {"zero.pgm", "P5 0 0 255\n", {"zero.pgm"}},
        {"one.pgm", "P5 1 1 255\nx", {"one.pgm", "2 x 2"}},
        {"colour.ppm", "P6 2 2 255\nabcabcabcabc", {"colour.ppm", "colour in pixel (0, 0)"}},
    };
    for (const BadFile& bad : cases) {
        const auto file = write(bad.file, bad.bytes);
        const std::string extension = file.extension().string();
        const std::string kind = extension == ".stl" ? "stl" : extension.starts_with(".gl") ? "gltf" : "image";
        const std::string message = message_of({.shape = test::shape_of(file, kind)});
        for (const std::string& part : bad.message) {
            EXPECT_THAT(message, HasSubstr(part)) << bad.file;
        }
        EXPECT_THAT(message, HasSubstr("expected")) << bad.file;
    }
    Grid<float> holes(2, 2, 1.0f);
    holes(1, 0) = nan;
    surface::write_tiff(folder_ / "nan.tif", holes);
    EXPECT_THAT(message_of({.shape = test::shape_of(folder_ / "nan.tif", "image")}),
                HasSubstr("nan in pixel (1, 1) from the top left"));
    for (const char* kind : {"stl", "gltf", "image"}) {
        Description d{.shape = test::shape_of(folder_ / "missing", kind)};
        d.where.file = "c.toml";
        d.where.line = 5;
        EXPECT_THAT(message_of(d), HasSubstr("c.toml:5: specimen.file = "));
        d.shape = test::shape_of(folder_, kind);
        EXPECT_THAT(message_of(d), HasSubstr("specimen.file"));
    }
}

template <class OneKind>
OneKind good() {
    return test::over<OneKind>(0.1, 0.001);
}
template <>
Step good() {
    auto step = test::over<Step>(0.1, 0.001);
    step.height = 0.01;
    return step;
}
template <>
Sphere good() {
    auto sphere = test::over<Sphere>(0.1, 0.001);
    sphere.radius = 0.1;
    sphere.height = 0.01;
    return sphere;
}
template <>
Sinusoid good() {
    auto wave = test::over<Sinusoid>(0.1, 0.001);
    wave.amplitude = 0.001;
    wave.period = 0.01;
    return wave;
}
template <>
Chirp good() {
    auto chirp = test::over<Chirp>(0.1, 0.001);
    chirp.amplitude = 0.001;
    chirp.period = chirp.period_stop = 0.01;
    return chirp;
}
template <>
Rough good() {
    auto rough = test::over<Rough>(0.1, 0.001);
    rough.random = {.sq = 0.001, .correlation_length = 0.005};
    return rough;
}

template <class OneKind>
void expect_refused(const std::function<void(OneKind&)>& change, const char* key) {
    auto kind = good<OneKind>();
    EXPECT_EQ(message_of({.shape = kind}), "no error");
    change(kind);
    EXPECT_THAT(message_of({.shape = kind}), HasSubstr(key));
}

TEST(Descriptions, ImpossibleShapesAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_refused<Plane>([](Plane& d) { d.size = 0; }, "specimen.size");
    expect_refused<Plane>([&](Plane& d) { d.size = nan; }, "specimen.size");
    expect_refused<Plane>([](Plane& d) { d.pitch = 0; }, "specimen.pitch");
    expect_refused<Plane>([](Plane& d) { d.pitch = 1; }, "specimen.pitch");
    expect_refused<Plane>([](Plane& d) { d.pitch = 1e-6; }, "specimen.pitch");
    expect_refused<Plane>([](Plane& d) { d.tilt_x = 1.6; }, "specimen.tilt");
    expect_refused<Step>([](Step& d) { d.wall = -1; }, "specimen.wall");
    expect_refused<Sphere>([](Sphere& d) { d.radius = -0.1; }, "specimen.radius");
    expect_refused<Sphere>([](Sphere& d) { d.height = -0.1; }, "specimen.height");
    expect_refused<Sinusoid>([](Sinusoid& d) { d.period = 0; }, "specimen.period");
    expect_refused<Chirp>([](Chirp& d) { d.period_stop = -1; }, "specimen.period_stop");
    expect_refused<Rough>([](Rough& d) { d.random.sq = -1; }, "specimen.sq");
    expect_refused<Rough>([](Rough& d) { d.random.correlation_length = 0; }, "specimen.correlation_length");
}

TEST(Descriptions, ImpossibleMaterialsAndRoughnessAreRefused) {
    const Description plane{.shape = good<Plane>()};
    Description d = plane;
    d.material = Material::henyey_greenstein(1.5);
    EXPECT_THAT(message_of(d), HasSubstr("specimen.material.g"));
    struct Bad {
        Roughness roughness;
        const char* key;
    };
    for (const Bad& bad :
         {Bad{{-1, 0.002, 0.001, 1}, "specimen.roughness.noise"}, Bad{{1, 1e9, 0.001, 1}, "specimen.roughness.kernel"},
          Bad{{1, 0.002, 0, 1}, "specimen.roughness.pitch"}}) {
        d = plane;
        d.roughness = bad.roughness;
        EXPECT_THAT(message_of(d), HasSubstr(bad.key));
    }
    const auto refused = [&](double shortest, double longest, const char* key) {
        d = plane;
        d.roughness = Roughness{0, 0.002, 0.001, 1};
        d.roughness->sq = 0.001;
        d.roughness->shortest = shortest;
        d.roughness->longest = longest;
        EXPECT_THAT(message_of(d), HasSubstr(key));
    };
    refused(0.001, 0.01, "specimen.roughness.shortest_wavelength_um");
    refused(0.004, 0.003, "specimen.roughness.longest_wavelength_um");
    refused(0.004, 1e9, "specimen.roughness.longest_wavelength_um");
    d.shape = specimen::Stl();
    d.roughness = std::nullopt;
    EXPECT_THAT(message_of(d), HasSubstr("specimen.file"));
    d.roughness = Roughness{1, 0.002, 0.001, 1};
    EXPECT_THAT(message_of(d), HasSubstr("specimen.roughness"));
}

} // namespace
} // namespace vkfv::specimen
