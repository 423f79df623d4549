#include "app/commands.hpp"

#include "core/files/result_folder.hpp"
#include "core/messages/safe_text.hpp"
#include "scan/repair.hpp"
#include "scan/stack_identity.hpp"
#include "scan/store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace vkfv::app {

namespace {

struct VerifyOptions {
    bool repair = false;
};

} // namespace

Command verify_command() {
    const Option repair = {.name = "--repair",
                           .value = "",
                           .description =
                               "Write a stack's lost or changed stack.toml again from its copy, if the images "
                               "and the ledger agree with it; the old one is kept beside it, and results "
                               "say that the stack was repaired",
                           .target = into(&VerifyOptions::repair)};
    return {.name = "verify",
            .summary =
                "Check that the files of a stack, a sweep or other results are whole and those that were written",
            .operands = {{"FOLDER", "Folder of results", into(&CommandOptions::file)}},
            .options = {repair},
            .run = run_verify,
            .example = "vkfv verify demo"};
}

namespace {

namespace fs = std::filesystem;

bool has(const fs::path& folder, std::string_view name) {
    std::error_code none;
    return fs::exists(folder / name, none);
}

// The folders that hold a list of checksums or a stack, in order: the folder itself and all folders below it.
std::vector<fs::path> result_folders(const fs::path& folder) {
    std::vector<fs::path> folders;
    const auto add = [&](const fs::path& candidate) {
        if (has(candidate, checksums_name) || has(candidate, scan::configuration_name) ||
            has(candidate, scan::configuration_copy_name)) {
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

// Tells whether the damaged files include the configuration of a stack.
bool lacks_configuration(const Check& check) {
    return std::ranges::any_of(check.damages,
                               [](const Damage& damage) { return damage.file == scan::configuration_name; });
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
             "the output folder of vkfv stack, sweep, topography, compare or bench",
             "Give the folder that holds the results."});
    }
    std::size_t files = 0;
    std::vector<std::string> sentences;
    bool repairable = false;
    for (const auto& folder : folders) {
        if (options.of<VerifyOptions>().repair && has(folder, scan::configuration_copy_name) && scan::repair(folder)) {
            print_text(fmt::format("{}: written again; what was there is {}\n",
                                   safe_line((folder / scan::configuration_name).string()), scan::before_repair_name));
        }
        auto check = check_by_checksums(folder);
        if (has(folder, scan::configuration_name)) {
            check.add(scan::check_images(folder));
        }
        repairable = repairable || (has(folder, scan::configuration_copy_name) && lacks_configuration(check));
        files += check.files.size();
        for (const auto& [file, what] : check.damages) {
            sentences.push_back(fmt::format("{}: {}", safe_line((folder / file).string()), what));
        }
        if (!has(folder, checksums_name)) {
            print_text(fmt::format("{}: not finished: its images are checked, and there are no results yet\n",
                                   safe_line(folder.string())));
        }
    }
    for (const std::string& sentence : sentences) {
        print_text(sentence + "\n");
    }
    print_text(
        fmt::format("{} files checked in {}, {} damaged\n", files, safe_line(options.file.string()), sentences.size()));
    if (!sentences.empty()) {
        throw RunError(fmt::format("{}: {} of its files are not those that were written, the first: {}. {}",
                                   options.file.string(), sentences.size(), sentences.front(),
                                   repairable ? fmt::format("vkfv verify {} --repair writes stack.toml again, if the "
                                                            "images are whole",
                                                            options.file.string())
                                              : "Run the command that made them again: it keeps what is whole"));
    }
}

} // namespace vkfv::app
