// How much disk space a stack needs.
#pragma once

#include "configuration/configuration.hpp"
#include "scan/store.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace vkfv::measurement {

// Bytes, of one image and of all that its evaluation writes; the report's and pictures' share is an estimate.
std::uint64_t image_bytes(ImageSize pixels);
std::uint64_t results_bytes(const Configuration& configuration);

// Of the disk that the folder is or will be on, for this user.
std::uint64_t free_bytes(const std::filesystem::path& folder);

// Throws RunError, with the numbers, where the images that the store lacks, or the results, will not fit. results:
// bytes.
void require_space(const scan::ImageStore& store, std::uint64_t results);

// "3.2 GB": decimal, as disks are sold.
std::string bytes_text(std::uint64_t bytes);

} // namespace vkfv::measurement
