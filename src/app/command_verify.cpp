#include "app/commands.hpp"

#include "core/files/result_folder.hpp"
#include "scan/stack_identity.hpp"
#include "scan/store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace vkfv::app {

Command verify_command() {
    return {.name = "verify",
            .summary =
                "Check that the files of a stack, a sweep or other results are whole and those that were written",
            .operands = {{"FOLDER", "Folder of results", into(&CommandOptions::file)}},
            .run = run_verify,
            .example = "vkfv verify demo"};
}

namespace {

namespace fs = std::filesystem;

bool has(const fs::path& folder, std::string_view name) {
    std::error_code none;
    return fs::exists(folder / name, none);
}

// Those that hold a list of checksums or a stack: the folder itself and those below it, in order.
std::vector<fs::path> result_folders(const fs::path& folder) {
    std::vector<fs::path> folders;
    const auto add = [&](const fs::path& candidate) {
        if (has(candidate, checksums_name) || has(candidate, scan::configuration_name)) {
            folders.push_back(candidate);
        }
    };
    add(folder);
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_directory()) {
            add(entry.path());
        }
    }
    std::ranges::sort(folders);
    return folders;
}

} // namespace

void run_verify(const CommandOptions& options) {
    std::error_code none;
    if (!fs::is_directory(options.file, none)) {
        throw InputError(
            {{.file = options.file}, "", "no such folder", "the output folder of a command", "Check the path."});
    }
    const auto folders = result_folders(options.file);
    if (folders.empty()) {
        throw InputError(
            {{.file = options.file},
             "",
             fmt::format("neither {} nor {}, here or in a folder below", checksums_name, scan::configuration_name),
             "the output folder of --stack, --sweep, --topography, --compare or --bench",
             "Give the folder that holds the results."});
    }
    std::size_t files = 0;
    std::vector<std::string> sentences;
    for (const auto& folder : folders) {
        auto check = check_by_checksums(folder);
        if (has(folder, scan::configuration_name)) {
            check.add(scan::check_images(folder));
        }
        files += check.files.size();
        for (const auto& [file, what] : check.damages) {
            sentences.push_back(fmt::format("{}: {}", (folder / file).string(), what));
        }
        if (!has(folder, checksums_name)) {
            fmt::print("{}: not finished: its images are checked, and there are no results yet\n", folder.string());
        }
    }
    for (const std::string& sentence : sentences) {
        fmt::print("{}\n", sentence);
    }
    fmt::print("{} files checked in {}, {} damaged\n", files, options.file.string(), sentences.size());
    if (!sentences.empty()) {
        throw RunError(
            fmt::format("{}: {} of its files are not those that were written, the first: {}. Run the command that "
                        "made them again: it keeps what is whole",
                        options.file.string(), sentences.size(), sentences.front()));
    }
}

} // namespace vkfv::app
