// Glasses by name: those that come with the program, and those of catalogues that the user brings.
#pragma once

#include "core/messages/error.hpp"
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

struct AgfGlasses;

// Which of several catalogues a name is looked up in, and where their glasses must agree.
struct GlassSearch {
    std::vector<std::string> order{};                            // catalogues that are asked first, by name
    Medium::Range used = {.minimum_um = 0.4, .maximum_um = 0.7}; // wavelengths that the lens is used at
};

// A value. Names of glasses are the same whatever their case, and with '_' or a space for '-': "n-bk7", "Fused Silica".
// A catalogue's name is its file's without the extension, whatever its case; the built-in glasses of a vendor are a
// catalogue of the vendor's name. Within a catalogue the first glass of a name is taken.
class GlassCatalog {
  public:
    // The common glasses, crystals and liquids of assets/glasses/common.toml, each with its source. The file is that of
    // asset_folders() without a base, read at the first call. Throws InputError if it is missing or wrong.
    static GlassCatalog builtin();

    // Those of such a file: [media.NAME] as in prescriptions, but each with a source, and under [aliases] other names
    // of media. Throws InputError that tells of all problems.
    static GlassCatalog of(const TomlTable& root);

    // Adds the catalogue of an AGF file. Throws InputError.
    void add(const std::filesystem::path& agf);
    void add(const AgfGlasses& glasses, std::string_view name);

    // The catalogues of `search` are asked first, in their order; then all that were added, in no order: if several
    // have the name, their indices must agree to 1e-6 over the wavelengths used, else an InputError names them. The
    // built-in glasses come last; a warning tells where they differ from the one that was found. Throws InputError too
    // for a glass whose record in its catalogue is wrong. None if no catalogue has the name.
    std::optional<Medium> find(std::string_view name, const GlassSearch& search = {}) const;
    // The same; throws InputError that names the glass if there is none.
    Medium get(std::string_view name) const;
    std::vector<std::string> names() const; // as their sources write them, in the alphabet's order
    const std::vector<std::filesystem::path>& files() const { return files_; } // that were added, in order

  private:
    struct Catalogue {
        std::string name;                                            // in one case
        std::string file;                                            // for messages
        std::map<std::string, Medium, std::less<>> media{};          // by the name in one case
        std::map<std::string, InputProblem, std::less<>> unusable{}; // likewise
    };
    // Throws InputError for a glass whose record is wrong.
    static const Medium* glass_of(const Catalogue& catalogue, const std::string& name);

    std::map<std::string, Medium, std::less<>> builtin_; // by the name in one case
    std::vector<Catalogue> added_;                       // by name, then by file
    std::vector<std::filesystem::path> files_;
};

// Sentences that tell what to do about a name that no catalogue has. They never suggest another glass by its spelling:
// F2 and F5 are as different as two names can be. A six-digit code ("516640") is never taken as a model glass by
// itself, as several glasses of other dispersion share it.
std::string remedy_for_unknown_glass(std::string_view name);

// The nd and vd that a six-digit code stands for, "517642" or "517.642": 1.517 and 64.2. None if it is no code.
std::optional<ModelGlass> glass_of_code(std::string_view name);

} // namespace vkfv::optics
