// The tables of the configuration, each with its keys and its reader in a file of its own. Readers throw InputError;
// while problems are collected, they note it.
#pragma once

#include "configuration/configuration.hpp"
#include "core/keys/section.hpp"

#include <string>
#include <vector>

namespace vkfv {

void read_glass_catalogs(const TomlTable& root, Configuration& configuration);

// The wavelengths of a source, and the key at which they are given.
struct LightOfSource {
    std::string key;
    optics::Spectrum spectrum;
};
std::vector<LightOfSource> read_source(const TomlTable& root, Configuration& configuration);
void read_illumination(const TomlTable& root, Configuration& configuration);
void read_beam_splitter(const TomlTable& root, Configuration& configuration);
void read_fold_mirrors(const TomlTable& root, Configuration& configuration);
void read_interfaces(const TomlTable& root, Configuration& configuration);
void read_objective(const TomlTable& root, Configuration& configuration);
void read_cover_glass(const TomlTable& root, Configuration& configuration);
void read_tube_lens(const TomlTable& root, Configuration& configuration);
void read_detector(const TomlTable& root, Configuration& configuration);
void read_mesh_elements(const TomlTable& root, Configuration& configuration);
void read_camera(const TomlTable& root, Configuration& configuration);
void read_specimen(const TomlTable& root, Configuration& configuration);
specimen::Reflectance read_reflectance(const TomlTable& table, ReadKeys& read);
LightFieldDescription read_light_field(const TomlTable& table, ReadKeys& read);
void read_scan(const TomlTable& root, Configuration& configuration);
void read_stage(const TomlTable& root, Configuration& configuration);
void read_trace(const TomlTable& root, Configuration& configuration);
void read_diffraction(const TomlTable& root, Configuration& configuration);
void read_topography(const TomlTable& root, Configuration& configuration, Needs needs);
void read_output(const TomlTable& root, Configuration& configuration);
void read_sweep(const TomlTable& root, Configuration& configuration);
void read_uncertainty(const TomlTable& root, Configuration& configuration);

const KeyTable& root_keys();
const KeyTable& source_keys();
const KeyTable& spectrum_keys();
const KeyTable& illumination_keys();
const KeyTable& beam_splitter_keys();
const KeyTable& fold_mirror_keys();
const KeyTable& interfaces_keys();
const KeyTable& objective_keys();
const KeyTable& cover_glass_keys();
const KeyTable& tube_lens_keys();
const KeyTable& detector_keys();
const KeyTable& mesh_element_keys();
const KeyTable& camera_keys();
const KeyTable& reflectance_keys();
const KeyTable& light_field_keys();
const KeyTable& scan_keys();
const KeyTable& stage_keys();
const KeyTable& trace_keys();
const KeyTable& diffraction_keys();
const KeyTable& topography_keys();
const KeyTable& output_keys();
const KeyTable& sweep_keys();
const KeyTable& sweep_parameter_keys();
const KeyTable& uncertainty_keys();
const KeyTable& uncertainty_correlation_keys();

// The tables of keys for [specimen] and for the tables in it.
std::vector<const KeyTable*> specimen_key_tables();

} // namespace vkfv
