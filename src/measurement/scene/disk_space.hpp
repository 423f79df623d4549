// The disk space that a stack needs, and the space that there is.
#pragma once

#include "configuration/configuration.hpp"
#include "scan/store.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace vkfv::measurement {

// The bytes of one image, and of all files that an evaluation writes. The share of the report and of pictures is an
// estimate.
std::uint64_t image_bytes(ImageSize pixels);
std::uint64_t results_bytes(const Configuration& configuration);

// The free bytes, for this user, on the disk that the folder is or will be on.
std::uint64_t free_bytes(const std::filesystem::path& folder);

// Throws RunError, with the numbers, where the images that the store lacks, or the results, will not fit on the disk.
// results: bytes.
void require_space(const scan::ImageStore& store, std::uint64_t results);

// A number of bytes as "3.2 GB", with decimal units as disks are sold.
std::string bytes_text(std::uint64_t bytes);

} // namespace vkfv::measurement
