// A table is read as a matrix and as points of a grid, with a scale, and without one where the header has it.
#include "surface_files/height_table.hpp"

#include "surface_fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    for (const surface::ImageScale& scale : {surface::ImageScale{}, surface::ImageScale{.pitch = 1e-3, .unit = 1e-3}})
        for (const char* name : {"a.csv", "a.xyz"})
            fuzzing::read_write_read(
                data, size,
                [&](std::string_view bytes, const std::filesystem::path& file) {
                    return file == "fuzzed" ? surface::parse_height_table(bytes, name, scale)
                                            : surface::parse_height_table(bytes, "a.csv", {});
                },
                [](const auto& map, const auto& provenance) { return surface::height_table(map, provenance); });
    return 0;
}
