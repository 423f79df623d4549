#include "optics/media/glass_catalog.hpp"

#include "core/files/assets.hpp"
#include "core/messages/error.hpp"
#include "core/toml/toml_reader.hpp"
#include "optics/media/agf.hpp"
#include "optics/media/medium_table.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr const char* own_glasses = "common"; // catalogue that comes with the program, in the assets' folder
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

// The largest difference of index between two media over the wavelengths where both are valid; infinite if there are
// none.
double difference_of(const Medium& a, const Medium& b, const Medium::Range& used) {
    if (a.dispersion == b.dispersion) {
        return 0;
    }
    constexpr int wavelengths = 9;
    double largest = -1;
    for (int i = 0; i < wavelengths; ++i) {
        const double wavelength = used.minimum_um + (used.maximum_um - used.minimum_um) * i / (wavelengths - 1);
        try {
            largest = std::max(largest, std::abs(a.index(wavelength) - b.index(wavelength)));
        } catch (const InputError&) { // the wavelength is outside the range of one medium
        }
    }
    return largest < 0 ? INFINITY : largest;
}

constexpr double same_index = 1e-6;

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
    root.collect_problems(); // one error reports all problems
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
        for (const auto& medium : media) {
            catalog.builtin_.try_emplace(in_one_case(medium.name), medium);
        }
    });
    if (const auto aliases = root.optional_table("aliases")) {
        for (const auto& alias : aliases->keys()) {
            aliases->attempt(alias, [&] {
                if (const auto medium = catalog.find(aliases->string(alias))) {
                    catalog.builtin_.insert_or_assign(in_one_case(alias), *medium);
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
    add(read_agf(agf), agf.string());
    files_.push_back(agf);
}

void GlassCatalog::add(const AgfGlasses& glasses, std::string_view name) {
    Catalogue catalogue{.name = in_one_case(std::filesystem::path(name).stem().string()), .file = std::string(name)};
    for (const auto& medium : glasses.media) {
        catalogue.media.try_emplace(in_one_case(medium.name), medium);
    }
    for (const auto& [glass, problem] : glasses.unusable) {
        catalogue.unusable.try_emplace(in_one_case(glass), problem);
    }
    const auto key = [](const Catalogue& each) { return std::pair(each.name, each.file); };
    added_.insert(std::ranges::upper_bound(added_, key(catalogue), {}, key), std::move(catalogue));
}

const Medium* GlassCatalog::glass_of(const Catalogue& catalogue, const std::string& name) {
    if (const auto found = catalogue.media.find(name); found != catalogue.media.end()) {
        return &found->second;
    }
    if (const auto wrong = catalogue.unusable.find(name); wrong != catalogue.unusable.end()) {
        const InputProblem& problem = wrong->second;
        throw InputError(
            {.where = {},
             .key = "glass",
             .found = fmt::format("\"{}\"", name),
             .expected = fmt::format("a glass whose record is right; in {}, {} = {} is not {}",
                                     problem.where.to_string(), problem.key, problem.found, problem.expected),
             .remedy = problem.remedy});
    }
    return nullptr;
}

std::optional<Medium> GlassCatalog::find(std::string_view name, const GlassSearch& search) const {
    const std::string key = in_one_case(name);
    const auto built_in = builtin_.find(key);
    struct Found {
        const Catalogue* catalogue;
        const Medium* medium;
    };
    // The glass on which all catalogues that satisfy `asked` agree; none if no such catalogue has it.
    const auto common = [&](auto asked) -> std::optional<Medium> {
        std::vector<Found> found;
        for (const Catalogue& catalogue : added_) {
            if (const Medium* medium = asked(catalogue) ? glass_of(catalogue, key) : nullptr) {
                found.push_back({&catalogue, medium});
            }
        }
        for (const auto& [catalogue, medium] : found) {
            const double difference = difference_of(*found.front().medium, *medium, search.used);
            if (!(difference <= same_index)) {
                throw InputError(
                    {.where = {},
                     .key = "glass",
                     .found = fmt::format("\"{}\"", name),
                     .expected = fmt::format("a name of one glass; {} and {} have two, whose indices differ by up to "
                                             "{:.2g} from {:g} to {:g} um",
                                             found.front().catalogue->file, catalogue->file, difference,
                                             search.used.minimum_um, search.used.maximum_um),
                     .remedy =
                         "Give only the catalogue that is meant (--glass-catalog, glass_catalogs), or name it first "
                         "in the lens's line GCAT."});
            }
        }
        return found.empty() ? std::nullopt : std::optional(*found.front().medium);
    };
    for (const auto& asked : search.order) {
        const std::string catalogue_name = in_one_case(asked);
        if (auto found = common([&](const Catalogue& each) { return each.name == catalogue_name; })) {
            return found;
        }
        if (built_in != builtin_.end() && in_one_case(built_in->second.source).starts_with(catalogue_name + "-")) {
            return built_in->second;
        }
    }
    auto found = common([](const Catalogue&) { return true; });
    if (!found) {
        return built_in == builtin_.end() ? std::nullopt : std::optional(built_in->second);
    }
    if (built_in != builtin_.end()) {
        const double difference = difference_of(*found, built_in->second, search.used);
        if (!(difference <= same_index)) {
            spdlog::warn("{} of {} is used; the built-in glass of this name differs by up to {:.2g} in index ({})",
                         name, found->source, difference, built_in->second.source);
        }
    }
    return found;
}

Medium GlassCatalog::get(std::string_view name) const {
    auto found = find(name);
    if (!found) {
        throw InputError({.where = {},
                          .key = "glass",
                          .found = fmt::format("\"{}\"", name),
                          .expected = fmt::format("the name of a glass of {}the built-in table",
                                                  added_.empty() ? "" : "the glass catalogues or "),
                          .remedy = remedy_for_unknown_glass(name)});
    }
    return std::move(*found);
}

std::vector<std::string> GlassCatalog::names() const {
    std::set<std::string> names;
    for (const auto& [key, medium] : builtin_) {
        names.insert(medium.name);
    }
    for (const Catalogue& catalogue : added_) {
        for (const auto& [key, medium] : catalogue.media) {
            names.insert(medium.name);
        }
    }
    return {names.begin(), names.end()};
}

std::optional<ModelGlass> glass_of_code(std::string_view name) {
    std::string digits(name);
    if (digits.size() == 7 && digits[3] == '.') {
        digits.erase(3, 1);
    }
    if (digits.size() != 6 || !std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; })) {
        return std::nullopt;
    }
    const int code = std::stoi(digits);
    const ModelGlass glass{.nd = 1 + code / 1000 / 1000.0, .vd = code % 1000 / 10.0};
    return glass.nd > 1 && abbe_range.contains(glass.vd) ? std::optional(glass) : std::nullopt;
}

std::string remedy_for_unknown_glass(std::string_view name) {
    if (const auto model = glass_of_code(name)) {
        return fmt::format("If a model glass is meant, describe it in [media.{}] by nd = {:.3f} and vd = {:.1f}.", name,
                           model->nd, model->vd);
    }
    return fmt::format("Correct the name, describe the medium in [media.{}], or add its catalogue to glass_catalogs.",
                       name);
}

} // namespace vkfv::optics
