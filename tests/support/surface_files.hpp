// Surfaces and images as files, for tests.
#pragma once

#include "core/file.hpp"
#include "surface/image_file.hpp"
#include "surface/surface_file.hpp"

namespace vkfv::surface {

inline void write_surface(const std::filesystem::path& path, const HeightMap& map, const Provenance& provenance = {}) {
    write_file(path, surface_bytes(path, map, provenance));
}

inline void write_height_map(const std::filesystem::path& path, const HeightMap& map) {
    write_file(path, height_map_bytes(map));
}

template <class Image>
void write_tiff(const std::filesystem::path& path, const Image& image, const ImageTags& tags = {}) {
    write_file(path, tiff_bytes(image, tags));
}

} // namespace vkfv::surface
