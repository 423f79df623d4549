// Readers that several tables of the instrument share: prescriptions, glasses and placements.
#pragma once

#include "configuration/configuration.hpp"
#include "core/keys/section.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// Reads a lens, by its name in the folder of assets for its kind ("objectives") or by a path. A lens that could not be
// read is noted as a problem, and its prescription has no surfaces.
optics::Prescription read_prescription(const Section& section, const TextKey& key, const Configuration& configuration,
                                       const std::string& folder, const std::optional<std::string>& fallback = {});

// Finds a glass, or air, by its name. An unknown glass is noted as a problem, and air stands for it.
optics::Medium read_glass(const Section& section, const TextKey& key, const Configuration& configuration);

// The placement of a part. Its keys follow the part's own keys in the part's table.
std::vector<const Key*> with_placement(std::vector<const Key*> keys);
optics::Placement read_placement(const Section& section);

// The key that names the files of glass catalogues. If they could not be read, an unknown glass is no error of its own.
inline constexpr const char* glass_catalogs_key = "glass_catalogs";

} // namespace vkfv
