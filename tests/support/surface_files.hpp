// Surfaces and images as files, for tests.
#pragma once

#include "core/files/file.hpp"
#include "images/image_file.hpp"
#include "surface_files/height_image.hpp"
#include "surface_files/surface_file.hpp"

namespace vkfv::surface {

inline void write_surface(const std::filesystem::path& path, const HeightMap& map, const Provenance& provenance = {}) {
    write_file(path, surface_bytes(path, map, provenance));
}

inline void write_height_map(const std::filesystem::path& path, const HeightMap& map) {
    write_file(path, height_map_bytes(map));
}

inline HeightMap read_height_map(const std::filesystem::path& path) {
    return read_surface(path).map;
}

template <class Image>
void write_tiff(const std::filesystem::path& path, const Image& image, const images::ImageTags& tags = {}) {
    write_file(path, images::tiff_bytes(image, tags));
}

} // namespace vkfv::surface
