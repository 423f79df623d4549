// Where the standard of glTF 2.0 lets a file change the triangles, the change is honoured or refused, never left out in
// silence.
#include "specimen/description.hpp"
#include "specimen/files.hpp"

#include "temporary_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cmath>
#include <sstream>
#include <thread>

namespace vkfv::specimen {
namespace {

using test::base64;
using test::raw;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using Gltf = test::TemporaryFiles;

const std::vector<glm::vec3> triangle = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0.5f}};

std::string floats(const std::vector<glm::vec3>& points) {
    std::string bytes;
    for (const glm::vec3& point : points) {
        bytes += raw(point);
    }
    return bytes;
}

// A glTF of one buffer with these bytes, and a triangle's positions at its beginning. Every part can be replaced.
struct Text {
    std::string asset = R"({"version": "2.0"})";
    std::string head = "";
    std::string nodes = R"([{"mesh": 0}])";
    std::string primitive = R"({"attributes": {"POSITION": 0}})";
    std::string mesh = "";
    std::string accessors = R"([{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}])";
    std::string views = R"([{"buffer": 0, "byteLength": 36}])";
    std::string bytes = floats(triangle);
    std::string buffers = "";

    std::string text() const {
        const std::string buffer = buffers.empty() ? R"([{"byteLength": )" + std::to_string(bytes.size()) +
                                                         R"(, "uri": "data:application/octet-stream;base64,)" +
                                                         base64(bytes) + "\"}]"
                                                   : buffers;
        return R"({"asset": )" + asset + head + R"(, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": )" + nodes +
               R"(, "meshes": [{"primitives": [)" + primitive + "]" + mesh + R"(}], "accessors": )" + accessors +
               R"(, "bufferViews": )" + views + R"(, "buffers": )" + buffer + "}";
    }
    // The text and its bytes as a binary container (GLB).
    std::string binary() const {
        Text inner = *this;
        inner.buffers = R"([{"byteLength": )" + std::to_string(bytes.size()) + "}]";
        std::string json = inner.text();
        json.resize((json.size() + 3) / 4 * 4, ' ');
        std::string chunk = bytes;
        chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
        const auto word = [](std::size_t number) { return raw(static_cast<std::uint32_t>(number)); };
        return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + chunk.size()) + word(json.size()) + "JSON" + json +
               word(chunk.size()) + std::string("BIN\0", 4) + chunk;
    }
    // Adds an accessor, after the positions.
    void add(const std::string& more, const std::string& accessor, const std::string& view_keys = "") {
        const std::size_t views_before = static_cast<std::size_t>(std::count(views.begin(), views.end(), '{'));
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        accessors.insert(accessors.size() - 1,
                         R"(, {"bufferView": )" + std::to_string(views_before) + ", " + accessor + "}");
        views.insert(views.size() - 1, R"(, {"buffer": 0, "byteOffset": )" + std::to_string(bytes.size()) +
                                           R"(, "byteLength": )" + std::to_string(more.size()) + view_keys + "}");
        bytes += more;
    }
};

Text with(const std::function<void(Text&)>& change) {
    Text text;
    change(text);
    return text;
}

std::string message_of(const std::string& bytes) {
    try {
        (void)parse_gltf(bytes, "part.gltf");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

// The log that some work leaves.
std::string log_of(const std::function<void()>& work) {
    std::ostringstream stream;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(stream)));
    work();
    spdlog::set_default_logger(before);
    return stream.str();
}

void expect_points(const FileMesh& mesh, const std::vector<glm::dvec3>& points) {
    ASSERT_EQ(mesh.vertices.size(), points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        EXPECT_NEAR(glm::length(mesh.vertices[k] - points[k]), 0, 1e-6) << k;
    }
}

const std::vector<glm::dvec3> plain = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0.5}};

TEST_F(Gltf, TextAndBinaryAreTheSame) {
    expect_points(parse_gltf(Text{}.text(), "part.gltf"), plain);
    expect_points(parse_gltf("\xef\xbb\xbf" + Text{}.text(), "part.gltf"), plain);
    expect_points(parse_gltf(Text{}.binary(), "part.glb"), plain);
    // The buffer lies beside the file, with blanks in its name.
    write("the points.bin", floats(triangle));
    const auto file = write(
        "beside.gltf", with([](Text& t) { t.buffers = R"([{"byteLength": 36, "uri": "the%20points.bin"}])"; }).text());
    expect_points(read_gltf(file, {}), plain);
}

