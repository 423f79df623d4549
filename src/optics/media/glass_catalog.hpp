// Glasses by name: those that come with the program, and those of catalogues that the user brings.
#pragma once

#include "optics/media/medium.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {
class TomlTable;
}

namespace vkfv::optics {

// A value. Names are the same whatever their case, and with '_' or a space for '-': "n-bk7", "Fused Silica".
// A glass of a catalogue added later goes before one of an earlier catalogue, and that before the built-in
// one; within a catalogue the first of a name is taken.
class GlassCatalog {
  public:
    // The common glasses, crystals and liquids of assets/glasses/common.toml, each with its source. The file is that of
    // asset_folders() without a base, read at the first call. Throws InputError if it is missing or wrong.
    static GlassCatalog builtin();

    // Those of such a file: [media.NAME] as in prescriptions, but each with a source, and under [aliases] other names
    // of media. Throws InputError that tells of all problems.
    static GlassCatalog of(const TomlTable& root);

    // Adds the glasses of an AGF file. Throws InputError.
    void add(const std::filesystem::path& agf);
    void add(const std::vector<Medium>& media);

    std::optional<Medium> find(std::string_view name) const;
    // Throws InputError, naming the glass and the nearest name, if there is none.
    Medium get(std::string_view name) const;
    std::vector<std::string> names() const; // as their sources write them, in the alphabet's order
    const std::vector<std::filesystem::path>& files() const { return files_; } // that were added, in order

  private:
    std::map<std::string, Medium, std::less<>> media_; // by the name in one case
    std::vector<std::filesystem::path> files_;
};

// The glass, or that of `others`, that a misspelt name most likely meant; none if all are too far off.
std::optional<std::string> nearest_glass(const GlassCatalog& glasses, std::string_view name,
                                         const std::vector<std::string>& others = {});

// What to do about a name that neither a catalogue nor `others` has, as sentences: the nearest name, or how
// to describe the glass. A six-digit code ("516640") is never taken as a model glass by itself, as several
// glasses of other dispersion share it.
std::string remedy_for_unknown_glass(const GlassCatalog& glasses, std::string_view name,
                                     const std::vector<std::string>& others = {});

} // namespace vkfv::optics
