#include "specimen/kinds/image.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "specimen/file_keys.hpp"
#include "specimen/files.hpp"
#include "specimen/lengths.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey image_pitch_key =
    for_example("1.0", NumberKey("pitch_um", NumberRange::positive(), needed, "Distance of the image's pixels."));
const NumberKey image_height_key = for_example(
    "4.0", NumberKey("height_um", NumberRange::finite(), needed, "Of white (of floats: of the value 1) over black."));
const FileKey image_file_key = needed_file_key("The image.");

} // namespace

std::vector<const Key*> Image::keys() {
    return {&image_file_key, &image_pitch_key, &image_height_key};
}

Image Image::read(const Section& section) {
    Image image;
    image.pitch = from_um(section.number(image_pitch_key));
    image.height = from_um(section.number(image_height_key));
    image.file = section.file(image_file_key);
    return image;
}

HeightField Image::heights(const SourceLocation& mention) const {
    require_um(positive(pitch), mention, "pitch_um", pitch,
               fmt::format("a length from {} to {} um", smallest_length * um_per_mm, largest_length * um_per_mm));
    require_um(std::isfinite(height), mention, "height_um", height, "a finite length");
    HeightField field;
    field.heights = read_image(file, mention);
    for (float& value : field.heights.values) {
        value = static_cast<float>(height * static_cast<double>(value));
    }
    field.pitch_x = field.pitch_y = pitch;
    const auto grid = PixelGrid::centred(field.heights.columns, field.heights.rows, pitch);
    field.x_min = grid.x0;
    field.y_min = grid.y0;
    return field;
}

} // namespace vkfv::specimen
