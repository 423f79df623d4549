#include "configuration/configuration.hpp"

#include "configuration/tables.hpp"
#include "core/files/assets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

namespace vkfv {

namespace {

// Requires that every medium has an index over the source's whole spectrum. The error stands at the wavelength's key
// and names the medium.
void require_indices(const Configuration& configuration, const LightOfSource& light) {
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
        const auto& spectrum = light.spectrum;
        require(part, medium, light.key, {spectrum.shortest_um, spectrum.longest_um, spectrum.reference_um});
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
    for (const optics::MeshElement& mesh : instrument.meshes) {
        require_over_spectrum("the mesh element", mesh.glass);
        require_over_spectrum("what surrounds the mesh element", mesh.surrounding);
    }
    if (instrument.interfaces.model == optics::Interfaces::Model::quarter_wave) {
        require("the quarter-wave layer", instrument.interfaces.layer, "interfaces.design_wavelength_um",
                {instrument.interfaces.design_wavelength_um});
    }
}

// Requires that an ideal lens takes no more light than a half space.
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

// Requires one spectrum where the camera or the blur treats the sum of all light, which has the spectrum of all sources
// together. Sources with different spectra light the specimen unevenly, so that its light is another mixture.
void require_one_spectrum(const Configuration& configuration) {
    const auto& sources = configuration.instrument.further_sources;
    const auto other = std::ranges::find_if(sources, [](const auto& source) { return source.spectrum.has_value(); });
    const char* const part = configuration.camera             ? "[camera]"
                             : configuration.diffraction.airy ? "[diffraction] model = \"airy\""
                                                              : nullptr;
    if (other != sources.end() && part != nullptr) {
        throw InputError({.where = configuration.places.at(other->key),
                          .key = other->key,
                          .found = "sources of different spectra",
                          .expected = fmt::format("one spectrum of all sources with {}, which knows the spectrum of "
                                                  "their sum alone",
                                                  part),
                          .remedy = fmt::format("Give all the same wavelength or spectrum, or take {} out.", part)});
    }
}

void read_instrument(const TomlTable& root, Configuration& configuration) {
    std::vector<LightOfSource> lights;
    root.attempt("source", [&] { lights = read_source(root, configuration); });
    const std::pair<const char*, void (*)(const TomlTable&, Configuration&)> parts[] = {
        {"illumination", read_illumination},  {"beam_splitter", read_beam_splitter},
        {"fold_mirror", read_fold_mirrors},   {"interfaces", read_interfaces},
        {"objective", read_objective},        {"cover_glass", read_cover_glass},
        {"tube_lens", read_tube_lens},        {"detector", read_detector},
        {"mesh_element", read_mesh_elements}, {"camera", read_camera}};
    for (const auto& [key, read] : parts) {
        root.attempt(key, [&, read = read] { read(root, configuration); }); // clang 14 captures no binding by name
    }
    if (root.sound("")) { // checks that need all tables
        root.attempt("source", [&] {
            for (const LightOfSource& light : lights) {
                require_indices(configuration, light);
            }
        });
        root.attempt("objective", [&] { require_possible_aperture(root, configuration); });
    }
}

} // namespace

Configuration load_configuration(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides,
                                 Needs needs) {
    const auto found = given_or_installed(file);
    auto configuration = read_configuration(TomlTable::open(found, overrides), needs);
    // Results do not go beside an installed example, where nobody can write, but to the working directory.
    if (const auto beside = configuration.output_directory.lexically_relative(found.parent_path());
        found != file && !beside.empty() && *beside.begin() != "..") { // empty: --out is the working directory
        configuration.output_directory = beside;
    }
    return configuration;
}

Configuration read_configuration(const TomlTable& root, Needs needs) {
    Configuration configuration;
    configuration.file = root.where().file;
    configuration.identity = fmt::format("program = \"vkfv {}\"\n", VKFV_VERSION);
    root.collect_problems(); // all problems are reported together
    read_glass_catalogs(root, configuration);
    read_instrument(root, configuration);
    if (needs != Needs::instrument || root.has("specimen")) {
        root.attempt("specimen", [&] { read_specimen(root, configuration); });
    }
    if (needs == Needs::stack || root.has("scan")) {
        root.attempt("scan", [&] { read_scan(root, configuration); });
    }
    root.attempt("stage", [&] { read_stage(root, configuration); });
    root.attempt("trace", [&] { read_trace(root, configuration); });
    root.attempt("diffraction", [&] { read_diffraction(root, configuration); });
    root.attempt("source", [&] { require_one_spectrum(configuration); });
    root.attempt("topography", [&] { read_topography(root, configuration, needs); });
    root.attempt("output", [&] { read_output(root, configuration); });
    root.attempt("sweep", [&] { read_sweep(root, configuration); });
    root.attempt("uncertainty", [&] { read_uncertainty(root, configuration); });
    root.reject_unknown_keys();
    return configuration;
}

Configuration topography_configuration(const std::vector<TomlOverride>& overrides) {
    const TomlTable root = TomlTable::parse("", "command line", overrides);
    Configuration configuration;
    root.collect_problems();
    root.attempt("topography", [&] { read_topography(root, configuration, Needs::exposure); });
    root.reject_unknown_keys();
    return configuration;
}

} // namespace vkfv
