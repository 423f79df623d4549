// The tables [output], and [sweep] with its parameters: their keys and readers.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace vkfv {

namespace {

struct SurfaceFormat {
    const char* name;
    const char* file;
    const char* meaning;
};
constexpr std::array surface_formats = {
    SurfaceFormat{"tiff", "topography.tif", "float32 heights in um"},
    SurfaceFormat{"x3p", "topography.x3p", "ISO 25178-72, of truth and deviation too"},
    SurfaceFormat{"sur", "topography.sur", "Digital Surf"},
    SurfaceFormat{"sdf", "topography.sdf", "ISO 25178-71"},
    SurfaceFormat{"ply", "topography.ply", "triangles for viewers"},
    SurfaceFormat{"gwy", "topography.gwy", "Gwyddion, with all maps of the result"},
    SurfaceFormat{"gsf", "topography.gsf", "Gwyddion's simple field"},
    SurfaceFormat{"npy", "topography.npy", "NumPy, float64 heights in um"},
    SurfaceFormat{"csv", "topography.csv", "a matrix of heights in um"}};

std::vector<Key::Choice> choices_of_formats() {
    std::vector<Key::Choice> choices;
    for (const auto& format : surface_formats) {
        choices.push_back({format.name, format.meaning});
    }
    return choices;
}

// The path without needless dots and separators: "a/./b/" becomes "a/b".
std::filesystem::path without_dots(const std::filesystem::path& path) {
    const auto normal = path.lexically_normal();
    return normal.has_filename() || normal == normal.root_path() ? normal : normal.parent_path();
}

using scan::PixelType;

constexpr double longest_checkpoint_interval = 1e6; // s
constexpr int bits_of_bytes = 8;

const FileKey directory = without_influence(
    FileKey("directory", Default::in_words("vkfv-out beside the configuration"), "Folder of the results."));
const TextsKey surfaces = without_influence(TextsKey("surfaces", choices_of_formats(),
                                                     {.toml = "[\"tiff\", \"x3p\"]", .text = {}, .needed = false},
                                                     "Formats of the measured surface."));
const ChoiceKey<PixelType>
    images("images",
           {{PixelType::float32, "float32", "radiant flux in W, or a camera's grey values"},
            {PixelType::uint16, "uint16", "a camera's grey values, those of averaged frames rounded"},
            {PixelType::uint8, "uint8", "the same, with camera.bit_depth of at most 8"}},
           PixelType::float32, "Values of the images' pixels.");
const ChoiceKey<bool> image_files = without_influence(
    ChoiceKey<bool>("image_files",
                    {{false, "single", "images/z_0000.tif and so on"},
                     {true, "stack", "the same, and all of them in images.tif, a z-stack for ImageJ and napari"}},
                    false, "Files of the images."));
const NumberKey checkpoint = without_influence(NumberKey(
    "checkpoint_s", NumberRange::within(0, longest_checkpoint_interval), Configuration::usual_checkpoint_interval,
    "An exposure that takes longer is kept half done, so often; 0: never."));

const ChoiceKey<bool> of =
    without_influence(ChoiceKey<bool>("of", {{false, "images", "at one height"}, {true, "stacks", "each evaluated"}},
                                      false, "What is traced for every combination."));
const NumberKey z = of_kinds({"images"}, without_influence(NumberKey("z_um", NumberRange::finite(), 0.0,
                                                                     "Height of the focal plane over best focus.")));
const IntegerKey repeats = of_kinds(
    {"stacks"}, without_influence(IntegerKey("repeats", 1, 1000, 1, "Stacks of each combination, each of its seed.")));

const TextKey parameter_key =
    for_example("\"specimen.material.g\"",
                without_influence(TextKey("key", Default::none(), "What is varied, with its table: \"trace.rays\".")));
const TextKey label = without_influence(
    TextKey("label", Default::in_words("the key's last word"), "Its name on axes and in names of folders."));
const TextsKey values = for_example(
    "[0.3, 0.65, 0.9]",
    without_influence(TextsKey("values", {}, Default::none(), "The values that it takes, numbers or texts.")));

} // namespace

const KeyTable& output_keys() {
    static const KeyTable table{.path = "output",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "Where results go, and in which formats.",
                                .subject = "an output",
                                .kind = "",
                                .keys = {&directory, &surfaces, &images, &image_files, &checkpoint}};
    return table;
}

const KeyTable& sweep_keys() {
    static const KeyTable table{.path = "sweep",
                                .presence = KeyTable::Presence::optional,
                                .meaning =
                                    "What vkfv sweep varies: every combination of the parameters' values. The same "
                                    "light is traced once for all cameras and evaluations.",
                                .subject = "a sweep",
                                .kind = "of",
                                .keys = {&of, &z, &repeats}};
    return table;
}

