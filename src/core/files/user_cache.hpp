// What is kept on disk from run to run and costs only time where it is lost: compiled kernels, figures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// The folder for files that may be lost: XDG_CACHE_HOME/vkfv, else HOME/.cache/vkfv, else none.
std::optional<std::filesystem::path> cache_folder();

// What was kept under the name; empty if nothing was, or if the file is damaged or another program's.
std::vector<std::byte> read_cached(std::string_view name);

// Keeps the data, written aside and renamed, so that who reads at the same time reads one or the other. What cannot be
// kept (no folder, no rights, a full disk) is not: that costs time, nothing else.
void write_cached(std::string_view name, std::span<const std::byte> data);

// Of those whose names begin so, all but the `most` that were written last are removed.
void thin_out_cached(std::string_view beginning, std::size_t most);

} // namespace vkfv
