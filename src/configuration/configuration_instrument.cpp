#include "configuration/configuration_instrument.hpp"

#include "configuration/configuration_section.hpp"
#include "core/digest.hpp"
#include "core/number_table.hpp"
#include "core/units.hpp"
#include "optics/ideal_lens.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv {

namespace {

constexpr std::int64_t most_pixels = 16384;               // a side; the accumulator stays within 2 GiB
constexpr double least_flux = 1e-15, largest_flux = 1e15; // W; what falls on a pixel stays a float32
constexpr double default_tube_lens_distance = 100;        // mm, in the infinity space
constexpr double default_splitter_reflectance = 0.5;
constexpr double share_rounding = 1e-12; // of 0.7 + 0.3
constexpr NumberRange share_range = {.minimum = 0, .maximum = 1, .minimum_included = false};
constexpr NumberRange wavelength_range_um = {.minimum = 0.1, .maximum = 100}; // wide of every glass
constexpr NumberRange offset_range = {.minimum = -1e6, .maximum = 1e6};       // mm
constexpr NumberRange tilt_range_deg = {.minimum = -360, .maximum = 360};

constexpr const char* glass_catalogs_key = "glass_catalogs";

std::string digest_of(const optics::Medium& medium) {
    return Digest().add(medium.dispersion_text()).text();
}

std::string content_digest(const optics::Prescription& prescription) {
    Digest digest;
    const auto add_medium = [&](const optics::Medium& medium) { digest.add(medium.dispersion_text() + ";"); };
    add_medium(prescription.medium_before);
    for (const auto& surface : prescription.surfaces) {
        for (const auto& change : surface.breaks) {
            digest.add(fmt::format("{} {} {} {} {} {} {};", change.decentre_x, change.decentre_y, change.tilt_x,
                                   change.tilt_y, change.tilt_z, change.tilt_first, change.thickness));
        }
        digest.add(fmt::format("{} {} {} {} {} {} {};", surface.curvature, surface.conic,
                               fmt::join(surface.aspheric, " "), surface.thickness, surface.semi_diameter.value_or(0),
                               surface.ideal_power.value_or(0), static_cast<int>(surface.role)));
        add_medium(surface.medium_after);
    }
    digest.add(fmt::format("{}", prescription.source_distance.value_or(0)));
    return digest.text();
}

std::string remedy_for_prescription(const std::string& name, const std::string& folder,
                                    const std::filesystem::path& base) {
    const auto meant = nearest_word(name, optics::prescription_names(folder, base));
    return fmt::format("{}Correct the name, or give the path of a prescription (.toml).",
                       meant ? fmt::format("Did you mean \"{}\"? ", *meant) : "");
}

optics::Prescription read_prescription(const OldSection& section, const Configuration& configuration,
                                       const std::string& folder, const std::optional<std::string>& fallback = {}) {
    const std::string key = "prescription";
    const TomlTable& table = section.table();
    std::string name = fallback ? table.optional_string(key).value_or(*fallback) : table.string(key);
    if (name.ends_with(".toml")) {
        name = absolute_path(table.file_path(key)).string();
    }
    const auto base = absolute_path(configuration.file).parent_path(); // also of a file in the working directory
    if (!optics::find_prescription(name, folder, base)) {
        table.note(key,
                   fmt::format("{}; {}",
                               name.ends_with(".toml")
                                   ? "an existing file"
                                   : fmt::format("the name of a file in assets/{}, without .toml", folder),
                               optics::searched_for_prescription(name, folder, base)),
                   remedy_for_prescription(name, folder, base));
        return optics::Prescription();
    }
    optics::Prescription prescription;
    if (table.sound(glass_catalogs_key)) { // else its glasses may be in the one that could not be read
        table.attempt(key,
                      [&] { prescription = optics::load_prescription(name, folder, base, configuration.glasses); });
    }
    if (prescription.surfaces.empty()) { // noted
        return prescription;
    }
    // A name that means the installed file means it from anywhere; another's path is kept.
    if (optics::find_prescription(name, folder, {}) != prescription.file) {
        name = absolute_path(prescription.file).string();
    }
    section.record_reference(key, name, content_digest(prescription));
    return prescription;
}

optics::Medium read_glass(const OldSection& section, const Configuration& configuration, const std::string& key,
                          const std::string& fallback) {
    const TomlTable& table = section.table();
    const std::string name = table.optional_string(key).value_or(fallback);
    const auto glass = name == optics::Medium::air().name ? optics::Medium::air() : configuration.glasses.find(name);
    if (!glass) {
        const auto meant = optics::nearest_glass(configuration.glasses, name);
        if (table.sound(glass_catalogs_key)) { // else it may be in the one that could not be read
            table.note(key, "the name of a glass, built in or of a catalogue",
                       fmt::format("{}Correct the name, or add its catalogue to glass_catalogs.",
                                   meant ? fmt::format("Did you mean \"{}\"? ", *meant) : ""));
        }
        return optics::Medium::air();
    }
    section.record_reference(key, name, digest_of(*glass));
    return *glass;
}

optics::Placement read_placement(const OldSection& section) {
    const auto offset = [&](const char* key) { return section.number(key, offset_range, 0.0); };
    const auto tilt = [&](const char* key) { return section.number(key, tilt_range_deg, 0.0) * radians_per_degree; };
    optics::Placement placement;
    placement.change.decentre_x = offset("decentre_x_mm");
    placement.change.decentre_y = offset("decentre_y_mm");
    placement.change.tilt_x = tilt("tilt_x_deg");
    placement.change.tilt_y = tilt("tilt_y_deg");
    placement.change.tilt_z = tilt("tilt_z_deg");
    placement.change.tilt_first = section.boolean("tilt_first", false);
    const std::string global = "global_mm";
    if (section.table().has(global)) {
        const auto point = section.numbers(global, offset_range);
        if (point.size() != 3) {
            section.table().note(global, "three numbers: x, y and z in mm, from the object's plane on",
                                 "Give the place of the first vertex.");
        } else {
            placement.global = glm::dvec3(point[0], point[1], point[2]);
        }
    }
    return placement;
}

const KeysOfKinds spectrum_keys = {{"monochromatic", {"wavelength_um"}},
                                   {"lines", {"wavelengths_um", "weights"}},
                                   {"gaussian", {"centre_um", "full_width_um"}},
                                   {"table", {"wavelengths_um", "densities", "file"}}};

std::vector<std::string> kinds_of(const KeysOfKinds& keys_of_kinds) {
    std::vector<std::string> kinds;
    for (const auto& [kind, keys] : keys_of_kinds) {
        kinds.push_back(kind);
    }
    return kinds;
}

optics::Spectrum read_spectrum_file(const OldSection& section) {
    const TomlTable& table = section.table();
    const auto file = looked_for(table.file_path("file"));
    Digest digest;
    std::vector<double> wavelengths;
    std::vector<double> densities;
    as_named(table, "file", file, [&] {
        for (const auto& point :
             read_number_table(file, {"wavelength_um", "density"}, table.path() + ".file", "point")) {
            digest.add_values(std::span<const double>(point.values));
            wavelengths.push_back(point.values[0]);
            densities.push_back(point.values[1]);
            if (!wavelength_range_um.contains(point.values[0])) {
                throw InputError(
                    {.where = {.file = file, .line = point.line, .column = 1},
                     .key = "wavelength_um",
                     .found = fmt::format("{}", point.values[0]),
                     .expected = "a wavelength " + wavelength_range_um.to_string() + " um",
                     .remedy =
                         remedy_for_length_um(point.values[0], wavelength_range_um).value_or("Correct this field.")});
            }
        }
    });
    section.record_reference("file", absolute_path(file).string(), digest.text());
    return optics::Spectrum::table(wavelengths, densities);
}

optics::Spectrum read_spectrum_table(const OldSection& section) {
    const TomlTable& table = section.table();
    const std::string kind = section.kind("kind", kinds_of(spectrum_keys));
    reject_keys_of_other_kinds(table, spectrum_keys, kind, "a spectrum");
    if (kind == "monochromatic") {
        return optics::Spectrum::line(section.number("wavelength_um", wavelength_range_um));
    }
    if (kind == "lines") {
        const auto wavelengths = section.numbers("wavelengths_um", wavelength_range_um);
        return optics::Spectrum::lines(wavelengths, section.numbers("weights", NumberRange::at_least(0)));
    }
    if (kind == "gaussian") {
        const double centre = section.number("centre_um", wavelength_range_um);
        // A wider one is no spectrum about the centre, and tells nanometres from micrometres.
        const NumberRange widths = {.minimum = 0, .maximum = centre, .minimum_included = false};
        return optics::Spectrum::gaussian(
            centre, section.number("full_width_um",
                                   table.sound(table.path() + ".centre_um") ? widths : NumberRange::positive()));
    }
    if (table.has("file")) {
        for (const char* key : {"wavelengths_um", "densities"}) {
            if (table.has(key)) {
                table.note(key, "the spectrum in a file or in the configuration, not both", "Remove one of the two.");
            }
        }
        return read_spectrum_file(section);
    }
    const auto wavelengths = section.numbers("wavelengths_um", wavelength_range_um);
    return optics::Spectrum::table(wavelengths, section.numbers("densities", NumberRange::at_least(0)));
}

// Gives the key that the wavelengths stand at.
std::string read_spectrum(const OldSection& source, Configuration& configuration) {
    const std::string wavelength = "wavelength_um";
    auto& spectrum = configuration.instrument.spectrum;
    const auto table = source.table().optional_table("spectrum");
    if (!table) {
        spectrum = optics::Spectrum::line(source.number(wavelength, wavelength_range_um, 0.5876));
        return "source." + wavelength;
    }
    if (source.table().has(wavelength)) {
        source.table().note(wavelength, "a wavelength or [source.spectrum], not both", "Remove one of the two.");
    }
    const OldSection section(*table, configuration);
    source.table().attempt("spectrum", [&] {
        at_its_place(configuration, table->where(), [&] { spectrum = read_spectrum_table(section); });
    });
    return table->path();
}

optics::RingLightDescription read_ring(const OldSection& source) {
    optics::RingLightDescription ring;
    ring.distance = source.number("distance_mm", NumberRange::positive());
    ring.elevation = source.number("elevation_deg", NumberRange::between(0, 90)) * radians_per_degree;
    ring.width = source.number("width_mm", NumberRange::positive());
    ring.segments = static_cast<int>(source.integer("segments", 1, physics::f64::RING_CAPACITY, 1));
    ring.fill = source.number("fill", share_range, 1.0);
    ring.on = source.booleans("on", std::vector<bool>(static_cast<std::size_t>(ring.segments), true));
    if (ring.on.size() != static_cast<std::size_t>(ring.segments) ||
        std::ranges::find(ring.on, true) == ring.on.end()) {
        source.table().fail(
            "on",
            fmt::format("{} of true and false, one a segment from +x towards +y, at least one true", ring.segments),
            "Give each segment its state, and switch one on.");
    }
    return ring;
}

std::string read_source(const TomlTable& root, Configuration& configuration) {
    static const KeysOfKinds keys = {{"disc", {"radius_mm"}},
                                     {"ring", {"elevation_deg", "width_mm", "segments", "fill", "on"}}};
    auto& instrument = configuration.instrument;
    const OldSection source(root.table("source"), configuration);
    const std::string kind = source.kind("kind", kinds_of(keys), "disc");
    reject_keys_of_other_kinds(source.table(), keys, kind, "a source");
    instrument.flux = source.number("flux_W", NumberRange::within(least_flux, largest_flux), 1.0);
    if (kind == "ring") {
        instrument.ring = read_ring(source);
    } else {
        instrument.source_radius = source.number("radius_mm", NumberRange::positive());
        instrument.source_distance = source.number_if_given("distance_mm", NumberRange::positive());
    }
    return read_spectrum(source, configuration);
}

void read_illumination(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    if (instrument.ring) {
        if (root.has("illumination")) {
            root.fail("illumination",
                      "no [illumination] with a source of kind \"ring\", which shines past the objective",
                      "Remove it, or choose a source of kind \"disc\".");
        }
        return;
    }
    const OldSection illumination(root.table_or_empty("illumination"), configuration);
    instrument.illumination = read_prescription(illumination, configuration, "illuminators", "koehler");
    instrument.field_stop_radius = illumination.number_if_given("field_stop_radius_mm", NumberRange::positive());
    instrument.illumination_aperture_radius =
        illumination.number_if_given("aperture_radius_mm", NumberRange::positive());
    instrument.illumination_to_objective =
        illumination.number_if_given("objective_distance_mm", NumberRange::at_least(0));
}

void read_beam_splitter(const TomlTable& root, Configuration& configuration) {
    using Kind = optics::BeamSplitter::Kind;
    static const KeysOfKinds keys = {{"ideal", {}},
                                     {"plate", {"glass", "thickness_mm", "semi_diameter_mm"}},
                                     {"cube", {"glass", "edge_mm", "semi_diameter_mm"}}};
    auto& splitter = configuration.instrument.splitter;
    const OldSection section(root.table_or_empty("beam_splitter"), configuration);
    const std::string kind = section.kind("kind", kinds_of(keys), "ideal");
    reject_keys_of_other_kinds(section.table(), keys, kind, "a beam splitter");
    splitter.kind = kind == "plate" ? Kind::plate : kind == "cube" ? Kind::cube : Kind::ideal;
    // A ring light does without its reflection.
    const bool reflects = !configuration.instrument.ring && root.sound("source");
    splitter.reflectance = section.number(
        "reflectance", {.minimum = 0, .maximum = 1, .minimum_included = !reflects, .maximum_included = false},
        default_splitter_reflectance);
    splitter.transmittance = section.number("transmittance", share_range, 1 - splitter.reflectance);
    if (splitter.reflectance + splitter.transmittance > 1 + share_rounding) {
        section.table().fail("transmittance", fmt::format("at most 1 - reflectance = {:.6g}", 1 - splitter.reflectance),
                             "Choose a smaller one; what both leave of 1 is absorbed.");
    }
    if (splitter.kind != Kind::ideal) {
        splitter.glass = read_glass(section, configuration, "glass", "N-BK7");
        splitter.size =
            section.number(splitter.kind == Kind::plate ? "thickness_mm" : "edge_mm", NumberRange::positive());
        splitter.semi_diameter = section.number_if_given("semi_diameter_mm", NumberRange::positive());
    }
    splitter.distance = section.number_if_given("distance_mm", NumberRange::at_least(0));
}

void read_fold_mirrors(const TomlTable& root, Configuration& configuration) {
    using Path = optics::FoldMirror::Path;
    for (const auto& table : root.optional_tables("fold_mirror")) {
        const OldSection section(table, configuration);
        optics::FoldMirror mirror;
        mirror.path =
            section.choice("path", {"imaging", "illumination"}) == "imaging" ? Path::imaging : Path::illumination;
        if (mirror.path == Path::illumination && configuration.instrument.ring) {
            table.fail("path", "\"imaging\", as a ring light has no illumination path", "Remove the mirror.");
        }
        mirror.distance = section.number("distance_mm", NumberRange::at_least(0));
        mirror.incidence = section.number("incidence_deg", NumberRange::between(0, 90), 45.0) * radians_per_degree;
        mirror.azimuth = section.number("azimuth_deg", tilt_range_deg, 0.0) * radians_per_degree;
        mirror.semi_diameter = section.number("semi_diameter_mm", NumberRange::positive());
        mirror.reflectance = section.number("reflectance", share_range, 1.0);
        configuration.instrument.fold_mirrors.push_back(mirror);
    }
}

void read_interfaces(const TomlTable& root, Configuration& configuration) {
    using Model = optics::Interfaces::Model;
    static const KeysOfKinds keys = {
        {"ideal", {}}, {"fresnel", {}}, {"quarter-wave", {"layer", "design_wavelength_um"}}};
    auto& interfaces = configuration.instrument.interfaces;
    const OldSection section(root.table_or_empty("interfaces"), configuration);
    const std::string model = section.kind("model", kinds_of(keys), "ideal");
    reject_keys_of_other_kinds(section.table(), keys, model, "interfaces");
    interfaces.model = model == "fresnel"        ? Model::fresnel
                       : model == "quarter-wave" ? Model::quarter_wave
                                                 : Model::ideal;
    if (interfaces.model == Model::quarter_wave) {
        interfaces.layer = read_glass(section, configuration, "layer", "MgF2");
        interfaces.design_wavelength_um =
            section.number("design_wavelength_um", wavelength_range_um, interfaces.design_wavelength_um);
    }
}

void read_objective(const TomlTable& root, Configuration& configuration) {
    static const KeysOfKinds keys = {{"prescription", {"prescription", "aperture_stop_radius_mm"}},
                                     {"ideal", {"focal_length_mm", "numerical_aperture"}}};
    auto& instrument = configuration.instrument;
    const OldSection section(root.table("objective"), configuration);
    const std::string kind = section.kind("kind", kinds_of(keys), "prescription");
    reject_keys_of_other_kinds(section.table(), keys, kind, "an objective");
    if (section.table().has("immersion")) {
        instrument.immersion = read_glass(section, configuration, "immersion", "");
    }
    if (kind == "ideal") {
        const double focal_length = section.number("focal_length_mm", NumberRange::positive());
        instrument.objective =
            optics::ideal_objective(focal_length, section.number("numerical_aperture", NumberRange::positive()));
    } else {
        instrument.objective = read_prescription(section, configuration, "objectives");
        instrument.aperture_stop_radius = section.number_if_given("aperture_stop_radius_mm", NumberRange::positive());
    }
    instrument.objective_placement = read_placement(section);
}

void read_tube_lens(const TomlTable& root, Configuration& configuration) {
    static const KeysOfKinds keys = {{"prescription", {"prescription"}}, {"ideal", {"focal_length_mm"}}};
    auto& instrument = configuration.instrument;
    const OldSection section(root.table("tube_lens"), configuration);
    const std::string kind = section.kind("kind", kinds_of(keys), "prescription");
    reject_keys_of_other_kinds(section.table(), keys, kind, "a tube lens");
    instrument.tube_lens = kind == "ideal"
                               ? optics::ideal_lens(section.number("focal_length_mm", NumberRange::positive()))
                               : read_prescription(section, configuration, "tube_lenses");
    instrument.objective_to_tube_lens =
        section.number("distance_mm", NumberRange::at_least(0), default_tube_lens_distance);
    instrument.tube_lens_placement = read_placement(section);
}

void read_cover_glass(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("cover_glass");
    if (!table) {
        return;
    }
    const OldSection section(*table, configuration);
    optics::CoverGlass glass;
    glass.thickness = section.number("thickness_mm", NumberRange::positive());
    glass.glass = read_glass(section, configuration, "glass", "N-BK7");
    glass.distance = section.number_if_given("distance_mm", NumberRange::positive());
    configuration.instrument.cover_glass = glass;
}

void read_detector(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const OldSection detector(root.table("detector"), configuration);
    instrument.detector_size = detector.number("size_mm", NumberRange::positive());
    instrument.detector_pixels = static_cast<int>(detector.integer("pixels", 1, most_pixels));
    instrument.detector_placement = read_placement(detector);
}

// That every medium has an index over the whole spectrum: else an error at the wavelength, which names the medium.
void require_indices(const Configuration& configuration, const std::string& wavelength_key) {
    const auto& instrument = configuration.instrument;
    const auto require = [&](const std::string& part, const optics::Medium& medium, const std::string& key,
                             std::initializer_list<double> wavelengths_um) {
        for (const double wavelength_um : wavelengths_um) {
            try {
                (void)medium.index(wavelength_um);
            } catch (const InputError& error) {
                throw error.with_each([&](InputProblem& problem) {
                    problem.where = configuration.places.at(key);
                    problem.expected += fmt::format(": {} in {}", problem.key, part);
                    problem.key = key;
                });
            }
        }
    };
    const auto require_over_spectrum = [&](const std::string& part, const optics::Medium& medium) {
        const auto& spectrum = instrument.spectrum;
        require(part, medium, wavelength_key, {spectrum.shortest_um, spectrum.longest_um, spectrum.reference_um});
    };
    const auto require_all_of = [&](const char* role, const optics::Prescription& prescription) {
        const std::string part = fmt::format("the {} {}", role, prescription.name);
        require_over_spectrum(part, prescription.medium_before);
        for (const auto& surface : prescription.surfaces) {
            require_over_spectrum(part, surface.medium_after);
        }
    };
    require_all_of("illumination", instrument.illumination);
    require_over_spectrum("the beam splitter", instrument.splitter.glass);
    require_all_of("objective", instrument.objective);
    if (instrument.immersion) {
        require_over_spectrum("the immersion", *instrument.immersion);
    }
    if (instrument.cover_glass) {
        require_over_spectrum("the cover glass", instrument.cover_glass->glass);
    }
    require_all_of("tube lens", instrument.tube_lens);
    if (instrument.interfaces.model == optics::Interfaces::Model::quarter_wave) {
        require("the quarter-wave layer", instrument.interfaces.layer, "interfaces.design_wavelength_um",
                {instrument.interfaces.design_wavelength_um});
    }
}

// An ideal lens takes no more than a half space of light.
void require_possible_aperture(const TomlTable& root, const Configuration& configuration) {
    const auto& instrument = configuration.instrument;
    const TomlTable objective = root.table("objective");
    if (const auto aperture = objective.optional_number("numerical_aperture")) {
        const auto& medium = instrument.immersion.value_or(optics::Medium::air());
        const double index = medium.index(instrument.spectrum.reference_um);
        if (!(*aperture < index)) {
            objective.fail("numerical_aperture",
                           fmt::format("a number below {:.6g}, the index of {}", index, medium.name),
                           "Choose a smaller one, or an immersion.");
        }
    }
}

} // namespace