struct Refusal {
    const char* name;
    std::string bytes;
    std::vector<std::string> message;
};

TEST_F(Gltf, WhatIsAskedForAndNotGivenIsRefused) {
    const auto required = [](const char* name) {
        return with([&](Text& t) { t.head = std::string(R"(, "extensionsRequired": [")") + name + "\"]"; }).text();
    };
    const auto nodes = [](const char* text) { return with([&](Text& t) { t.nodes = text; }).text(); };
    const auto asset = [](const char* text) { return with([&](Text& t) { t.asset = text; }).text(); };
    const auto primitive = [](const char* text) { return with([&](Text& t) { t.primitive = text; }).text(); };
    const auto accessors = [](const char* text) { return with([&](Text& t) { t.accessors = text; }).text(); };
    const auto views = [](const char* text) { return with([&](Text& t) { t.views = text; }).text(); };
    const auto buffers = [](const char* text) { return with([&](Text& t) { t.buffers = text; }).text(); };
    const auto indices = [](std::vector<std::uint16_t> values, const char* keys = "") {
        return with([&](Text& t) {
                   std::string bytes;
                   for (const std::uint16_t value : values) {
                       bytes += raw(value);
                   }
                   t.add(bytes, R"("componentType": 5123, "type": "SCALAR", "count": )" + std::to_string(values.size()),
                         keys);
                   t.primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
               })
            .text();
    };
    const std::vector<Refusal> cases = {
        {"required",
         required("EXT_unheard_of"),
         {"extensionsRequired = \"EXT_unheard_of\"", "EXT_mesh_gpu_instancing",
          "Export the file without this extension"}},
        {"draco", required("KHR_draco_mesh_compression"), {"not compressed", "without compression"}},
        {"meshopt", required("EXT_meshopt_compression"), {"not compressed"}},
        {"version 1",
         asset(R"({"version": "1.0"})"),
         {"asset.version = 1.0", "glTF 2.0", "Export the file as glTF 2.0"}},
        {"version 3", asset(R"({"version": "3.0"})"), {"asset.version = 3.0"}},
        {"no version", asset("{}"), {"asset.version = nothing"}},
        {"number", asset(R"({"version": 2.0})"), {"asset.version = 2.0", "a string"}},
        {"least version", asset(R"({"version": "2.0", "minVersion": "3.0"})"), {"asset.minVersion = 3.0"}},
        {"later minor", asset(R"({"version": "2.1", "minVersion": "2.1"})"), {"asset.minVersion = 2.1"}},
        {"matrix of 12",
         nodes(R"([{"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0]}])"),
         {"node 0.matrix = 12 numbers", "16 numbers"}},
        {"matrix and scale",
         nodes(R"([{"mesh": 0, "scale": [1,1,1], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])"),
         {"node 0.matrix", "either of them"}},
        {"matrix by rows",
         nodes(R"([{"mesh": 0, "matrix": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])"),
         {"node 0.matrix", "column after column"}},
        {"scale of 2", nodes(R"([{"mesh": 0, "scale": [1,1]}])"), {"node 0.scale = 2 numbers", "3 numbers"}},
        {"scale of words", nodes(R"([{"mesh": 0, "scale": ["1",1,1]}])"), {"node 0.scale = \"1\"", "finite numbers"}},
        {"rotation", nodes(R"([{"mesh": 0, "rotation": [0,0,0,0]}])"), {"node 0.rotation", "length 1"}},
        {"mesh by name", nodes(R"([{"mesh": "0"}])"), {"node 0.mesh = \"0\"", "an integer"}},
        {"no such mesh", nodes(R"([{"mesh": 1}])"), {"mesh = 1", "an index below 1"}},
        {"children", nodes(R"([{"children": {}}])"), {"node 0.children", "an array of integers"}},
        {"skin", nodes(R"([{"mesh": 0, "skin": 0}])"), {"node 0.skin", "Apply the skeleton's pose"}},
        {"four indices",
         indices({0, 1, 2, 0}),
         {"mesh 0.primitives[0].indices = 4 vertices", "three for every triangle"}},
        {"index beyond", indices({0, 1, 3}), {"index 2 = 3", "an index below 3"}},
        {"spaced indices", indices({0, 1, 2, 0, 0, 0}, R"(, "byteStride": 4)"), {"byteStride = 4", "without gaps"}},
        {"mode 7", primitive(R"({"attributes": {"POSITION": 0}, "mode": 7})"), {".mode = 7", "0 to 6"}},
        {"mode 4.5", primitive(R"({"attributes": {"POSITION": 0}, "mode": 4.5})"), {".mode = 4.5", "an integer"}},
        {"indices as text",
         primitive(R"({"attributes": {"POSITION": 0}, "indices": "0"})"),
         {".indices = \"0\"", "an integer"}},
        {"floats as indices",
         primitive(R"({"attributes": {"POSITION": 0}, "indices": 0})"),
         {"accessor 0", "scalar indices"}},
        {"two points of a strip",
         with([](Text& t) {
             t.primitive = R"({"attributes": {"POSITION": 0}, "mode": 5})";
             t.accessors = R"([{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 2}])";
         }).text(),
         {"2 vertices", "at least three"}},
        {"shorts",
         accessors(R"([{"bufferView": 0, "componentType": 5122, "type": "VEC3", "count": 3}])"),
         {"accessor 0 = type VEC3 of components 5122", "positions of three floats"}},
        {"vec4", accessors(R"([{"bufferView": 0, "componentType": 5126, "type": "VEC4", "count": 3}])"), {"type VEC4"}},
        {"count 0",
         accessors(R"([{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 0}])"),
         {"count = 0"}},
        {"count -1",
         accessors(R"([{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": -1}])"),
         {"count = -1", "an integer"}},
        {"compressed",
         accessors(R"([{"componentType": 5126, "type": "VEC3", "count": 3}])"),
         {"accessor 0.bufferView = nothing", "without compression"}},
        {"beyond the view",
         accessors(R"([{"bufferView": 0, "byteOffset": 4, "componentType": 5126, "type": "VEC3", "count": 3}])"),
         {"accessor 0 = 3 elements of 12 bytes at 4"}},
        {"stride 8",
         views(R"([{"buffer": 0, "byteLength": 36, "byteStride": 8}])"),
         {"buffer view 0.byteStride = 8", "from 12"}},
        {"beyond the buffer", views(R"([{"buffer": 0, "byteOffset": 4, "byteLength": 36}])"), {"inside the 36 bytes"}},
        {"no buffer", views(R"([{"buffer": 1, "byteLength": 36}])"), {"buffer = 1", "an index below 1"}},
        {"no uri", buffers(R"([{"byteLength": 36}])"), {"buffer 0.uri = nothing", "within a .glb"}},
        {"host",
         buffers(R"([{"byteLength": 36, "uri": "https://a.example/b.bin"}])"),
         {"buffer 0.uri", "a relative path"}},
        {"absolute", buffers(R"([{"byteLength": 36, "uri": "/dev/zero"}])"), {"buffer 0.uri", "a relative path"}},
        {"base64",
         buffers(R"([{"byteLength": 36, "uri": "data:application/octet-stream;base64,AA*A"}])"),
         {"buffer 0.uri", "whole base64 digits"}},
        {"short buffer",
         buffers(R"([{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAA"}])"),
         {"buffer 0.uri", "of 36 bytes"}},
        {"no JSON", "{\n  \"asset\": nix}", {"part.gltf:2:13", "no valid JSON"}},
        {"cut", Text{}.text().substr(0, 50), {"part.gltf:1:", "the end of the JSON text"}},
        {"array", "[]", {"no JSON object"}},
        {"binary of version 1", "glTF" + raw(1u) + raw(28u) + std::string(16, ' '), {"part.gltf@4", "version 1"}},
        {"cut binary", Text{}.binary().substr(0, 100), {"part.gltf@8", "in a file of 100"}},
        {"long chunk",
         "glTF" + raw(2u) + raw(20u) + raw(0xffffffffu) + "JSON",
         {"part.gltf@12", "a chunk of 4294967295 bytes"}},
    };
    for (const Refusal& refusal : cases) {
        const std::string message = message_of(refusal.bytes);
        for (const std::string& part : refusal.message) {
            EXPECT_THAT(message, HasSubstr(part)) << refusal.name;
        }
    }
}

