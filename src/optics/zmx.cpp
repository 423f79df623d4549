#include "optics/zmx.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/toml_reader.hpp"
#include "core/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr std::size_t longest_quotation = 60; // characters of a line that a message repeats

// As prescriptions are read.
constexpr NumberRange thickness_range = {.minimum = 0, .maximum = 1e6};
constexpr NumberRange offset_range = {.minimum = -1e6, .maximum = 1e6};
constexpr NumberRange tilt_range_deg = {.minimum = -360, .maximum = 360};
constexpr NumberRange index_range = {.minimum = 1, .maximum = 5};
constexpr NumberRange abbe_range = {.minimum = 5, .maximum = 150};

constexpr std::string_view white_space = " \t\f\v\r";

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

constexpr std::string_view kinds_of_surfaces[] = {"STANDARD", "EVENASPH", "COORDBRK"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(white_space);
    if (first == std::string_view::npos) {
        return {};
    }
    return std::string(text.substr(first, text.find_last_not_of(white_space) - first + 1));
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(white_space); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(white_space, begin), text.size());
        words.emplace_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(white_space, end);
    }
    return words;
}

std::optional<double> as_number(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value + 0.0; // no negative zeros
}

// The files' text as UTF-8.
class Decoder {
  public:
    Decoder(std::string_view bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

    std::string decode() {
        if (bytes_.starts_with("\xff\xfe") || bytes_.starts_with("\xfe\xff")) {
            return decode_utf16(bytes_.front() == '\xff');
        }
        if (bytes_.starts_with("\xef\xbb\xbf")) {
            bytes_.remove_prefix(3);
            offset_ = 3;
        }
        check_utf8();
        return std::string(bytes_);
    }

  private:
    [[noreturn]] void refuse(std::size_t position, const char* found) const {
        throw InputError({.where = {.file = file_, .byte_offset = offset_ + position},
                          .key = "",
                          .found = found,
                          .expected = "text in UTF-16 with a byte-order mark, or in UTF-8",
                          .remedy = "Save the lens in Zemax again, or convert the text to UTF-8."});
    }

    std::string decode_utf16(bool little_endian) const {
        const auto unit_at = [&](std::size_t i) {
            const auto first = static_cast<unsigned char>(bytes_[i]);
            const auto second = static_cast<unsigned char>(bytes_[i + 1]);
            return static_cast<std::uint32_t>(little_endian ? first | second << 8 : second | first << 8);
        };
        if (bytes_.size() % 2 != 0) {
            refuse(bytes_.size() - 1, "half a UTF-16 character");
        }
        std::string text;
        for (std::size_t i = 2; i < bytes_.size(); i += 2) {
            std::uint32_t point = unit_at(i);
            if (point >= 0xd800 && point < 0xe000) {
                const std::uint32_t low = i + 2 < bytes_.size() ? unit_at(i + 2) : 0;
                if (point >= 0xdc00 || low < 0xdc00 || low >= 0xe000) {
                    refuse(i, "half a UTF-16 surrogate pair");
                }
                point = 0x10000 + ((point - 0xd800) << 10) + (low - 0xdc00);
                i += 2;
            }
            if (point == 0) {
                refuse(i, "a NUL character");
            }
            append_utf8(text, point);
        }
        return text;
    }

    static void append_utf8(std::string& text, std::uint32_t point) {
        if (point < 0x80) {
            text += static_cast<char>(point);
            return;
        }
        const int following = point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
        constexpr std::uint32_t lead[] = {0, 0xc0, 0xe0, 0xf0};
        text += static_cast<char>(lead[following] | point >> (6 * following));
        for (int i = following - 1; i >= 0; --i) {
            text += static_cast<char>(0x80 | (point >> (6 * i) & 0x3f));
        }
    }

    // Well-formed as the Unicode standard's table 3-7 says: no overlong forms, no surrogates.
    void check_utf8() const {
        for (std::size_t i = 0; i < bytes_.size();) {
            const auto lead = static_cast<unsigned char>(bytes_[i]);
            if (lead == 0) {
                refuse(i, "a NUL character");
            }
            const std::size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
            if (length == 0 || lead > 0xf4 || i + length > bytes_.size()) {
                refuse(i, "bytes that are not UTF-8");
            }
            for (std::size_t j = 1; j < length; ++j) {
                const auto byte = static_cast<unsigned char>(bytes_[i + j]);
                const bool second = j == 1;
                const unsigned low = second && lead == 0xe0 ? 0xa0 : second && lead == 0xf0 ? 0x90 : 0x80;
                const unsigned high = second && lead == 0xed ? 0x9f : second && lead == 0xf4 ? 0x8f : 0xbf;
                if (byte < low || byte > high) {
                    refuse(i, "bytes that are not UTF-8");
                }
            }
            i += length;
        }
    }

    std::string_view bytes_;
    const std::filesystem::path& file_;
    std::size_t offset_ = 0;
};

struct Line {
    int number = 0;
    bool indented = false;
    std::string keyword{};
    std::string rest{};               // trimmed
    std::vector<std::string> words{}; // of the rest
};

struct Parameter {
    double value = 0;
    Line line;
};

struct Surface {
    int number = 0;
    Line line;
    std::optional<Line> type;
    std::optional<double> curvature;
    std::optional<double> thickness; // infinity: INFINITY
    Line thickness_line;
    double conic = 0;
    std::map<int, Parameter> parameters;
    std::optional<Medium> medium; // none: air
    Line medium_line;
    std::vector<InputProblem> medium_problems; // what is wrong with it, if light goes there
    double diameter = 0;                       // half of it; 0: none
    double aperture = 0;                       // the same, and rays are clipped there
    bool stop = false;
    Line stop_line;

