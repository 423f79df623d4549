#include "optics/media/glass_catalog.hpp"

#include "core/files/assets.hpp"
#include "core/messages/error.hpp"
#include "core/toml/toml_reader.hpp"
#include "optics/media/agf.hpp"
#include "optics/media/medium_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr const char* own_glasses = "common"; // of the assets' folder
constexpr const char* glasses_folder = "glasses";

std::string in_one_case(std::string_view name) {
    std::string text(name);
    for (char& character : text) {
        if (character >= 'a' && character <= 'z') {
            character = static_cast<char>(character - 'a' + 'A');
        } else if (character == ' ' || character == '_') {
            character = '-';
        }
    }
    return text;
}

bool is_glass_code(std::string_view name) {
    return name.size() == 6 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace

GlassCatalog GlassCatalog::builtin() {
    static const GlassCatalog catalog = [] {
        const auto file = find_asset(own_glasses, glasses_folder, {});
        if (!file) {
            throw InputError(
                {.where = {.file = std::filesystem::path(glasses_folder) / own_glasses},
                 .key = "glasses",
                 .found = "no such file",
                 .expected = "the glasses that come with vkfv; " + searched_for_asset(own_glasses, glasses_folder, {}),
                 .remedy = "Install vkfv again, with share/vkfv."});
        }
        return of(TomlTable::open(*file));
    }();
    return catalog;
}

GlassCatalog GlassCatalog::of(const TomlTable& root) {
    GlassCatalog catalog;
    root.collect_problems(); // to tell of all at once
    root.optional_string("title");
    root.attempt("media", [&] {
        const auto tables = root.table("media");
        std::vector<Medium> media;
        for (const auto& name : tables.keys()) {
            tables.attempt(name, [&] {
                const auto table = tables.table(name);
                media.push_back(read_medium(table, name, table.string("source")));
            });
        }
        catalog.add(media);
    });
    if (const auto aliases = root.optional_table("aliases")) {
        for (const auto& alias : aliases->keys()) {
            aliases->attempt(alias, [&] {
                if (const auto medium = catalog.find(aliases->string(alias))) {
                    catalog.media_.insert_or_assign(in_one_case(alias), *medium);
                } else {
                    aliases->note(alias, "the name of a table in [media]", "Correct the name.");
                }
            });
        }
    }
    root.reject_unknown_keys();
    return catalog;
}

void GlassCatalog::add(const std::filesystem::path& agf) {
    add(read_agf(agf));
    files_.push_back(agf);
}

void GlassCatalog::add(const std::vector<Medium>& media) {
    std::set<std::string> added; // the first of a catalogue's names that are the same in one case
    for (const auto& medium : media) {
        if (auto name = in_one_case(medium.name); added.insert(name).second) {
            media_.insert_or_assign(std::move(name), medium);
        }
    }
}

std::optional<Medium> GlassCatalog::find(std::string_view name) const {
    const auto found = media_.find(in_one_case(name));
    return found == media_.end() ? std::nullopt : std::optional(found->second);
}

Medium GlassCatalog::get(std::string_view name) const {
    auto found = find(name);
    if (!found) {
        throw InputError({.where = {},
                          .key = "glass",
                          .found = fmt::format("\"{}\"", name),
                          .expected = fmt::format("the name of a glass of {}the built-in table",
                                                  files_.empty() ? "" : "the glass catalogues or "),
                          .remedy = remedy_for_unknown_glass(*this, name)});
    }
    return std::move(*found);
}

std::vector<std::string> GlassCatalog::names() const {
    std::vector<std::string> names;
    for (const auto& [key, medium] : media_) {
        names.push_back(medium.name);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::optional<std::string> nearest_glass(const GlassCatalog& glasses, std::string_view name,
                                         const std::vector<std::string>& others) {
    std::map<std::string, std::string> known; // by the name in one case
    auto candidates = glasses.names();
    candidates.insert(candidates.end(), others.begin(), others.end());
    for (const auto& candidate : candidates) {
        known[in_one_case(candidate)] = candidate;
    }
    std::vector<std::string> keys;
    for (const auto& [key, candidate] : known) {
        keys.push_back(key);
    }
    const auto meant = nearest_word(in_one_case(name), keys);
    return meant ? std::optional(known[*meant]) : std::nullopt;
}

std::string remedy_for_unknown_glass(const GlassCatalog& glasses, std::string_view name,
                                     const std::vector<std::string>& others) {
    if (is_glass_code(name)) {
        return fmt::format("If a model glass is meant, describe it in [media.{}] by nd = 1.{} and vd = {}.{}.", name,
                           name.substr(0, 3), name.substr(3, 2), name.substr(5));
    }
    const auto meant = nearest_glass(glasses, name, others);
    return fmt::format("{}Correct the name, describe the medium in [media.{}], or add its catalogue to "
                       "glass_catalogs.",
                       meant ? fmt::format("Did you mean \"{}\"? ", *meant) : "", name);
}

} // namespace vkfv::optics
