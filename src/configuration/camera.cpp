// The table [camera]: its keys and its reader.
#include "camera/presets.hpp"
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv {

namespace {

using camera::ExposureControl;
using camera::Preset;

constexpr double ms_per_s = 1e3, percent = 100;
constexpr std::int64_t fewest_bits = 6, most_bits = 16, most_frames = 10000;
constexpr double least_full_well = 50, largest_full_well = 1e7; // e-
constexpr double largest_photo_response = 10;                   // %; beyond it a mean response means little

const ChoiceKey<Preset>
    preset("preset",
           {{Preset::none, "none", "all values are given here"},
            {Preset::imx250, "IMX250", "a camera with Sony's IMX250 at 525 nm, by figures that are not verified"},
            {Preset::imx900, "IMX900", "a camera with Sony's IMX900 at 536 nm, by figures that are not verified"}},
           Preset::none, "The camera whose values hold where none are given.");
const Default of_preset = Default::in_words("the preset's; must be given without one");
const NumberKey efficiency("quantum_efficiency", NumberRange::share(), of_preset,
                           "Electrons a photon, at all wavelengths.");
const NumbersKey efficiency_wavelengths("efficiency_wavelengths_um", wavelength_range_um, Default::in_words("none"),
                                        "Wavelengths in vacuum, ascending, of quantum_efficiencies.");
const NumbersKey efficiencies("quantum_efficiencies", NumberRange::share(), Default::in_words("none"),
                              "Electrons a photon at each of these wavelengths, linear between them, in place of "
                              "quantum_efficiency.");
const NumberKey full_well("full_well_e", NumberRange::within(least_full_well, largest_full_well), of_preset,
                          "Saturation capacity of EMVA 1288 in electrons: the mean charge of largest temporal "
                          "variance, from which the charge of the clip follows.");
const NumberKey read_noise("read_noise_e", NumberRange::at_least(0), of_preset,
                           "Temporal dark noise in electrons, without quantisation.");
const NumberKey dark_current("dark_current_e_per_s", NumberRange::at_least(0), 0.0, "Electrons a second in the dark.");
const NumberKey gain("gain_dn_per_e", NumberRange::positive(), of_preset, "Grey values (DN) an electron, K.");
const NumberKey offset("offset_dn", NumberRange::at_least(0), of_preset, "Grey value without charge.");
const IntegerKey bit_depth = with_default(
    of_preset, IntegerKey("bit_depth", fewest_bits, most_bits, needed,
                          "Bits of a grey value, which is rounded and ends at 2^bit_depth - 1. With other bits "
                          "than the preset's its gain and offset change by as many powers of 2."));
const NumberKey dark_signal("dsnu_e", NumberRange::at_least(0), of_preset,
                            "Dark signal nonuniformity: standard deviation of the pixels' dark signals in electrons.");
const NumberKey photo_response("prnu_percent", NumberRange::within(0, largest_photo_response), of_preset,
                               "Photo response nonuniformity: standard deviation of the pixels' responses over their "
                               "mean.");
const ChoiceKey<ExposureControl>
    exposure("exposure",
             {{ExposureControl::stack, "stack", "the stack's brightest light takes the share `saturation`"},
              {ExposureControl::first, "first", "the first image's brightest light takes it"},
              {ExposureControl::time, "time", "exposure_ms, with the light of source.flux_W"}},
             ExposureControl::stack, "What sets the exposure time, the same for all images.");
const NumberKey exposure_time =
    of_kinds({"time"}, for_example("5.0", NumberKey("exposure_ms", NumberRange::positive(), needed, "Exposure time.")));
const NumberKey saturation = of_kinds({"stack", "first"}, NumberKey("saturation", share_range, 0.8,
                                                                    "Share of full_well_e that the brightest light "
                                                                    "takes, or of the charge at which grey values end, "
                                                                    "by a probe of few rays before the stack."));
const IntegerKey frames("frames", 1, most_frames, 1, "Frames that are averaged to an image.");
const IntegerKey seed("seed", 0, largest_seed, 1,
                      "Seed of the camera's fixed patterns and, with noise_seed, of its noise.");
const IntegerKey noise_seed("noise_seed", 0, largest_seed, Default::in_words("trace.seed"),
                            "Seed of the camera's temporal noise. Stacks that differ in it alone are repeated images "
                            "of the same light, which a sweep traces once.");

camera::QuantumEfficiency read_efficiency(const Section& section, const optics::Spectrum& spectrum,
                                          const std::optional<camera::CameraOptions>& preset_values) {
    camera::QuantumEfficiency read;
    if (!section.has(efficiencies) && !section.has(efficiency_wavelengths)) {
        read.values = {preset_values ? section.number(efficiency, preset_values->quantum_efficiency.values.front())
                                     : section.number(efficiency)};
        return read;
    }
    if (section.has(efficiency)) {
        section.fail(efficiency, "one number or quantum_efficiencies, not both", "Remove one of the two.");
    }
    read.wavelengths_um = section.numbers(efficiency_wavelengths);
    read.values = section.numbers(efficiencies);
    if (read.values.size() != read.wavelengths_um.size() || read.values.empty()) {
        section.fail(efficiencies, fmt::format("{} numbers, one a wavelength", read.wavelengths_um.size()),
                     "Give each wavelength its quantum efficiency.");
    }
    if (std::ranges::adjacent_find(read.wavelengths_um, std::greater_equal()) != read.wavelengths_um.end()) {
        section.fail(efficiency_wavelengths, "ascending wavelengths", "Sort them, each with its quantum efficiency.");
    }
    if (!read.covers(spectrum.shortest_um, spectrum.longest_um)) {
        section.fail(efficiency_wavelengths,
                     fmt::format("points over the source's spectrum, {:.4g} to {:.4g} um", spectrum.shortest_um,
                                 spectrum.longest_um),
                     "Add the wavelengths that are missing.");
    }
    return read;
}

} // namespace

const KeyTable& camera_keys() {
    static const KeyTable table{
        .path = "camera",
        .presence = KeyTable::Presence::optional,
        .meaning = "The camera by EMVA Standard 1288: light becomes electrons and grey values (DN), with their noise. "
                   "Without this table images are light, in W.",
        .subject = "",
        .kind = "exposure",
        .keys = {&preset, &efficiency, &efficiency_wavelengths, &efficiencies, &full_well, &read_noise, &dark_current,
                 &gain, &offset, &bit_depth, &dark_signal, &photo_response, &exposure, &exposure_time, &saturation,
                 &frames, &seed, &noise_seed}};
    return table;
}

void read_camera(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("camera");
    if (!table) {
        return;
    }
    const Section section(*table, camera_keys(), configuration);
    const Preset chosen = section.choice(preset);
    table->require(preset.name); // the preset decides which other keys must be given
    auto values = camera::preset_camera(chosen);
    const auto number = [&](const NumberKey& key, double camera::CameraOptions::*member, double unit = 1) {
        return values ? section.number(key, (*values).*member * unit) / unit : section.number(key) / unit;
    };
    using camera::CameraOptions;
    CameraOptions& camera = configuration.camera.emplace();
    camera.bit_depth =
        static_cast<int>(values ? section.integer(bit_depth, values->bit_depth) : section.integer(bit_depth));
    if (values) { // another number of bits ends at the same charge
        const double range = std::exp2(camera.bit_depth - values->bit_depth);
        values->gain *= range;
        values->offset *= range;
    }
    camera.quantum_efficiency = read_efficiency(section, configuration.instrument.spectrum, values);
    camera.full_well = number(full_well, &CameraOptions::full_well);
    camera.read_noise = number(read_noise, &CameraOptions::read_noise);
    camera.dark_current = section.number(dark_current);
    camera.gain = number(gain, &CameraOptions::gain);
    camera.offset = number(offset, &CameraOptions::offset);
    camera.dark_signal = number(dark_signal, &CameraOptions::dark_signal);
    camera.photo_response = number(photo_response, &CameraOptions::photo_response, percent);
    camera.control = section.kind(exposure);
    if (camera.control == ExposureControl::time) {
        camera.exposure_time = section.number(exposure_time) / ms_per_s;
    } else {
        camera.saturation = section.number(saturation);
    }
    camera.frames = static_cast<int>(section.integer(frames));
    camera.seed = static_cast<std::uint32_t>(section.integer(seed));
    if (const auto given = section.integer_if_given(noise_seed)) {
        configuration.noise_seed = static_cast<std::uint32_t>(*given);
    }
    if (!(camera.offset < std::exp2(camera.bit_depth) - 1)) {
        section.fail(offset, fmt::format("a grey value below {}", std::exp2(camera.bit_depth) - 1),
                     "Choose a smaller offset, or more bits.");
    }
}

} // namespace vkfv