TEST_F(Gltf, ExtensionsOfAppearanceAndLaterMinorVersionsAreRead) {
    for (const char* name :
         {"KHR_materials_unlit", "KHR_texture_basisu", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"}) {
        expect_points(parse_gltf(with([&](Text& t) {
                                     t.head = std::string(R"(, "extensionsRequired": [")") + name + "\"]";
                                 }).text(),
                                 "part.gltf"),
                      plain);
    }
    for (const char* asset : {R"({"version": "2.1"})", R"({"version": "3.0", "minVersion": "2.0"})"}) {
        expect_points(parse_gltf(with([&](Text& t) { t.asset = asset; }).text(), "part.gltf"), plain);
    }
    // An extension that is used but not required may be unknown: the file is whole without it.
    expect_points(
        parse_gltf(with([](Text& t) { t.head = R"(, "extensionsUsed": ["EXT_unheard_of"])"; }).text(), "part.gltf"),
        plain);
}

TEST_F(Gltf, InstancesStandWhereTheyArePlaced) {
    Text text;
    text.add(floats({{10, 0, 0}, {0, 20, 0}}), R"("componentType": 5126, "type": "VEC3", "count": 2)");
    // The rotations are none, and 90 degrees about z, as normalised shorts.
    std::string rotations;
    for (const double part : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}) {
        rotations += raw(static_cast<std::int16_t>(std::lround(part * 32767)));
    }
    text.add(rotations, R"("componentType": 5122, "normalized": true, "type": "VEC4", "count": 2)");
    text.add(floats({{1, 1, 1}, {2, 3, 4}}), R"("componentType": 5126, "type": "VEC3", "count": 2)");
    const std::string attributes = R"({"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3, "_ID": 0})";
    text.nodes =
        R"([{"mesh": 0, "translation": [0, 0, 100], "extensions": {"EXT_mesh_gpu_instancing": {"attributes": )" +
        attributes + "}}}]";
    for (const char* head : {R"(, "extensionsRequired": ["EXT_mesh_gpu_instancing"])", ""}) {
        text.head = head;
        const FileMesh mesh = parse_gltf(text.text(), "part.gltf");
        ASSERT_EQ(mesh.triangles.size(), 2u);
        // The second instance is scaled, then turned (x to y and y to -x), then moved, and then moved as its node is.
        const std::vector<glm::dvec3> expected = {{10, 0, 100}, {11, 0, 100}, {10, 2, 100.5},
                                                  {0, 20, 100}, {0, 22, 100}, {-6, 20, 102}};
        for (std::size_t k = 0; k < expected.size(); ++k) {
            EXPECT_NEAR(glm::length(mesh.vertices[k] - expected[k]), 0, 1e-3) << k; // the vertices are 16-bit integers
        }
    }
    const auto refused = [&](const std::string& from, const std::string& to) {
        Text other = text;
        other.nodes.replace(other.nodes.find(from), from.size(), to);
        return message_of(other.text());
    };
    EXPECT_THAT(refused("\"SCALE\": 3", "\"SCALE\": 0"), HasSubstr("SCALE = 3 elements: expected 2"));
    EXPECT_THAT(refused(attributes, "{}"), HasSubstr("no TRANSLATION, ROTATION or SCALE"));
    EXPECT_THAT(refused("\"TRANSLATION\": 1", "\"TRANSLATION\": \"1\""), HasSubstr("TRANSLATION = \"1\""));
}

