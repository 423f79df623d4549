#include "optics/prescriptions/zmx_file.hpp"

#include "core/parsing/text_encoding.hpp"
#include "optics/prescriptions/zmx_glasses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace vkfv::optics::zmx {

namespace {

// Keywords of the file that only serve Zemax's computation, optimization, tolerancing and display: no lens depends on
// them.
constexpr std::string_view without_geometry[] = {
    "VERS", "NOTE", "PFIL", "LANG", "ENPD", "FNUM", "OBNA", "FLOA", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA",
    "ROPD", "HYPR", "PICB", "XFLN", "YFLN", "FWGN", "XFLD", "YFLD", "FWGT", "VDXN", "VDYN", "VCXN", "VCYN",
    "VANN", "ZVDX", "ZVDY", "ZVCX", "ZVCY", "ZVAN", "WWGT", "WWGN", "POLS", "GLRS", "GSTD", "NSCD", "COFN",
    "WAVN", "AUTH", "DBDT", "SCOL", "TOLE", "LUID", "SSID", "FCOM", "IWDP", "BLNK", "TOL",  "MOFF", "DMFS"};

// Keywords of surfaces that affect no lens. Solves, pick-ups and variables (MAZH, PZUP, PPAR, VDSZ, VPAR, VCON,
// TOLE) leave their outcome in the value itself; MEMA is the glass's edge beyond the aperture.
constexpr std::string_view without_geometry_of_surfaces[] = {"COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "COAT",
                                                             "MEMA", "MAZH", "PZUP", "PPAR", "VDSZ", "VPAR", "VCON"};

constexpr std::string_view of_surfaces[] = {"TYPE", "CURV", "DISZ", "GLAS", "CONI", "PARM",
                                            "XDAT", "DIAM", "CLAP", "FLAP", "OBDC", "STOP"};

// Keywords of apertures that are not circular and of obscurations, which are refused.
constexpr std::string_view other_apertures[] = {"SQAP", "ELAP", "USAP", "OBSC", "SQOB", "ELOB", "USOB", "SPID"};

// Operands of configurations that change a lens in a way that is not supported: parameters and extra data of surfaces,
// model glasses, ignored surfaces, the environment, apertures, and tilts and decentres before and behind a surface.
constexpr std::string_view other_operands[] = {"PRAM", "PAR1", "PAR2", "PAR3", "PAR4", "PAR5", "PAR6", "PAR7",
                                               "PAR8", "EDVA", "MIND", "MABB", "MDPG", "IGNM", "IGNR", "TEMP",
                                               "PRES", "APMN", "APMX", "APTP", "APDX", "APDY", "CADX", "CADY",
                                               "CATX", "CATY", "CATZ", "CBDX", "CBDY", "CBTX", "CBTY", "CBTZ"};

// Operands of configurations that change no lens: fields, pupils, weights, titles, coatings, drawing, optimization.
constexpr std::string_view operands_without_geometry[] = {
    "MOFF", "AFOC", "APER", "SATP", "RAAM", "RELI", "FLTP", "FLWT", "XFIE", "YFIE", "FVAN", "FVCX", "FVCY",
    "FVDX", "FVDY", "WLWT", "LTTL", "MCOM", "MCOT", "MCSD", "MCHI", "NCOM", "NCOT", "COTN", "COAT", "CWGT",
    "GCRS", "GPEX", "GPEY", "GPJX", "GPJY", "GQPO", "GPIU", "HOLD", "MTFU", "OPDR", "PSCX", "PSCY", "PSHX",
    "PSHY", "PSHZ", "PUPR", "PXAR", "PYAR", "SDRW", "SRTS", "SWCN", "UDAF", "BLNK"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string source_of(const std::filesystem::path& path) {
    return fmt::format("imported from the Zemax file {}", path.filename().string());
}

class Reader {
  public:
    Reader(const std::filesystem::path& path, const GlassCatalog& glasses, std::optional<int> configuration)
        : configuration_(configuration), glasses_(glasses, source_of(path)) {
        file_.path = path;
        file_.source = source_of(path);
    }

    File read(std::string_view bytes) {
        const std::string text = as_utf8(bytes);
        require_lens_file(bytes, text);
        int number = 0;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            file_.last_line = line_of(std::string_view(text).substr(begin, end - begin), ++number);
            if (!file_.last_line.keyword.empty()) {
                take(file_.last_line);
            }
            begin = end + 1;
        }
        if (!text.ends_with('\n') && !file_.surfaces.empty() && !behind_surfaces_ && !after_operand_) {
            refuse(place(), file_.last_line, file_.last_line.rest, "a line that ends",
                   "The file looks cut off: copy it again.");
        }
        warn_of_unknown();
        choose_configuration();
        for (Surface& surface : file_.surfaces) {
            take_medium(surface);
        }
        return std::move(file_);
    }

  private:
    // Rejects other files that are named .zmx, or given by mistake.
    void require_lens_file(std::string_view bytes, std::string_view text) const {
        const char* found = bytes.starts_with("PK")                       ? "a ZIP archive"
                            : text.find('\0') != std::string_view::npos   ? "bytes that are no text"
                            : text.find("SURF") == std::string_view::npos ? "a text without a line SURF"
                                                                          : nullptr;
        if (found) {
            throw InputError({.where = {.file = file_.path},
                              .key = "",
                              .found = found,
                              .expected = "a lens file of Zemax's sequential mode (.zmx)",
                              .remedy = "Give the lens file; of an archive, the .zmx file inside it."});
        }
    }

    // The file position for messages: names the surface that is being read, if any.
    Place place() const {
        const bool in_surface = !file_.surfaces.empty() && !behind_surfaces_ && !after_operand_;
        return {file_.path, in_surface ? std::optional(file_.surfaces.back().number) : std::nullopt};
    }

    void take(const Line& line) {
        const std::string& keyword = line.keyword;
        if (keyword == "SURF") {
            take_surface(line);
        } else if (is_one_of(keyword, of_surfaces) || is_one_of(keyword, without_geometry_of_surfaces)) {
            if (file_.surfaces.empty() || behind_surfaces_) {
                refuse(place(), line, line.rest, "this keyword inside a surface", "Move it below its SURF.");
            }
            return_to_surfaces();
            if (is_one_of(keyword, of_surfaces)) {
                take_property(file_.surfaces.back(), line);
            }
        } else if (is_one_of(keyword, other_apertures)) {
            refuse(place(), line, line.rest, "a circular aperture (CLAP, FLAP) and nothing in it",
                   "Make the aperture circular in Zemax, or remove it.");
        } else if (keyword == "GCAT") {
            search_.order = line.words;
            for (std::string& name : search_.order) {
                std::erase(name, '"');
            }
        } else if (keyword == "MODE") {
            if (line.rest != "SEQ") {
                refuse(place(), line, line.rest, "the sequential mode, SEQ",
                       "Convert the lens to a sequential one in Zemax.");
            }
        } else if (keyword == "UNIT") {
            take_unit(line);
        } else if (keyword == "NAME") {
            file_.title = line.rest;
            if (file_.title.size() >= 2 && file_.title.front() == '"' && file_.title.back() == '"') {
                file_.title = trimmed(std::string_view(file_.title).substr(1, file_.title.size() - 2));
            }
        } else if (keyword == "ENVD") {
            take_environment(line);
        } else if (keyword == "FTYP") {
            if (line.words.size() > 3) {
                file_.wavelength_count = integer_at(place(), line, 3, 1, 1000);
            }
        } else if (keyword == "WAVM" || keyword == "WAVL") {
            take_wavelengths(line);
        } else if (keyword == "PWAV") {
            file_.primary = integer_at(place(), line, 0, 1, 1000);
            file_.primary_line = line;
        } else if (keyword == "MNUM") {
            behind_surfaces_ = true;
            configurations_ = std::max(1, integer_at(place(), line, 0, 0, 1000));
            active_ = line.words.size() > 1 ? std::max(1, integer_at(place(), line, 1, 0, configurations_)) : 1;
        } else if (is_one_of(keyword, without_geometry)) {
            // Notes and similar lines may stand anywhere in the file. Blank operands and tolerances without indent
            // stand behind the surfaces.
            behind_surfaces_ = behind_surfaces_ ||
                               (!line.indented && !file_.surfaces.empty() && (keyword == "BLNK" || keyword == "TOL"));
        } else if (configurations_ > 1 && line.words.size() > 2) {
            operands_.push_back(line);
        } else {
            take_other(line);
        }
    }

    // Operands of the merit function behind the surfaces are too many to list; they are recognized by having only
    // numbers behind them.
    void take_other(const Line& line) {
        const bool numbers = line.keyword.size() == 4 && !line.words.empty() &&
                             std::all_of(line.words.begin(), line.words.end(), [](const std::string& word) {
                                 return word == "\"\"" || as_number(word).has_value();
                             });
        const bool operand = numbers && !file_.surfaces.empty() && !line.indented;
        after_operand_ = after_operand_ || operand;
        (operand ? perhaps_operands_ : unknown_).try_emplace(line.keyword, line.number);
    }

    // Within the surfaces, what looked like operands of the merit function were unknown keywords of theirs.
    void return_to_surfaces() {
        after_operand_ = false;
        unknown_.merge(perhaps_operands_);
        perhaps_operands_.clear();
    }

    void warn_of_unknown() const {
        if (unknown_.empty()) {
            return;
        }
        constexpr std::size_t most_named = 10;
        std::vector<std::string> named;
        for (const auto& [keyword, line] : unknown_) {
            if (named.size() == most_named) {
                named.push_back(fmt::format("{} more", unknown_.size() - most_named));
                break;
            }
            named.push_back(fmt::format("{} (line {})", keyword.substr(0, 20), line));
        }
        spdlog::warn("{}: keywords that this import does not know are passed over: {}. Check that they do not describe "
                     "the lens",
                     file_.path.string(), fmt::join(named, ", "));
    }

    // The surfaces hold the values of the configuration that was active when the file was saved. Values of the others
    // stand behind MNUM, as operand, surface or wavelength, configuration and value.
    void choose_configuration() {
        if (!configuration_) {
            if (configurations_ > 1) {
                spdlog::warn(
                    "{}: of {} configurations, number {} is imported, which was active when the file was saved. "
                    "Choose another by --configuration",
                    file_.path.string(), configurations_, active_);
            }
            return;
        }
        if (*configuration_ > configurations_) {
            throw InputError({.where = {.file = file_.path},
                              .key = "--configuration",
                              .found = fmt::format("{}", *configuration_),
                              .expected = fmt::format("one of the {} configurations of the file", configurations_),
                              .remedy = "Count from 1."});
        }
        if (*configuration_ == active_) {
            return;
        }
        for (const Line& line : operands_) {
            const auto number = as_number(line.words[1]);
            if (number && *number == *configuration_) {
                take_operand(line);
            }
        }
    }

    void take_operand(const Line& line) {
        const Place lens{file_.path};
        if (is_one_of(line.keyword, other_operands)) {
            refuse(lens, line, line.rest,
                   "operands of configurations THIC, CRVT, CONN, GLSS, SDIA, STPS, WAVE and PRWV",
                   "Make the wanted configuration the active one in Zemax, and save the lens.");
        }
        if (line.keyword == "WAVE") {
            file_.wavelengths_um[integer_at(lens, line, 0, 1, 1000)] =
                number_at(lens, line, 2, NumberRange::positive());
            return;
        }
        if (line.keyword == "PRWV") {
            file_.primary = integer_at(lens, line, 2, 1, 1000);
            file_.primary_line = line;
            return;
        }
        if (is_one_of(line.keyword, operands_without_geometry)) {
            return;
        }
        if (line.keyword == "STPS") {
            const int stop = integer_at(lens, line, 2, 0, static_cast<int>(file_.surfaces.size()) - 1);
            for (Surface& surface : file_.surfaces) {
                surface.stop = surface.number == stop;
                surface.stop_line = line;
            }
            return;
        }
        constexpr std::string_view of_a_surface[] = {"THIC", "CRVT", "CONN", "GLSS", "SDIA"};
        if (!is_one_of(line.keyword, of_a_surface)) {
            spdlog::warn("{}:{}: the operand {} of configuration {} is not known, and is passed over. Check that it "
                         "does not change the lens",
                         file_.path.string(), line.number, line.keyword.substr(0, 20), *configuration_);
            return;
        }
        Surface& surface = file_.surfaces[static_cast<std::size_t>(
            integer_at(lens, line, 0, 0, static_cast<int>(file_.surfaces.size()) - 1))];
        constexpr double infinite = 1e10; // Zemax writes an infinite thickness so here
        if (line.keyword == "THIC") {
            const double thickness = number_at(lens, line, 2);
            surface.thickness = thickness >= infinite ? INFINITY : thickness;
            surface.thickness_line = line;
        } else if (line.keyword == "CRVT") {
            surface.curvature = number_at(lens, line, 2);
        } else if (line.keyword == "CONN") {
            surface.conic = number_at(lens, line, 2);
        } else if (line.keyword == "SDIA") {
            surface.diameter = number_at(lens, line, 2, {.minimum = 0, .minimum_included = true});
        } else { // keyword GLSS
            surface.medium_line = line;
            std::string name = line.words[2];
            if (name.size() >= 2 && name.front() == '"' && name.back() == '"') {
                name = name.substr(1, name.size() - 2);
            }
            surface.medium_line.words = {name.empty() ? "AIR" : name};
        }
    }

    // Glasses are looked up at the end, because catalogues (GCAT) and wavelengths may stand behind them.
    void take_medium(Surface& surface) {
        const Line& line = surface.medium_line;
        if (line.keyword.empty()) {
            return;
        }
        if (!line.words.empty() && line.words.front() == "MIRROR") {
            surface.mirror = true;
            return;
        }
        GlassSearch search = search_;
        const auto range = wavelengths();
        search.used = range.value_or(search.used);
        const Place place{file_.path, surface.number};
        try {
            surface.medium = glasses_.medium_of(place, line, search);
        } catch (const InputError& error) { // harmless if this surface turns out to be the image
            surface.medium = Medium::air();
            surface.medium_problems = error.problems();
        }
    }

    std::optional<Medium::Range> wavelengths() const {
        std::optional<Medium::Range> range;
        for (const auto& [number, wavelength] : file_.wavelengths_um) {
            if (!file_.wavelength_count || number <= *file_.wavelength_count) {
                range = range ? Medium::Range{std::min(range->minimum_um, wavelength),
                                              std::max(range->maximum_um, wavelength)}
                              : Medium::Range{wavelength, wavelength};
            }
        }
        return range;
    }

    void take_surface(const Line& line) {
        if (integer_at(place(), line, 0, 0, 100000) != static_cast<int>(file_.surfaces.size()) || behind_surfaces_) {
            refuse(place(), line, line.rest,
                   fmt::format("surface {}, before everything else behind the surfaces", file_.surfaces.size()),
                   "Number the surfaces from 0 without a gap.");
        }
        return_to_surfaces();
        file_.surfaces.emplace_back();
        file_.surfaces.back().number = static_cast<int>(file_.surfaces.size()) - 1;
        file_.surfaces.back().line = line;
    }

    void take_unit(const Line& line) {
        // The length of each unit in mm.
        const std::map<std::string, double> units = {{"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}};
        const auto found = line.words.empty() ? units.end() : units.find(line.words.front());
        if (found == units.end()) {
            refuse(place(), line, line.rest, "one of the lens units MM, CM, IN and METER",
                   "Choose such a unit in Zemax.");
        }
        file_.unit = found->second;
    }

    void take_environment(const Line& line) {
        const bool adjusted = line.words.size() > 2 && integer_at(place(), line, 2, 0, 1) == 1;
        if (adjusted && (number_at(place(), line, 0) != 20 || number_at(place(), line, 1) != 1)) {
            refuse(place(), line, line.rest, "indices at 20 degrees C and 1 atm",
                   "Switch off the adjustment of indices to the environment in Zemax.");
        }
    }

    void take_wavelengths(const Line& line) {
        const auto range = NumberRange::positive();
        if (line.keyword == "WAVM") { // values of WAVM: number, wavelength, weight
            file_.wavelengths_um[integer_at(place(), line, 0, 1, 1000)] = number_at(place(), line, 1, range);
            return;
        }
        for (std::size_t i = 0; i < line.words.size(); ++i) {
            file_.wavelengths_um[static_cast<int>(i) + 1] = number_at(place(), line, i, range);
        }
    }

    SurfaceKind kind_at(const Line& line) const {
        for (const auto kind :
             {SurfaceKind::standard, SurfaceKind::even_asphere, SurfaceKind::coordinate_break, SurfaceKind::paraxial}) {
            if (!line.words.empty() && line.words.front() == name_of(kind)) {
                return kind;
            }
        }
        refuse(place(), line, line.rest, "one of the surfaces STANDARD, EVENASPH, COORDBRK and PARAXIAL",
               "Replace the surface in Zemax by one of these.");
    }

    void take_property(Surface& surface, const Line& line) {
        if (line.keyword == "TYPE") {
            surface.kind = kind_at(line);
            surface.kind_line = line;
        } else if (line.keyword == "CURV") {
            surface.curvature = number_at(place(), line, 0);
        } else if (line.keyword == "DISZ") {
            const bool infinite = !line.words.empty() && line.words.front() == "INFINITY";
            surface.thickness = infinite ? INFINITY : number_at(place(), line, 0);
            surface.thickness_line = line;
        } else if (line.keyword == "GLAS") {
            surface.medium_line = line;
        } else if (line.keyword == "CONI") {
            surface.conic = number_at(place(), line, 0);
        } else if (line.keyword == "PARM") {
            surface.parameters[integer_at(place(), line, 0, 0, 1000)] = {.value = number_at(place(), line, 1),
                                                                         .line = line};
        } else if (line.keyword == "XDAT") {
            if (number_at(place(), line, 1) != 0) {
                refuse(place(), line, line.rest, "no extra data, or zeros",
                       "Replace the surface in Zemax by one that needs none.");
            }
        } else if (line.keyword == "DIAM") {
            surface.diameter = number_at(place(), line, 0, {.minimum = 0, .minimum_included = true});
        } else if (line.keyword == "CLAP" || line.keyword == "FLAP") {
            if (number_at(place(), line, 0) != 0) {
                refuse(place(), line, line.rest, "a circular aperture without an obscuration",
                       "Remove its inner radius.");
            }
            surface.aperture = number_at(place(), line, 1, NumberRange::positive());
        } else if (line.keyword == "OBDC") {
            if (number_at(place(), line, 0) != 0 || number_at(place(), line, 1) != 0) {
                refuse(place(), line, line.rest, "an aperture about the vertex",
                       "Remove the aperture's decentre; coordinate breaks decentre a surface.");
            }
        } else { // keyword STOP
            surface.stop = true;
            surface.stop_line = line;
        }
    }

    File file_;
    bool behind_surfaces_ = false;     // behind BLNK, TOL or MNUM
    bool after_operand_ = false;       // after a line that is probably an operand of the merit function
    std::optional<int> configuration_; // the requested configuration
    int configurations_ = 1;
    int active_ = 1;
    std::vector<Line> operands_;         // operands of all configurations
    std::map<std::string, int> unknown_; // unknown keywords with their first lines
    std::map<std::string, int> perhaps_operands_{};
    GlassSearch search_;
    Glasses glasses_;
};

} // namespace

const char* name_of(SurfaceKind kind) {
    switch (kind) {
    case SurfaceKind::even_asphere:
        return "EVENASPH";
    case SurfaceKind::coordinate_break:
        return "COORDBRK";
    case SurfaceKind::paraxial:
        return "PARAXIAL";
    case SurfaceKind::standard:
        break;
    }
    return "STANDARD";
}

File read_lines(std::string_view bytes, const std::filesystem::path& path, const GlassCatalog& glasses,
                std::optional<int> configuration) {
    return Reader(path, glasses, configuration).read(bytes);
}

} // namespace vkfv::optics::zmx