    std::string_view kind() const { return type ? std::string_view(type->words.front()) : "STANDARD"; }
};

class Reader {
  public:
    Reader(const std::filesystem::path& file, const GlassCatalog& glasses) : file_(file), glasses_(glasses) {}

    ZmxLens read(std::string_view bytes) {
        const std::string text = Decoder(bytes, file_).decode();
        int number = 0;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            last_ = line_of(std::string_view(text).substr(begin, end - begin), ++number);
            if (!last_.keyword.empty()) {
                take(last_);
            }
            begin = end + 1;
        }
        if (!text.ends_with('\n') && !surfaces_.empty() && !behind_surfaces_) {
            refuse(last_, last_.rest, "a line that ends", "The file looks cut off: copy it again.");
        }
        return lens();
    }

  private:
    static Line line_of(std::string_view text, int number) {
        Line line{.number = number, .indented = text.starts_with(' ') || text.starts_with('\t')};
        line.rest = trimmed(text);
        const std::size_t end = line.rest.find_first_of(white_space);
        line.keyword = line.rest.substr(0, end);
        line.rest = end == std::string::npos ? "" : trimmed(std::string_view(line.rest).substr(end));
        line.words = words_of(line.rest);
        return line;
    }

    // Of the surface that is being read.
    [[noreturn]] void refuse(const Line& line, std::string found, std::string expected, std::string remedy) const {
        refuse_at(surfaces_.empty() || behind_surfaces_ ? "" : name_of(surfaces_.back()), line, std::move(found),
                  std::move(expected), std::move(remedy));
    }

    [[noreturn]] void refuse(const Surface& surface, const Line& line, std::string found, std::string expected,
                             std::string remedy) const {
        refuse_at(name_of(surface), line, std::move(found), std::move(expected), std::move(remedy));
    }