TEST_F(Gltf, QuantisedPositionsNeedTheirExtension) {
    Text text;
    text.bytes.clear();
    text.views = R"([{"buffer": 0, "byteLength": 24, "byteStride": 8}])";
    for (const auto& [x, y, z] : {std::tuple{0, 0, 0}, std::tuple{32767, 0, 0}, std::tuple{0, -32768, 16384}}) {
        text.bytes += raw(static_cast<std::int16_t>(x)) + raw(static_cast<std::int16_t>(y)) +
                      raw(static_cast<std::int16_t>(z)) + std::string(2, '\0');
    }
    text.accessors = R"([{"bufferView": 0, "componentType": 5122, "normalized": true, "type": "VEC3", "count": 3}])";
    EXPECT_THAT(message_of(text.text()), HasSubstr("positions of three floats"));
    text.head = R"(, "extensionsRequired": ["KHR_mesh_quantization"])";
    expect_points(parse_gltf(text.text(), "part.gltf"), {{0, 0, 0}, {1, 0, 0}, {0, -1, 16384.0 / 32767}});
    text.accessors = R"([{"bufferView": 0, "componentType": 5122, "type": "VEC3", "count": 3}])";
    expect_points(parse_gltf(text.text(), "part.gltf"), {{0, 0, 0}, {32767, 0, 0}, {0, -32768, 16384}});
}

