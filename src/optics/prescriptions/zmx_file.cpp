#include "optics/prescriptions/zmx_file.hpp"

#include "optics/prescriptions/zmx_glasses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace vkfv::optics::zmx {

namespace {

// What Zemax computes, optimizes, simulates or displays with: no lens depends on it.
constexpr std::string_view without_geometry[] = {
    "VERS", "NOTE", "PFIL", "LANG", "ENPD", "FNUM", "OBNA", "FLOA", "GFAC", "GCAT", "RAIM", "PUSH", "SDMA", "OMMA",
    "ROPD", "HYPR", "PICB", "XFLN", "YFLN", "FWGN", "XFLD", "YFLD", "FWGT", "VDXN", "VDYN", "VCXN", "VCYN", "VANN",
    "ZVDX", "ZVDY", "ZVCX", "ZVCY", "ZVAN", "WWGT", "WWGN", "POLS", "GLRS", "GSTD", "NSCD", "COFN"};

// Of a surface. Solves, pick-ups and variables (MAZH, PZUP, PPAR, VDSZ, VPAR, VCON) leave their outcome in
// the value itself; MEMA is the glass's edge beyond the aperture.
constexpr std::string_view without_geometry_of_surfaces[] = {"COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "COAT",
                                                             "MEMA", "MAZH", "PZUP", "PPAR", "VDSZ", "VPAR", "VCON"};

constexpr std::string_view of_surfaces[] = {"TYPE", "CURV", "DISZ", "GLAS", "CONI", "PARM",
                                            "DIAM", "CLAP", "FLAP", "OBDC", "STOP"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string source_of(const std::filesystem::path& path) {
    return fmt::format("imported from the Zemax file {}", path.filename().string());
}

class Reader {
  public:
    Reader(const std::filesystem::path& path, const GlassCatalog& glasses) : glasses_(glasses, source_of(path)) {
        file_.path = path;
        file_.source = source_of(path);
    }

    File read(std::string_view bytes) {
        const std::string text = decode(bytes, file_.path);
        int number = 0;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            file_.last_line = line_of(std::string_view(text).substr(begin, end - begin), ++number);
            if (!file_.last_line.keyword.empty()) {
                take(file_.last_line);
            }
            begin = end + 1;
        }
        if (!text.ends_with('\n') && !file_.surfaces.empty() && !behind_surfaces_) {
            refuse(place(), file_.last_line, file_.last_line.rest, "a line that ends",
                   "The file looks cut off: copy it again.");
        }
        return std::move(file_);
    }

  private:
    // Of the surface that is being read.
    Place place() const {
        const bool in_surface = !file_.surfaces.empty() && !behind_surfaces_;
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
            if (is_one_of(keyword, of_surfaces)) {
                take_property(file_.surfaces.back(), line);
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
            if (integer_at(place(), line, 0, 0, 1000) > 1) {
                refuse(place(), line, line.rest, "one configuration",
                       "Keep only the one that is wanted, in Zemax's multi-configuration editor.");
            }
        } else if (!is_one_of(keyword, without_geometry)) {
            take_other(line);
        }
    }

    // Behind the surfaces stand the merit function, whose operands are too many to list, tolerances and
    // configurations: text behind few keywords, numbers behind all others.
    void take_other(const Line& line) {
        const bool behind = !file_.surfaces.empty() && !line.indented;
        const bool text =
            line.keyword == "BLNK" || line.keyword == "TOL" || line.keyword == "MOFF" || line.keyword == "DMFS";
        const bool numbers = line.keyword.size() == 4 && !line.words.empty() &&
                             std::all_of(line.words.begin(), line.words.end(), [](const std::string& word) {
                                 return word == "\"\"" || as_number(word).has_value();
                             });
        if (!behind || !(text || numbers)) {
            refuse(place(), line, line.rest, "a keyword that this import understands",
                   "Remove in Zemax what it describes, or describe the lens as a prescription by hand.");
        }
        behind_surfaces_ = true;
    }

    void take_surface(const Line& line) {
        if (integer_at(place(), line, 0, 0, 100000) != static_cast<int>(file_.surfaces.size()) || behind_surfaces_) {
            refuse(place(), line, line.rest,
                   fmt::format("surface {}, before everything else behind the surfaces", file_.surfaces.size()),
                   "Number the surfaces from 0 without a gap.");
        }
        file_.surfaces.emplace_back();
        file_.surfaces.back().number = static_cast<int>(file_.surfaces.size()) - 1;
        file_.surfaces.back().line = line;
    }

    void take_unit(const Line& line) {
        const std::map<std::string, double> units = {{"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}}; // mm
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
        if (line.keyword == "WAVM") { // number, wavelength, weight
            file_.wavelengths_um[integer_at(place(), line, 0, 1, 1000)] = number_at(place(), line, 1, range);
            return;
        }
        for (std::size_t i = 0; i < line.words.size(); ++i) {
            file_.wavelengths_um[static_cast<int>(i) + 1] = number_at(place(), line, i, range);
        }
    }

    SurfaceKind kind_at(const Line& line) const {
        for (const auto kind : {SurfaceKind::standard, SurfaceKind::even_asphere, SurfaceKind::coordinate_break}) {
            if (!line.words.empty() && line.words.front() == name_of(kind)) {
                return kind;
            }
        }
        refuse(place(), line, line.rest, "one of the surfaces STANDARD, EVENASPH and COORDBRK",
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
            surface.medium_problems.clear();
            try {
                surface.medium = glasses_.medium_of(place(), line);
            } catch (const InputError& error) { // none if this turns out to be the image
                surface.medium = Medium::air();
                surface.medium_problems = error.problems();
            }
        } else if (line.keyword == "CONI") {
            surface.conic = number_at(place(), line, 0);
        } else if (line.keyword == "PARM") {
            surface.parameters[integer_at(place(), line, 0, 0, 1000)] = {.value = number_at(place(), line, 1),
                                                                         .line = line};
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
        } else { // STOP
            surface.stop = true;
            surface.stop_line = line;
        }
    }

    File file_;
    bool behind_surfaces_ = false;
    Glasses glasses_;
};

} // namespace

const char* name_of(SurfaceKind kind) {
    switch (kind) {
    case SurfaceKind::even_asphere:
        return "EVENASPH";
    case SurfaceKind::coordinate_break:
        return "COORDBRK";
    case SurfaceKind::standard:
        break;
    }
    return "STANDARD";
}

File read_lines(std::string_view bytes, const std::filesystem::path& path, const GlassCatalog& glasses) {
    return Reader(path, glasses).read(bytes);
}

} // namespace vkfv::optics::zmx