void read_glass_catalogs(const TomlTable& root, Configuration& configuration) {
    const std::string key = glass_catalogs_key;
    std::vector<std::string> paths;
    for (const auto& path : root.optional_file_paths(key)) {
        const auto file = looked_for(path);
        root.attempt(fmt::format("{}[{}]", key, paths.size()),
                     [&] { as_named(root, key, file, [&] { configuration.glasses.add(file); }); });
        paths.push_back(toml_quoted(absolute_path(path).string()));
    }
    // Glasses count by the digests of what uses them, so the identity does without the catalogues.
    if (!paths.empty()) {
        configuration.canonical += fmt::format("{} = [{}]\n", key, fmt::join(paths, ", "));
        configuration.places[key] = root.where(key);
    }
}

void read_instrument(const TomlTable& root, Configuration& configuration) {
    std::string wavelength_key;
    root.attempt("source", [&] { wavelength_key = read_source(root, configuration); });
    const std::pair<const char*, void (*)(const TomlTable&, Configuration&)> parts[] = {
        {"illumination", read_illumination}, {"beam_splitter", read_beam_splitter},
        {"fold_mirror", read_fold_mirrors},  {"interfaces", read_interfaces},
        {"objective", read_objective},       {"cover_glass", read_cover_glass},
        {"tube_lens", read_tube_lens},       {"detector", read_detector}};
    for (const auto& [key, read] : parts) {
        root.attempt(key, [&] { read(root, configuration); });
    }
    if (root.sound("")) { // what takes all of them together
        root.attempt("source", [&] { require_indices(configuration, wavelength_key); });
        root.attempt("objective", [&] { require_possible_aperture(root, configuration); });
    }
}

} // namespace vkfv
