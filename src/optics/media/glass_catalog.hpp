// Glasses by name: the built-in ones and those of catalogues that the user adds.
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

// The catalogues in which a name is searched, and the wavelengths over which their glasses must agree.
struct GlassSearch {
    std::vector<std::string> order{};                            // names of catalogues that are searched first
    Medium::Range used = {.minimum_um = 0.4, .maximum_um = 0.7}; // wavelengths at which the lens is used
};

// A set of glass catalogues; copies are independent. Names of glasses ignore case, and '_' or a space equals '-':
// "n-bk7", "Fused Silica". A catalogue's name is its file's without the extension and ignores case; the built-in
// glasses of a vendor are a catalogue of the vendor's name. Within a catalogue the first glass of a name is taken.
class GlassCatalog {
  public:
    // The common glasses, crystals and liquids of assets/glasses/common.toml, each with its source. The file is that of
    // asset_folders() without a base, read at the first call. Throws InputError if it is missing or wrong.
    static GlassCatalog builtin();

    // A catalogue from a document like assets/glasses/common.toml: [media.NAME] as in prescriptions, but each with a
    // source, and other names of media under [aliases]. Throws one InputError that reports all problems.
    static GlassCatalog of(const TomlTable& root);

    // Adds the catalogue of an AGF file. Throws InputError.
    void add(const std::filesystem::path& agf);
    void add(const AgfGlasses& glasses, std::string_view name);

    // The medium of that name; none if no catalogue has it. The catalogues of `search` are searched first, in their
    // order; then all added ones together: if several have the name, their indices must agree to 1e-6 over the
    // wavelengths used, else an InputError names them. The built-in glasses come last; a warning reports where they
    // differ from the glass found. Throws InputError too for a glass whose record in its catalogue is faulty.
    std::optional<Medium> find(std::string_view name, const GlassSearch& search = {}) const;
    // The medium that find() returns with the default search; throws InputError that names the glass if no catalogue
    // has it.
    Medium get(std::string_view name) const;
    std::vector<std::string> names() const; // as their sources write them, in alphabetical order
    const std::vector<std::filesystem::path>& files() const { return files_; } // added catalogues, in order

  private:
    struct Catalogue {
        std::string name;                                            // folded to one case
        std::string file;                                            // file name for messages
        std::map<std::string, Medium, std::less<>> media{};          // key: name folded to one case
        std::map<std::string, InputProblem, std::less<>> unusable{}; // key: name folded to one case
    };
    // The glass of a catalogue, or null. Throws InputError for a glass whose record is faulty.
    static const Medium* glass_of(const Catalogue& catalogue, const std::string& name);

    std::map<std::string, Medium, std::less<>> builtin_; // key: name folded to one case
    std::vector<Catalogue> added_;                       // sorted by name, then by file
    std::vector<std::filesystem::path> files_;
};

// Advice, as sentences, for a name that no catalogue has. It never suggests another glass by its spelling: F2 and F5
// are as different as two names can be. A six-digit code ("516640") is never taken as a model glass by itself, as
// several glasses of different dispersion share it.
std::string remedy_for_unknown_glass(std::string_view name);

// The nd and vd that a six-digit code stands for, "517642" or "517.642": 1.517 and 64.2. None if the name is no code.
std::optional<ModelGlass> glass_of_code(std::string_view name);

} // namespace vkfv::optics
