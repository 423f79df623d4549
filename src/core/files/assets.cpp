#include "core/files/assets.hpp"

#include "core/files/installation.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace vkfv {

namespace fs = std::filesystem;

namespace {

const fs::path assets_name = "assets";

fs::path absolute_folder(const fs::path& path) {
    std::error_code none;
    return fs::absolute(path, none).lexically_normal();
}

std::optional<fs::path> chosen_assets() {
    const char* variable = std::getenv("VKFV_ASSETS");
    if (variable == nullptr || *variable == '\0') {
        return std::nullopt;
    }
    std::error_code none;
    if (!fs::is_directory(variable, none)) {
        throw InputError(
            {.where = {.file = "environment"},
             .key = "VKFV_ASSETS",
             .found = fmt::format("\"{}\"", variable),
             .expected = "a folder with objectives, tube_lenses, illuminators, glasses, specimens or stacks",
             .remedy = "Correct it, or unset it to use the assets that came with the program."});
    }
    return absolute_folder(variable);
}

// The third of asset_folders(), with links resolved; none if the program was copied without it.
std::optional<fs::path> installed_assets() {
    static const auto once = []() -> std::optional<fs::path> {
        const auto found = find_installed("share/vkfv");
        return found ? std::optional(fs::canonical(*found)) : std::nullopt;
    }();
    return once;
}

bool names_a_path(const std::string& name) {
    return name.ends_with(".toml");
}

} // namespace

std::vector<fs::path> asset_folders(const fs::path& base) {
    std::vector<fs::path> folders;
    if (const auto chosen = chosen_assets()) {
        folders.push_back(*chosen);
    }
    if (!base.empty()) {
        for (const auto& beside : with_parents(absolute_folder(base))) {
            folders.push_back(beside / assets_name);
        }
    }
    if (const auto installed = installed_assets()) {
        folders.push_back(*installed);
    }
    return folders;
}

std::optional<fs::path> find_asset(const std::string& name, const fs::path& folder, const fs::path& base) {
    std::error_code none;
    if (names_a_path(name)) {
        const auto path = base / name;
        return fs::is_regular_file(path, none) ? std::optional(path) : std::nullopt;
    }
    for (const auto& assets : asset_folders(base)) {
        if (auto path = assets / folder / (name + ".toml"); fs::is_regular_file(path, none)) {
            return path;
        }
    }
    return std::nullopt;
}

std::string searched_for_asset(const std::string& name, const fs::path& folder, const fs::path& base) {
    if (names_a_path(name)) {
        return fmt::format("looked for {}", (absolute_folder(base) / name).string());
    }
    const auto relative = folder / (name + ".toml");
    const auto chosen = chosen_assets();
    const auto installed = installed_assets();
    const std::string beside =
        base.empty() ? "" : fmt::format(" beside {}, beside every folder above it,", absolute_folder(base).string());
    return fmt::format("looked for {}{}{}{} {}", chosen ? fmt::format("{}, for ", (*chosen / relative).string()) : "",
                       (assets_name / relative).generic_string(), beside, base.empty() ? "" : " and",
                       installed ? "in " + installed->string()
                                 : "nowhere else, as vkfv's own folder share/vkfv is missing: install vkfv again");
}

std::vector<std::string> asset_names(const fs::path& folder, const fs::path& base) {
    std::vector<std::string> names;
    std::error_code code;
    for (const auto& assets : asset_folders(base)) {
        for (fs::directory_iterator entry(assets / folder, code), end; !code && entry != end; entry.increment(code)) {
            const auto name = entry->path().stem().string();
            // The installed folder may be the one beside the working directory, so names are not repeated.
            if (entry->path().extension() == ".toml" && std::ranges::find(names, name) == names.end()) {
                names.push_back(name);
            }
        }
    }
    std::ranges::sort(names, [](const auto& a, const auto& b) { return strverscmp(a.c_str(), b.c_str()) < 0; });
    return names;
}

bool comes_with_program(const fs::path& file, const fs::path& folder) {
    const auto installed = installed_assets();
    std::error_code code;
    return installed && fs::equivalent(*installed / folder / file.filename(), file, code);
}

fs::path given_or_installed(const fs::path& path) {
    std::error_code none;
    if (path.empty() || *path.begin() != assets_name || fs::exists(path, none)) {
        return path;
    }
    for (const auto& folder : asset_folders({})) {
        if (auto found = folder / path.lexically_relative(assets_name); fs::exists(found, none)) {
            return found;
        }
    }
    return path;
}

} // namespace vkfv
