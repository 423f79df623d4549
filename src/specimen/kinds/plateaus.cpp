#include "specimen/kinds/plateaus.hpp"

#include "core/files/file.hpp"
#include "core/keys/section.hpp"
#include "images/picture.hpp"
#include "specimen/files.hpp"
#include "specimen/generated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

namespace vkfv::specimen {
namespace {

const NumberKey plateaus_sq_key("sq_um", NumberRange::at_least(0), 0.0,
                                "Root mean square of random heights over plateaus and ground.");
const NumbersKey heights_key = for_example(
    "[2.0]", NumbersKey("heights_um", NumberRange::finite(), Default::none(),
                        "Of the plateaus over the ground: one for each, from left to right or from dark to bright, or "
                        "one for all."));
const TextKey text_key("text", Default::in_words("none: the plateaus are those of file"), "Letters, each a plateau.");
const TextKey font_key("font", Default::of(std::string("DejaVuSans-Bold")),
                       "Of the letters: a name that OpenImageIO finds, or a file.");
const NumberKey text_width_key("text_width_mm", NumberRange::positive(), Default::in_words("0.8 of the size"),
                               "From the first letter's left to the last one's right.");
const FileKey plateaus_file_key("file", Default::in_words("none: the plateaus are letters"),
                                "An image whose grey values other than black are plateaus, from dark to bright.");

[[noreturn]] void fail(const SourceLocation& where, const std::string& key, const std::string& found,
                       const std::string& expected, const std::string& remedy) {
    throw InputError({where, "specimen." + key, found, expected, remedy});
}

double height_of(const Plateaus& d, std::size_t plateau) {
    return d.heights[d.heights.size() == 1 ? 0 : plateau];
}

// The gap between letters, and the width of a space, as shares of the font's size.
constexpr double gap = 0.12;
constexpr double space = 0.3;

struct Letter {
    std::string character;
    images::Ink ink; // bounding box of the letter; empty for a space
};

std::vector<Letter> letters_of(const Plateaus& d, int font_size, const SourceLocation& where) {
    std::vector<Letter> letters;
    for (const char character : d.text) {
        Letter letter{std::string(1, character), {}};
        if (character != ' ') {
            letter.ink = images::ink_of(letter.character, font_size, d.font);
            if (!letter.ink.any()) {
                fail(where, "font", fmt::format("{}: no letter '{}' ({})", d.font, letter.character, letter.ink.reason),
                     "a font that has the letters of specimen.text; looked for in $OPENIMAGEIO_FONTS, and in fonts and "
                     "share/fonts of the home folder, /usr and /usr/local, with the folders in them",
                     "Install the font (tools/setup brings \"DejaVuSans-Bold\"), give the file of one, or draw the "
                     "letters as an image and name it in specimen.file.");
            }
        }
        letters.push_back(letter);
    }
    return letters;
}

double width_of(const std::vector<Letter>& letters, int font_size) {
    double width = -gap * font_size;
    for (const Letter& letter : letters)
        width += gap * font_size + (letter.ink.any() ? letter.ink.width() : space * font_size);
    return width;
}

void set_text(HeightField& field, const Plateaus& d, const SourceLocation& where) {
    const auto count = static_cast<std::size_t>(
        std::count_if(d.text.begin(), d.text.end(), [](char character) { return character != ' '; }));
    if (count == 0)
        fail(where, "text", '"' + d.text + '"', "at least one letter", "Write what the plateaus are to read.");
    if (d.heights.size() != 1 && d.heights.size() != count)
        fail(where, "heights_um", fmt::format("{} heights", d.heights.size()),
             fmt::format("one, or one for each of the {} letters", count), "Give each letter its height.");
    if (!(d.text_width > 0 && d.text_width <= d.size))
        fail(where, "text_width_mm", fmt::format("{}", d.text_width),
             fmt::format("a positive length, at most the specimen's {}", d.size),
             "Choose narrower text or a larger specimen.");
    // The work is limited, as each letter is drawn over the whole grid.
    constexpr double most_drawn_points = 0x1p31; // takes some tens of seconds
    const double points = static_cast<double>(field.heights.values.size());
    if (static_cast<double>(count) * points > most_drawn_points)
        fail(where, "text",
             fmt::format("{} letters on a grid of {} x {} points", count, field.heights.columns, field.heights.rows),
             fmt::format("at most {:.0f} letters on so fine a grid", most_drawn_points / points),
             "Choose a coarser pitch_um or less text, or draw the letters as an image and name it in specimen.file.");
    // The font's size follows from the widths at a large size, to which widths are proportional.
    constexpr int trial = 1000;
    const double wanted = d.text_width / field.pitch_x;
    const int font_size = static_cast<int>(std::floor(trial * wanted / width_of(letters_of(d, trial, where), trial)));
    if (font_size < 8)
        fail(where, "text_width_mm", fmt::format("{}", d.text_width), "letters of at least 8 points of the grid",
             "Choose wider text, less of it, or a finer pitch.");
    // The limit rejects a thin letter as wide as the specimen, which would be far too high.
    constexpr int highest = 8;
    if (font_size > highest * field.heights.rows)
        fail(where, "text_width_mm", fmt::format("{}", d.text_width),
             fmt::format("letters at most {} times as high as the specimen", highest),
             "Choose narrower text, or more of it.");
    const std::vector<Letter> letters = letters_of(d, font_size, where);
    // The text's bounding box is centred on the axis.
    int top = 0, bottom = 0;
    bool first = true;
    for (const Letter& letter : letters)
        if (letter.ink.any()) {
            top = first ? letter.ink.top : std::min(top, letter.ink.top);
            bottom = first ? letter.ink.bottom : std::max(bottom, letter.ink.bottom);
            first = false;
        }
    const int columns = field.heights.columns, rows = field.heights.rows;
    const int baseline = static_cast<int>(std::lround(0.5 * rows - 0.5 * (top + bottom)));
    double x = 0.5 * (columns - width_of(letters, font_size));
    std::size_t plateau = 0;
    for (const Letter& letter : letters) {
        if (letter.ink.any()) {
            const images::DrawnLetter drawn{.letter = letter.character,
                                            .size = font_size,
                                            .font = d.font,
                                            .x = static_cast<int>(std::lround(x)) - letter.ink.left,
                                            .baseline = baseline};
            const Grid<float> mask = images::drawn(drawn, columns, rows);
            for (std::size_t k = 0; k < mask.values.size(); ++k) {
                if (mask.values[k] >= 0.5f) {
                    field.heights.values[k] = static_cast<float>(height_of(d, plateau));
                }
            }
            ++plateau;
        }
        x += gap * font_size + (letter.ink.any() ? letter.ink.width() : space * font_size);
    }
}

void set_mask(HeightField& field, const Plateaus& d, const SourceLocation& where) {
    const Grid<float> mask = read_image(d.file, where);
    std::set<float> levels(mask.values.begin(), mask.values.end());
    levels.erase(0.0f);
    if (levels.empty() || (d.heights.size() != 1 && d.heights.size() != levels.size()))
        fail(where, "heights_um", fmt::format("{} heights", d.heights.size()),
             fmt::format("one, or one for each of the {} grey values other than black in {}", levels.size(),
                         d.file.string()),
             "Give each plateau its height; smoothed edges are grey values too, so save the mask without them.");
    for (int row = 0; row < field.heights.rows; ++row)
        for (int column = 0; column < field.heights.columns; ++column) {
            // Index of the mask's pixel that contains the point.
            const auto pixel = [](int at, int points, int pixels) {
                return std::min(pixels - 1, static_cast<int>(std::int64_t{at} * pixels / points));
            };
            const float value =
                mask(pixel(column, field.heights.columns, mask.columns), pixel(row, field.heights.rows, mask.rows));
            if (value != 0)
                field.heights(column, row) = static_cast<float>(
                    height_of(d, static_cast<std::size_t>(std::distance(levels.begin(), levels.find(value)))));
        }
}

} // namespace

std::vector<const Key*> Plateaus::keys() {
    auto keys = square_keys(random_heights_keys(plateaus_sq_key));
    keys.insert(keys.end(), {&heights_key, &text_key, &font_key, &text_width_key, &plateaus_file_key});
    return keys;
}

Plateaus Plateaus::read(const Section& section) {
    Plateaus plateaus;
    read_square(section, plateaus);
    const double sq = from_um(section.number(plateaus_sq_key));
    plateaus.random = read_random_heights(section, sq, plateaus.pitch);
    for (const double height : section.numbers(heights_key)) {
        plateaus.heights.push_back(from_um(height));
    }
    if (section.has(text_key) == section.has(plateaus_file_key)) {
        section.fail(section.has(text_key) ? static_cast<const Key&>(plateaus_file_key) : text_key,
                     "either text or file", "Give the letters as text, or a mask of the plateaus as file.");
    }
    if (section.has(text_key)) {
        plateaus.text = section.text(text_key);
        plateaus.font = section.text(font_key);
        plateaus.text_width = section.number(text_width_key, 0.8 * plateaus.size);
    }
    plateaus.file = section.file_if_given(plateaus_file_key).value_or(std::filesystem::path());
    return plateaus;
}

void Plateaus::raise(HeightField& field, double, const SourceLocation& where) const {
    if (!file.empty()) {
        set_mask(field, *this, where);
        return;
    }
    // InputFile refuses pipes, on which the font library would wait.
    std::error_code none;
    if (std::filesystem::exists(font, none)) {
        (void)InputFile(font, {.key = "specimen.font", .expected = "the file of a font"});
    }
    set_text(field, *this, where);
}

std::optional<RandomHeights> Plateaus::random_heights() const {
    return random.sq > 0 ? std::optional(random) : std::nullopt;
}

dimensions::Plateaus Plateaus::feature() const {
    // A grid of this size resolves the middles of outlines; the distances of a large field would take gigabytes.
    constexpr double most_points = 1000;
    Plateaus bare = *this;
    bare.pitch = std::max(pitch, size / most_points);
    const auto made =
        generate({.square = bare, .raise = [&](HeightField& field, double asked) { bare.raise(field, asked, {}); }},
                 std::nullopt, {});
    const auto& field = std::get<HeightField>(made);
    dimensions::Plateaus feature{.nominal = {.height = Grid<double>(field.heights.columns, field.heights.rows),
                                             .x0 = field.x_min,
                                             .y0 = field.y_min,
                                             .pitch_x = field.pitch_x,
                                             .pitch_y = field.pitch_y}};
    std::ranges::copy(field.heights.values, feature.nominal.height.values.begin());
    return feature;
}

} // namespace vkfv::specimen