const KeyTable& sweep_parameter_keys() {
    static const KeyTable table{.path = "sweep.parameter",
                                .presence = KeyTable::Presence::repeated,
                                .meaning = "One that is varied; the first one slowest.",
                                .subject = "a parameter",
                                .kind = "",
                                .keys = {&parameter_key, &label, &values}};
    return table;
}

void read_output(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table_or_empty("output");
    const Section section(table, output_keys(), configuration);
    configuration.output_directory =
        without_dots(table.optional_file_path(directory.name).value_or(configuration.file.parent_path() / "vkfv-out"));
    // The canonical text lies in the folder itself, so that its "." stays right wherever the folder is moved.
    section.record_reference(directory, ".");
    const std::vector<std::string> formats =
        section.has(surfaces) ? table.value_texts(surfaces.name) : std::vector{toml_quoted("tiff"), toml_quoted("x3p")};
    for (const std::string& text : formats) {
        const auto* format = std::ranges::find_if(
            surface_formats, [&](const SurfaceFormat& candidate) { return toml_quoted(candidate.name) == text; });
        if (format == surface_formats.end()) {
            section.note(surfaces, surfaces.allowed(), fmt::format("Remove {}.", text));
            break;
        }
        configuration.topography_files.emplace_back(format->file);
    }
    section.record(surfaces, fmt::format("[{}]", fmt::join(formats, ", ")));
    configuration.stack_file = section.choice(image_files);
    configuration.checkpoint_interval = section.number(checkpoint);
    configuration.pixel_type = section.choice(images);
    if (configuration.pixel_type != PixelType::float32 && !configuration.camera && root.sound("camera")) {
        section.note(images, "\"float32\" without a [camera]: light in W has no whole numbers",
                     "Choose images = \"float32\", or add a [camera].");
    } else if (configuration.pixel_type == PixelType::uint8 && configuration.camera &&
               configuration.camera->bit_depth > bits_of_bytes) {
        section.note(
            images,
            fmt::format("\"uint16\" or \"float32\" for grey values of {} bits", configuration.camera->bit_depth),
            "Choose one of these, or camera.bit_depth = 8 with a gain that suits it.");
    }
}

// Reads [sweep]. No image and no stack depends on it, so nothing of it is recorded.
void read_sweep(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("sweep");
    if (!table) {
        return;
    }
    Sweep sweep;
    sweep.stacks = of.value_of(table->optional_choice(of.name, of.choice_names()).value_or(of.fallback_text()));
    if (!sweep.stacks) {
        sweep.focal_height = from_um(table->optional_number(z.name).value_or(0));
    } else if (table->has(z.name)) {
        table->fail(z.name, "no focal height for a sweep of stacks", "Remove it; [scan] has the heights.");
    }
    if (sweep.stacks) {
        sweep.repeats =
            static_cast<int>(table->optional_integer(repeats.name, repeats.minimum, repeats.maximum).value_or(1));
    } else if (table->has(repeats.name)) {
        table->fail(repeats.name, "no repeats of a sweep of images", "Remove it; vary trace.seed instead.");
    }
    for (const TomlTable& one : table->tables("parameter")) {
        Sweep::Parameter parameter;
        parameter.key = one.string(parameter_key.name);
        if ((parameter.key.starts_with("sweep.") && parameter.key != "sweep.z_um") ||
            parameter.key.starts_with("output.")) {
            one.fail(parameter_key.name, "a key that decides what is traced or evaluated", "Choose another.");
        }
        if (std::ranges::find(sweep.parameters, parameter.key, &Sweep::Parameter::key) != sweep.parameters.end()) {
            one.fail(parameter_key.name, "each key once", "Put all values into one parameter.");
        }
        // Without a label, the last word of the key is the label.
        parameter.label = one.optional_string(label.name).value_or(parameter.key.substr(parameter.key.rfind('.') + 1));
        const auto is_control = [](char character) { return std::iscntrl(static_cast<unsigned char>(character)) != 0; };
        if (parameter.label.find_first_of("/\\=") != std::string::npos ||
            std::ranges::any_of(parameter.label, is_control)) {
            one.fail(label.name, "a word without '/', '\\', '=' and control characters", "Folders are named after it.");
        }
        parameter.values = one.value_texts(values.name);
        sweep.parameters.push_back(std::move(parameter));
    }
    configuration.sweep = std::move(sweep);
}

} // namespace vkfv