    [[noreturn]] void refuse_at(const std::string& place, const Line& line, std::string found, std::string expected,
                                std::string remedy) const {
        if (found.size() > longest_quotation) {
            found = found.substr(0, longest_quotation) + "...";
        }
        throw InputError({.where = {.file = file_, .line = line.number},
                          .key = place + line.keyword.substr(0, longest_quotation),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

    static std::string name_of(const Surface& surface) { return fmt::format("surface {}: ", surface.number); }

    double number_at(const Line& line, std::size_t word, const NumberRange& range = NumberRange::finite()) const {
        const auto value = word < line.words.size() ? as_number(line.words[word]) : std::nullopt;
        if (!value || !range.contains(*value)) {
            refuse(line, line.rest, trimmed(fmt::format("as value {} a finite number {}", word + 1, range.to_string())),
                   "Correct the number; decimals take a point.");
        }
        return *value;
    }

    int integer_at(const Line& line, std::size_t word, int minimum, int maximum) const {
        const double value = number_at(line, word);
        if (!(value >= minimum && value <= maximum && value == std::trunc(value))) {
            refuse(line, line.rest, fmt::format("as value {} an integer in [{}, {}]", word + 1, minimum, maximum),
                   "Correct the number.");
        }
        return static_cast<int>(value);
    }

    void take(const Line& line) {
        const std::string& keyword = line.keyword;
        if (keyword == "SURF") {
            take_surface(line);
        } else if (is_one_of(keyword, of_surfaces) || is_one_of(keyword, without_geometry_of_surfaces)) {
            if (surfaces_.empty() || behind_surfaces_) {
                refuse(line, line.rest, "this keyword inside a surface", "Move it below its SURF.");
            }
            if (is_one_of(keyword, of_surfaces)) {
                take_property(surfaces_.back(), line);
            }
        } else if (keyword == "MODE") {
            if (line.rest != "SEQ") {
                refuse(line, line.rest, "the sequential mode, SEQ", "Convert the lens to a sequential one in Zemax.");
            }
        } else if (keyword == "UNIT") {
            take_unit(line);
        } else if (keyword == "NAME") {
            title_ = line.rest;
            if (title_.size() >= 2 && title_.front() == '"' && title_.back() == '"') {
                title_ = trimmed(std::string_view(title_).substr(1, title_.size() - 2));
            }
        } else if (keyword == "ENVD") {
            take_environment(line);
        } else if (keyword == "FTYP") {
            if (line.words.size() > 3) {
                wavelength_count_ = integer_at(line, 3, 1, 1000);
            }
        } else if (keyword == "WAVM" || keyword == "WAVL") {
            take_wavelengths(line);
        } else if (keyword == "PWAV") {
            primary_ = integer_at(line, 0, 1, 1000);
            primary_line_ = line;
        } else if (keyword == "MNUM") {
            behind_surfaces_ = true;
            if (integer_at(line, 0, 0, 1000) > 1) {
                refuse(line, line.rest, "one configuration",
                       "Keep only the one that is wanted, in Zemax's multi-configuration editor.");
            }
        } else if (!is_one_of(keyword, without_geometry)) {
            take_other(line);
        }
    }

    // Behind the surfaces stand the merit function, whose operands are too many to list, tolerances and
    // configurations: text behind few keywords, numbers behind all others.
    void take_other(const Line& line) {
        const bool behind = !surfaces_.empty() && !line.indented;
        const bool text =
            line.keyword == "BLNK" || line.keyword == "TOL" || line.keyword == "MOFF" || line.keyword == "DMFS";
        const bool numbers = line.keyword.size() == 4 && !line.words.empty() &&
                             std::all_of(line.words.begin(), line.words.end(), [](const std::string& word) {
                                 return word == "\"\"" || as_number(word).has_value();
                             });
        if (!behind || !(text || numbers)) {
            refuse(line, line.rest, "a keyword that this import understands",
                   "Remove in Zemax what it describes, or describe the lens as a prescription by hand.");
        }
        behind_surfaces_ = true;
    }

    void take_surface(const Line& line) {
        if (integer_at(line, 0, 0, 100000) != static_cast<int>(surfaces_.size()) || behind_surfaces_) {
            refuse(line, line.rest,
                   fmt::format("surface {}, before everything else behind the surfaces", surfaces_.size()),
                   "Number the surfaces from 0 without a gap.");
        }
        surfaces_.emplace_back();
        surfaces_.back().number = static_cast<int>(surfaces_.size()) - 1;
        surfaces_.back().line = line;
    }

    void take_unit(const Line& line) {
        const std::map<std::string, double> units = {{"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}}; // mm
        const auto found = line.words.empty() ? units.end() : units.find(line.words.front());
        if (found == units.end()) {
            refuse(line, line.rest, "one of the lens units MM, CM, IN and METER", "Choose such a unit in Zemax.");
        }
        unit_ = found->second;
    }

    void take_environment(const Line& line) {
        const bool adjusted = line.words.size() > 2 && integer_at(line, 2, 0, 1) == 1;
        if (adjusted && (number_at(line, 0) != 20 || number_at(line, 1) != 1)) {
            refuse(line, line.rest, "indices at 20 degrees C and 1 atm",
                   "Switch off the adjustment of indices to the environment in Zemax.");
        }
    }

    void take_wavelengths(const Line& line) {
        const auto range = NumberRange::positive();
        if (line.keyword == "WAVM") { // number, wavelength, weight
            wavelengths_um_[integer_at(line, 0, 1, 1000)] = number_at(line, 1, range);
            return;
        }
        for (std::size_t i = 0; i < line.words.size(); ++i) {
            wavelengths_um_[static_cast<int>(i) + 1] = number_at(line, i, range);
        }
    }

    void take_property(Surface& surface, const Line& line) {
        if (line.keyword == "TYPE") {
            if (line.words.empty() || !is_one_of(line.words.front(), kinds_of_surfaces)) {
                refuse(line, line.rest, "one of the surfaces STANDARD, EVENASPH and COORDBRK",
                       "Replace the surface in Zemax by one of these.");
            }
            surface.type = line;
        } else if (line.keyword == "CURV") {
            surface.curvature = number_at(line, 0);
        } else if (line.keyword == "DISZ") {
            const bool infinite = !line.words.empty() && line.words.front() == "INFINITY";
            surface.thickness = infinite ? INFINITY : number_at(line, 0);
            surface.thickness_line = line;
        } else if (line.keyword == "GLAS") {
            surface.medium_line = line;
            surface.medium_problems.clear();
            try {
                surface.medium = glass_of(line);
            } catch (const InputError& error) { // none if this turns out to be the image
                surface.medium = Medium::air();
                surface.medium_problems = error.problems();
            }
        } else if (line.keyword == "CONI") {
            surface.conic = number_at(line, 0);
        } else if (line.keyword == "PARM") {
            surface.parameters[integer_at(line, 0, 0, 1000)] = {.value = number_at(line, 1), .line = line};
        } else if (line.keyword == "DIAM") {
            surface.diameter = number_at(line, 0, {.minimum = 0, .minimum_included = true});
        } else if (line.keyword == "CLAP" || line.keyword == "FLAP") {
            if (number_at(line, 0) != 0) {
                refuse(line, line.rest, "a circular aperture without an obscuration", "Remove its inner radius.");
            }
            surface.aperture = number_at(line, 1, NumberRange::positive());
        } else if (line.keyword == "OBDC") {
            if (number_at(line, 0) != 0 || number_at(line, 1) != 0) {
                refuse(line, line.rest, "an aperture about the vertex",
                       "Remove the aperture's decentre; coordinate breaks decentre a surface.");
            }
        } else { // STOP
            surface.stop = true;
            surface.stop_line = line;
        }
    }

    Medium glass_of(const Line& line) {
        if (line.words.empty()) {
            refuse(line, "", "the name of a glass", "Name it, or remove the line for air.");
        }
        const std::string& name = line.words.front();
        if (name == "MIRROR") {
            refuse(line, line.rest, "a refracting surface", "Mirrors are not imported: unfold the lens in Zemax.");
        }
        if (name == "AIR") {
            return Medium::air();
        }
        if (name == "___BLANK") {
            const double nd = number_at(line, 3, index_range);
            const double vd = number_at(line, 4);
            if (vd != 0 && !abbe_range.contains(vd)) {
                refuse(line, line.rest,
                       fmt::format("as value 5 an Abbe number {}, or 0 for no dispersion", abbe_range.to_string()),
                       "Correct the number; decimals take a point.");
            }
            if (line.words.size() > 5 && number_at(line, 5) != 0) {
                refuse(line, line.rest, "a model glass without a deviation of its partial dispersion",
                       "Set the deviation to 0, or name a glass of a catalogue.");
            }
            return model_glass(nd, vd);
        }
        if (auto found = glasses_.find(name)) {
            return *std::move(found);
        }
        const auto meant = nearest_word(name, glasses_.names());
        refuse(line, name, "a glass of the catalogues",
               fmt::format("{}Add its catalogue with --glass-catalog, or make it a model glass in Zemax.",
                           meant ? fmt::format("Did you mean \"{}\"? ", *meant) : ""));
    }

    // Named by its six-digit code, and a count where several share that. Zemax's Abbe number 0 is no dispersion at all.
    Medium model_glass(double nd, double vd) {
        const std::string code = fmt::format("{:03.0f}{:03.0f}", 1000 * (nd - 1), 10 * vd);
        for (int count = 1;; ++count) {
            const std::string name = count == 1 ? code : fmt::format("{}-{}", code, count);
            const auto [place, added] = model_glasses_.try_emplace(name, nd, vd);
            if (added || place->second == std::pair(nd, vd)) {
                return vd == 0 ? Medium::constant(name, nd, source()) : Medium::model(name, nd, vd, source());
            }
        }
    }

    std::string source() const { return fmt::format("imported from the Zemax file {}", file_.filename().string()); }

    ZmxLens lens() {
        if (surfaces_.size() < 3) {
            refuse_at("", {.number = last_.number}, fmt::format("{} surfaces", surfaces_.size()),
                      "a lens: an object, at least one surface, and an image",
                      "Check that this is a whole .zmx file of a sequential lens.");
        }
        if (!unit_) {
            refuse_at("", {.number = 1}, "no UNIT", "the lens unit", "Add a line UNIT MM, or another unit.");
        }
        ZmxLens result;
        Prescription& prescription = result.prescription;
        prescription.file = file_;
        prescription.name = file_.stem().string();
        prescription.title = title_.empty() ? prescription.name : title_;
        prescription.source = source();
        prescription.licence = "not known to the import: see the source";
        require_glasses();
        for (const auto& surface : surfaces_) {
            check(surface);
        }
        check_image();
        prescription.medium_before = surfaces_.front().medium.value_or(Medium::air());
        std::vector<CoordinateBreak> breaks;
        bool has_stop = false;
        for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) {
            const Surface& surface = surfaces_[i];
            if (surface.kind() == "COORDBRK") {
                breaks.push_back(break_of(surface));
                continue;
            }
            prescription.surfaces.push_back(prescribed(surface));
            prescription.surfaces.back().breaks = std::exchange(breaks, {});
            if (surface.stop && std::exchange(has_stop, true)) {
                refuse(surface, surface.stop_line, "a second stop", "one stop", "Keep the one that limits the light.");
            }
        }
        if (prescription.surfaces.empty()) {
            refuse_at("", {.number = last_.number}, "coordinate breaks only", "at least one surface",
                      "Check that this is the file of a lens.");
        }
        // Behind the last surface there is only the image.
        prescription.surfaces.back().thickness = 0;
        take_over_wavelengths(result);
        return result;
    }

    // All that are missing at once. The image's glass would be behind it, where no light goes.
    void require_glasses() const {
        std::vector<InputProblem> problems;
        for (std::size_t i = 0; i + 1 < surfaces_.size(); ++i) {
            const auto& of_surface = surfaces_[i].medium_problems;
            problems.insert(problems.end(), of_surface.begin(), of_surface.end());
        }
        if (!problems.empty()) {
            throw InputError(std::move(problems));
        }
    }

    void check_image() const {
        const Surface& image = surfaces_.back();
        if (*image.thickness != 0 || image.kind() == "COORDBRK") {
            refuse(image, image.thickness_line, "a lens surface at the end", "an image surface, of thickness 0",
                   "The file looks cut off: copy it again; or add an image surface.");
        }
        if (image.medium) {
            spdlog::info("{}:{}: {} behind the image is left out: no light goes there", file_.string(),
                         image.medium_line.number,
                         image.medium_line.words.empty() ? "the glass" : image.medium_line.words.front());
        }
    }

    void check(const Surface& surface) const {
        if (!surface.curvature || !surface.thickness) {
            refuse(surface, surface.line, surface.curvature ? "no DISZ" : "no CURV", "curvature and thickness",
                   "The file looks cut off: copy it again.");
        }
        const bool is_end = surface.number == 0 || surface.number + 1 == static_cast<int>(surfaces_.size());
        if (surface.stop && (is_end || surface.kind() == "COORDBRK")) {
            refuse(surface, surface.stop_line, "a stop at a surface without light", "a stop within the lens",
                   "Make a surface of the lens the stop.");
        }
        if (surface.kind() == "COORDBRK") {
            if (surface.medium || *surface.curvature != 0 || surface.conic != 0) {
                refuse(surface, surface.medium ? surface.medium_line : *surface.type,
                       "a coordinate break that refracts", "no glass and no curvature",
                       "Give them to the next surface.");
            }
        }
        const int most = surface.kind() == "STANDARD" ? 0 : surface.kind() == "COORDBRK" ? 6 : 8;
        for (const auto& [number, parameter] : surface.parameters) {
            if (parameter.value != 0 && (number < 1 || number > most)) {
                refuse(surface, parameter.line, parameter.line.rest,
                       fmt::format("no parameter {} of a surface {}", number, surface.kind()), "Set it to 0.");
            }
        }
        if (surface.kind() == "EVENASPH" && parameter_of(surface, 1) != 0) {
            const Line& line = surface.parameters.at(1).line;
            refuse(surface, line, line.rest, "0 as the coefficient of r^2",
                   "Make it part of the curvature: add twice the coefficient to it, and refit the conic.");
        }
    }

    static double parameter_of(const Surface& surface, int number) {
        const auto found = surface.parameters.find(number);
        return found == surface.parameters.end() ? 0 : found->second.value;
    }

    // A value of `dimension` lengths in mm.
    double in_mm(const Surface& surface, const Line& line, double value, int dimension = 1) const {
        const double result = value * std::pow(*unit_, dimension) + 0.0;
        if (!std::isfinite(result)) {
            refuse(surface, line, line.rest, "a number that is finite in mm", "Correct it.");
        }
        return result;
    }

    double thickness_of(const Surface& surface, const NumberRange& range) const {
        const Line& line = surface.thickness_line;
        const double thickness = in_mm(surface, line, std::min(*surface.thickness, 1e300));
        if (!range.contains(thickness)) {
            refuse(surface, line, line.rest, fmt::format("a thickness {} mm", range.to_string()),
                   *surface.thickness < 0 ? "Leave out what stands in front of the surface before it."
                                          : "Choose a smaller distance.");
        }
        return thickness;
    }

    CoordinateBreak break_of(const Surface& surface) const {
        const auto checked = [&](int number, const NumberRange& range, auto convert) {
            const auto found = surface.parameters.find(number);
            if (found == surface.parameters.end()) {
                return 0.0;
            }
            const Line& line = found->second.line;
            const double value = convert(line, found->second.value);
            if (!range.contains(value)) {
                refuse(surface, line, line.rest, fmt::format("a value {} in mm or degrees", range.to_string()),
                       "Choose a smaller decentre or tilt.");
            }
            return value;
        };
        const auto length = [&](int number) {
            return checked(number, offset_range,
                           [&](const Line& line, double value) { return in_mm(surface, line, value); });
        };
        const auto angle = [&](int number) {
            return checked(number, tilt_range_deg, [](const Line&, double value) { return value; }) *
                   radians_per_degree;
        };
        return {.decentre_x = length(1),
                .decentre_y = length(2),
                .tilt_x = angle(3),
                .tilt_y = angle(4),
                .tilt_z = angle(5),
                .tilt_first = parameter_of(surface, 6) != 0,
                .thickness = thickness_of(surface, offset_range)};
    }

    PrescribedSurface prescribed(const Surface& surface) const {
        PrescribedSurface result;
        result.curvature = in_mm(surface, surface.line, *surface.curvature, -1);
        result.conic = surface.conic;
        for (const auto& [number, parameter] : surface.parameters) {
            if (number >= 2 && number <= 8) { // coefficient of r^(2 number)
                result.aspheric[static_cast<std::size_t>(number - 2)] =
                    in_mm(surface, parameter.line, parameter.value, 1 - 2 * number);
            }
        }
        result.medium_after = surface.medium.value_or(Medium::air());
        const double semi_diameter = surface.aperture > 0 ? surface.aperture : surface.diameter;
        if (semi_diameter > 0) {
            result.semi_diameter = in_mm(surface, surface.line, semi_diameter);
        }
        if (surface.stop) {
            result.role = PrescribedSurface::Role::aperture_stop;
        }
        const bool is_last = surface.number + 2 == static_cast<int>(surfaces_.size());
        result.thickness = is_last ? 0 : thickness_of(surface, thickness_range);
        return result;
    }

    // Zemax pads the list to 24 entries.
    void take_over_wavelengths(ZmxLens& result) const {
        for (const auto& [number, wavelength] : wavelengths_um_) {
            if (!wavelength_count_ || number <= *wavelength_count_) {
                result.wavelengths_um.push_back(wavelength);
            }
        }
        const auto primary = wavelengths_um_.find(primary_);
        if (result.wavelengths_um.empty() || primary == wavelengths_um_.end() ||
            (wavelength_count_ && primary_ > *wavelength_count_)) {
            refuse_at("", primary_line_, primary_line_.rest,
                      fmt::format("one of the {} wavelengths of the file", result.wavelengths_um.size()),
                      "Give the wavelengths in lines WAVM, and the primary one's number in PWAV.");
        }
        result.primary_wavelength_um = primary->second;
    }

    const std::filesystem::path& file_;
    const GlassCatalog& glasses_;
    Line last_;
    std::vector<Surface> surfaces_;
    bool behind_surfaces_ = false;
    std::optional<double> unit_; // mm
    std::string title_;
    std::map<int, double> wavelengths_um_; // by their numbers
    std::optional<int> wavelength_count_;
    int primary_ = 1;
    Line primary_line_{.keyword = "PWAV"};
    std::map<std::string, std::pair<double, double>> model_glasses_;
};

} // namespace

ZmxLens parse_zmx(std::string_view bytes, const std::filesystem::path& file, const GlassCatalog& glasses) {
    return Reader(file, glasses).read(bytes);
}

ZmxLens read_zmx(const std::filesystem::path& file, const GlassCatalog& glasses) {
    return parse_zmx(read_file(file, {.expected = "a Zemax lens file (.zmx)"}), file, glasses);
}

} // namespace vkfv::optics
