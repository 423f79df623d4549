// STL files and images that others made, on purpose or not, are read, or refused for the fault that they have.
#include "specimen/description.hpp"
#include "specimen/files.hpp"
#include "specimen/shapes.hpp"

#include "temporary_files.hpp"

#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif
#include <sys/stat.h>

#include <array>
#include <cmath>
#include <limits>

namespace vkfv::specimen {
namespace {

using test::raw;
using testing::AllOf;
using testing::HasSubstr;
using Hostile = test::TemporaryFiles;

// A cube of side 1, with its first vertex at another place.
std::vector<std::array<glm::vec3, 3>> cube(const glm::vec3& first = {0, 0, 0}) {
    const auto corner = [&](int k) {
        return k == 0
                   ? first
                   : glm::vec3(static_cast<float>(k & 1), static_cast<float>(k >> 1 & 1), static_cast<float>(k >> 2));
    };
    constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<std::array<glm::vec3, 3>> facets;
    for (const auto& face : faces) {
        facets.push_back({corner(face[0]), corner(face[1]), corner(face[2])});
        facets.push_back({corner(face[0]), corner(face[2]), corner(face[3])});
    }
    return facets;
}

std::string binary(const std::vector<std::array<glm::vec3, 3>>& facets) {
    std::string bytes(80, ' ');
    bytes += raw(static_cast<std::uint32_t>(facets.size()));
    for (const auto& facet : facets) {
        bytes += raw(glm::vec3(0)) + raw(facet[0]) + raw(facet[1]) + raw(facet[2]) + std::string(2, '\0');
    }
    return bytes;
}

std::string ascii(const std::string& line_end) {
    std::string text = "solid cube" + line_end;
    for (const auto& facet : cube()) {
        text += "facet normal 0 0 1" + line_end + "outer loop" + line_end;
        for (const glm::vec3& p : facet) {
            text += "vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + line_end;
        }
        text += "endloop" + line_end + "endfacet" + line_end;
    }
    return text + "endsolid cube" + line_end;
}

template <class Work>
std::string message_of(Work work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string stl_message(const std::string& bytes) {
    return message_of([&] { (void)parse_stl(bytes, "part.stl"); });
}

TEST_F(Hostile, StlWithAnyEndsOfLinesAndAByteOrderMarkIsRead) {
    for (const char* line_end : {"\n", "\r\n", "\r"}) {
        for (const char* mark : {"", "\xef\xbb\xbf"}) {
            const FileMesh mesh = parse_stl(mark + ascii(line_end), "part.stl");
            EXPECT_EQ(mesh.triangles.size(), 12u);
            EXPECT_EQ(mesh.vertices.size(), 8u);
        }
        std::string text = ascii(line_end);
        text.replace(text.rfind("outer"), 5, "inner");
        // The fault is in the last facet's second line: 1 + 11 * 7 + 2.
        EXPECT_THAT(stl_message(text), HasSubstr("part.stl:80:1: STL = `inner`: expected `outer`"));
    }
}

TEST_F(Hostile, StlThatIsNoneIsToldApart) {
    std::string text = ascii("\n");
    text.insert(200, 1, '\0');
    EXPECT_THAT(stl_message(text), HasSubstr("part.stl@200: STL = a byte of 0 within an ASCII STL: expected text"));
    std::string early = ascii("\n");
    early.insert(8, 1, '\0');
    EXPECT_THAT(stl_message(early), HasSubstr("part.stl@8: STL = a byte of 0"));
    std::string wide = "\xff\xfe";
    for (const char c : ascii("\n")) {
        wide += {c, '\0'};
    }
    EXPECT_THAT(stl_message(wide), AllOf(HasSubstr("text in UTF-16"), HasSubstr("Save the text as UTF-8")));
    EXPECT_THAT(
        stl_message(
            "\xef\xbb\xbf# another text, which is long enough for the header of a binary file, that is 84 bytes"),
        HasSubstr("text that does not begin with \"solid\""));
    EXPECT_THAT(
        stl_message("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# a mesh in another format, long enough for the header"),
        HasSubstr("part.stl@80: STL = neither ASCII"));
    // A damaged binary file is not taken for text by its header alone.
    std::string cut = binary(cube());
    cut.replace(0, 10, "solid cube");
    EXPECT_THAT(stl_message(cut.substr(0, 300)), HasSubstr("12 triangles in 300 bytes"));
}

Stl mesh_of(const std::filesystem::path& file) {
    Stl mesh;
    mesh.file = file;
    return mesh;
}

TEST_F(Hostile, VertexFarOffIsNamed) {
    const auto message = [&](float x) {
        return message_of([&] { (void)make({.shape = mesh_of(write("far.stl", binary(cube({x, 0, 0}))))}); });
    };
    EXPECT_THAT(message(1e30f), AllOf(HasSubstr("specimen.file"), HasSubstr("with a vertex at (1e+30, 0, 0) mm"),
                                      HasSubstr("expected coordinates up to 1000000 mm"), HasSubstr("specimen.unit")));
    EXPECT_THAT(message(-std::numeric_limits<float>::max()), HasSubstr("coordinates up to"));
    EXPECT_EQ(message(0), "no error");
    EXPECT_EQ(message(5), "no error");
}

TEST_F(Hostile, FacetsThatVanishAmongLargeCoordinatesAreRefusedOrWarnedOf) {
    // Facets of a micrometre stand beside one 900 m away: along x they are nothing in float.
    auto far = cube();
    for (auto& facet : far) {
        for (glm::vec3& vertex : facet) {
            vertex = 1e-3f * vertex;
        }
    }
    far.push_back({glm::vec3(900000, 0, 0), glm::vec3(900000, 1, 0), glm::vec3(900000, 0, 1)});
    const std::string message = message_of([&] { (void)make({.shape = mesh_of(write("far.stl", binary(far)))}); });
    EXPECT_THAT(message, AllOf(HasSubstr("of 13 triangles 8 lose their area"), HasSubstr("(900000, 0, 0) mm")));
}

TEST_F(Hostile, ForeignUnitsAreRefusedWhereNoDeviceHoldsThem) {
    Stl d = mesh_of(write("cube.stl", binary(cube())));
    d.unit = 1e7;
    EXPECT_THAT(message_of([&] { (void)make({.shape = d}); }), HasSubstr("coordinates up to 1000000 mm"));
    d.unit = 1e-12;
    EXPECT_THAT(message_of([&] { (void)make({.shape = d}); }), HasSubstr("a footprint in x and y"));
    auto step = test::over<Step>(0.1, 0.001);
    step.height = 1e30;
    EXPECT_THAT(message_of([&] { (void)make({.shape = step}); }),
                AllOf(HasSubstr("mm high"), HasSubstr("Correct the lengths")));
}

// The images are grey ramps of 300 x 200 pixels, in every format in use.
class HostileImages : public Hostile, public testing::WithParamInterface<const char*> {
  protected:
    std::string image() const {
        const auto file = folder_ / (std::string("map.") + GetParam());
        const auto output = OIIO::ImageOutput::create(file.string());
        OIIO::ImageSpec spec(300, 200, 1, OIIO::TypeDesc::UINT8);
        if (std::string_view(GetParam()) == "exr") {
            spec.format = OIIO::TypeDesc::FLOAT;
        }
        if (std::string_view(GetParam()) == "bmp") {
            spec.nchannels = 3;
        }
        std::vector<unsigned char> pixels;
        for (unsigned int k = 0; k < 300 * 200; ++k) {
            // The values are hard to pack, so that the data fill the file.
            const auto grey = static_cast<unsigned char>(k * k / 7 + k % 300);
            pixels.insert(pixels.end(), static_cast<std::size_t>(spec.nchannels), grey);
        }
        EXPECT_TRUE(output->open(file.string(), spec) && output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
                    output->close())
            << output->geterror();
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

TEST_P(HostileImages, CutOffAnywhereAreRefused) {
#ifdef __SANITIZE_ADDRESS__
    const __lsan::ScopedDisabler png_errors_jump_over_destructors_of_the_library;
#endif
    const std::string whole = image();
    EXPECT_EQ(message_of([&] { EXPECT_EQ(parse_image(whole, "map").columns, 300); }), "no error");
    for (int part = 0; part < 20; ++part) {
        const std::string cut = whole.substr(0, whole.size() * static_cast<std::size_t>(part) / 20);
        EXPECT_THAT(message_of([&] { (void)parse_image(cut, "map"); }), HasSubstr("map: ")) << part << " of 20";
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileImages, testing::Values("tif", "png", "jpg", "bmp", "pgm", "exr"));

TEST_F(Hostile, ImagesMadeToFillTheMemoryAreRefused) {
    EXPECT_THAT(message_of([&] { (void)parse_image("P5 16384 16384 255\nonly this", "map.pgm"); }),
                HasSubstr("16384 x 16384 pixels in 10 bytes: expected at least 268435456 bytes"));
    EXPECT_THAT(message_of([&] { (void)parse_image("P2 2 50000\n0\n1 2 3", "map.pgm"); }),
                HasSubstr("map.pgm: largest value = 0: expected from 1 to 65535"));
    EXPECT_THAT(message_of([&] { (void)parse_image("P2 2 # columns\n 2 9\n1 2 3", "map.pgm"); }),
                HasSubstr("2 x 2 pixels in 6 bytes: expected at least 8 bytes"));
    // The file packs zeros: more than 2^26 pixels in some kilobytes.
    const auto file = folder_ / "zeros.png";
    const auto output = OIIO::ImageOutput::create("png");
    ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(16384, 4097, 1, OIIO::TypeDesc::UINT8)));
    const std::vector<unsigned char> row(16384);
    for (int y = 0; y < 4097; ++y) {
        ASSERT_TRUE(output->write_scanline(y, 0, OIIO::TypeDesc::UINT8, row.data()));
    }
    ASSERT_TRUE(output->close());
    EXPECT_THAT(message_of([&] { (void)read_image(file, {}); }),
                AllOf(HasSubstr("16384 x 4097 pixels in"), HasSubstr("Crop or scale")));
    EXPECT_THAT(message_of([&] { (void)parse_image("no image at all", "map.xyz"); }),
                HasSubstr("a file of unknown kind"));
    EXPECT_THAT(message_of([&] { (void)parse_image("", "map"); }), HasSubstr("a file of unknown kind"));
}

TEST_F(Hostile, EveryFileIsARegularOne) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", folder_ / "zero");
    for (const char* kind : {"stl", "gltf", "image"}) {
        for (const auto& [name, found] : {std::pair{"pipe", "a named pipe"}, std::pair{"zero", "a device"}}) {
            const Shape shape = test::shape_of(folder_ / name, kind);
            EXPECT_THAT(message_of([&] { (void)make({.shape = shape}); }),
                        AllOf(HasSubstr("specimen.file = "), HasSubstr(found)));
        }
    }
    auto letters = test::over<Plateaus>(0.1, 0.001);
    letters.text = "F";
    letters.text_width = 0.05;
    letters.heights = {0.001};
    letters.font = (folder_ / "pipe").string();
    EXPECT_THAT(message_of([&] { (void)make({.shape = letters}); }),
                AllOf(HasSubstr("specimen.font"), HasSubstr("a named pipe")));
}

} // namespace
} // namespace vkfv::specimen
