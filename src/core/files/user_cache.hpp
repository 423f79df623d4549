// A cache on disk, kept between runs, whose loss costs only time: compiled kernels, figures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// The cache's folder: XDG_CACHE_HOME/vkfv, else HOME/.cache/vkfv, else none.
std::optional<std::filesystem::path> cache_folder();

// The data cached under a name; empty if there are none, or if the file is damaged or another program's.
std::vector<std::byte> read_cached(std::string_view name);

// Caches data. The file is written beside and renamed, so that concurrent readers get the old or the new data. Failures
// (no folder, no permission, a full disk) are ignored, as they cost only time.
void write_cached(std::string_view name, std::span<const std::byte> data);

// Removes cached files whose names begin so, except the `most` that were written last.
void thin_out_cached(std::string_view beginning, std::size_t most);

} // namespace vkfv