TEST_F(Gltf, MorphTargetsCountByTheirWeights) {
    Text text;
    text.add(floats({{0, 0, 4}, {0, 8, 0}, {1, 1, 1}}), R"("componentType": 5126, "type": "VEC3", "count": 3)");
    text.primitive = R"({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}, {"NORMAL": 1}]})";
    expect_points(parse_gltf(text.text(), "part.gltf"), plain); // without weights they are 0
    const std::vector<glm::dvec3> half = {{0, 0, 2}, {1, 4, 0}, {0.5, 2.5, 1}};
    text.mesh = R"(, "weights": [0.5, 1])";
    expect_points(parse_gltf(text.text(), "part.gltf"), half);
    text.mesh = R"(, "weights": [0, 0])";
    text.nodes = R"([{"mesh": 0, "weights": [0.5, 0]}])";
    expect_points(parse_gltf(text.text(), "part.gltf"), half);
    text.nodes = R"([{"mesh": 0, "weights": [0.5]}])";
    EXPECT_THAT(message_of(text.text()), HasSubstr("targets = 2 of them, with 1 weights"));
}

TEST_F(Gltf, SparseValuesReplaceThoseOfTheBuffer) {
    Text text;
    text.add(raw(std::uint8_t{1}), R"("componentType": 5121, "type": "SCALAR", "count": 1)");
    text.add(floats({{7, 8, 9}}), R"("componentType": 5126, "type": "VEC3", "count": 1)");
    const std::string sparse = R"("sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, )"
                               R"("values": {"bufferView": 2}})";
    text.accessors = R"([{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, )" + sparse + "}]";
    expect_points(parse_gltf(text.text(), "part.gltf"), {{0, 0, 0}, {7, 8, 9}, {0, 2, 0.5}});
    text.accessors = R"([{"componentType": 5126, "type": "VEC3", "count": 3, )" + sparse + "}]";
    expect_points(parse_gltf(text.text(), "part.gltf"), {{0, 0, 0}, {7, 8, 9}, {0, 0, 0}});
    text.accessors = R"([{"componentType": 5126, "type": "VEC3", "count": 1, )" + sparse + "}]";
    EXPECT_THAT(message_of(text.text()), HasSubstr("sparse.indices = 1 as number 0"));
    text.accessors = R"([{"componentType": 5126, "type": "VEC3", "count": 3000000000, )" + sparse + "}]";
    EXPECT_THAT(message_of(text.text()), HasSubstr("at most 16777216 elements without a buffer view"));
}

TEST_F(Gltf, WhatLeavesTheTrianglesAloneIsWarnedOf) {
    const Text lines = with([](Text& t) {
        t.head = R"(, "animations": [{}], "skins": [{}])";
        t.primitive =
            R"({"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 0}, "mode": 1}, {"attributes": {}})";
    });
    const std::string log = log_of([&] { expect_points(parse_gltf(lines.text(), "part.gltf"), plain); });
    EXPECT_THAT(log, HasSubstr("1 primitives of points and lines are left out"));
    EXPECT_THAT(log, HasSubstr("1 primitives without positions are left out"));
    EXPECT_THAT(log, HasSubstr("its animations are left out"));
    EXPECT_THAT(log_of([&] { (void)parse_gltf(Text{}.text(), "part.gltf"); }), IsEmpty());
}

