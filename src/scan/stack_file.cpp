#include "scan/stack_file.hpp"

#include "core/mathematics/units.hpp"
#include "images/tiff_stack.hpp"

#include <fmt/format.h>

namespace vkfv::scan {

namespace {

images::PixelBits bits_of(PixelType type) {
    return type == PixelType::uint16  ? images::PixelBits::uint16
           : type == PixelType::uint8 ? images::PixelBits::uint8
                                      : images::PixelBits::float32;
}

std::string bytes_of(const Grid<float>& values, PixelType type) {
    return type == PixelType::uint16  ? images::tiff_stack_values(rounded<std::uint16_t>(values))
           : type == PixelType::uint8 ? images::tiff_stack_values(rounded<std::uint8_t>(values))
                                      : images::tiff_stack_values(values);
}

} // namespace

void write_stack_file(ImageStore& store) {
    const StackDescription& description = store.description();
    const auto& positions = description.positions;
    images::TiffStack stack{.columns = description.columns,
                            .rows = description.rows,
                            .bits = bits_of(description.type),
                            .pitch = description.pitch * um_per_mm,
                            .first = positions.front() * um_per_mm,
                            .step = positions.size() > 1 ? (positions[1] - positions[0]) * um_per_mm : 0,
                            .notes = fmt::format("z_um={}\nvalues={}\nfirst_row=highest y\nstack={}\n",
                                                 micrometres_text(positions.front()), description.quantity,
                                                 description.digest),
                            .pages = {}};
    for (const double z : positions) {
        stack.pages.push_back(fmt::format("z_um={}", micrometres_text(z)));
    }
    store.results().write_in_parts(stack_file_name, [&](const AddBytes& add) {
        add(images::tiff_stack_head(stack));
        for (std::size_t image = 0; image < positions.size(); ++image) {
            add(bytes_of(read_frame(store.folder(), static_cast<int>(image), positions[image]), description.type));
        }
    });
}

std::uint64_t stack_file_bytes(std::uint64_t images, std::uint64_t pixels, PixelType type) {
    constexpr std::uint64_t directory = 1024; // bytes, more than a directory takes
    return images * (pixels * (type == PixelType::float32 ? 4u : type == PixelType::uint16 ? 2u : 1u) + directory);
}

} // namespace vkfv::scan