// A mesh is placed so often that it does not fit into memory, from a file of some kilobytes.
TEST_F(Gltf, CopiesAreCountedBeforeTheyAreMade) {
    Text text;
    constexpr int points = 30000;
    text.bytes = std::string(12 * points, '\0');
    text.views = R"([{"buffer": 0, "byteLength": )" + std::to_string(12 * points) + "}]";
    text.accessors =
        R"([{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" + std::to_string(points) + "}]";
    text.add(std::string(1200000, '\0'), R"("componentType": 5126, "type": "VEC3", "count": 100000)");
    text.nodes = R"([{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}])";
    EXPECT_THAT(message_of(text.text()),
                AllOf(HasSubstr("node 0.mesh = 10000 triangles and 30000 vertices, 100000 times"),
                      HasSubstr("at most 67108864 of each in all")));
}

// Does the work on a stack of so many bytes.
void on_stack(std::size_t bytes, const std::function<void()>& work) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, bytes);
    pthread_t thread;
    const auto run = [](void* given) -> void* {
        (*static_cast<const std::function<void()>*>(given))();
        return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, run, const_cast<std::function<void()>*>(&work)), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

TEST_F(Gltf, ChainsOfNodesAndNestedExtrasNeedNoStack) {
    constexpr int links = 20000;
    std::string nodes = "[";
    for (int k = 0; k + 1 < links; ++k) {
        nodes += R"({"translation": [0, 0, 1], "children": [)" + std::to_string(k + 1) + "]},";
    }
    nodes += R"({"mesh": 0}])";
    const std::string chain = with([&](Text& t) { t.nodes = nodes; }).text();
    const auto nested = [](int depth, const std::string& open, const std::string& close) {
        std::string extras;
        for (int k = 0; k < depth; ++k) {
            extras += open;
        }
        extras += "1";
        for (int k = 0; k < depth; ++k) {
            extras += close;
        }
        return with([&](Text& t) { t.head = ", \"extras\": " + extras; });
    };
    on_stack(256 << 10, [&] {
        expect_points(parse_gltf(chain, "chain.gltf"), {{0, 0, links - 1}, {1, 0, links - 1}, {0, 2, links - 0.5}});
        for (const auto& [open, close] : {std::pair{"[", "]"}, std::pair{"{\"a\":", "}"}}) {
            EXPECT_EQ(message_of(nested(90, open, close).text()), "no error");
            EXPECT_THAT(message_of(nested(20000, open, close).text()), HasSubstr("part.gltf:1:"));
            EXPECT_THAT(message_of(nested(20000, open, close).text()),
                        HasSubstr("JSON = brackets nested 101 deep: expected at most 100 levels of brackets. Remove"));
            EXPECT_THAT(message_of(nested(20000, open, close).binary()), HasSubstr("part.gltf@"));
        }
        // Brackets within strings are no nesting.
        EXPECT_EQ(
            message_of(with([](Text& t) { t.head = R"(, "extras": "\"[[[)" + std::string(1000, '[') + "\""; }).text()),
            "no error");
    });
}

TEST_F(Gltf, BuffersAreRegularFiles) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", folder_ / "zero");
    std::filesystem::create_directory(folder_ / "folder");
    const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    const std::string name = (folder_ / "socket").string();
    ASSERT_LT(name.size(), sizeof address.sun_path);
    name.copy(address.sun_path, name.size());
    ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    for (const auto& [uri, found] :
         {std::pair{"pipe", "a named pipe"}, std::pair{"zero", "a device"}, std::pair{"folder", "a directory"},
          std::pair{"socket", "a socket"}, std::pair{"absent.bin", "no such file"}}) {
        const auto file = write(
            "part.gltf",
            with([&](Text& t) { t.buffers = std::string(R"([{"byteLength": 36, "uri": ")") + uri + "\"}]"; }).text());
        try {
            (void)read_gltf(file, {});
            ADD_FAILURE() << uri;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(found));
            EXPECT_THAT(error.what(), HasSubstr("part.gltf: buffer 0.uri"));
        }
    }
    close(listener);
    // Buffers and images that no triangle needs are not opened.
    const auto file = write("unused.gltf", with([](Text& t) {
                                               t.head = R"(, "images": [{"uri": "pipe"}])";
                                               t.buffers = R"([{"byteLength": 36, "uri": "a.bin"}, )"
                                                           R"({"byteLength": 1, "uri": "pipe"}])";
                                           }).text());
    write("a.bin", floats(triangle));
    expect_points(read_gltf(file, {}), plain);
}

} // namespace
} // namespace vkfv::specimen
