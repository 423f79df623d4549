// What several tables of the instrument have in common: prescriptions, glasses and placements.
#pragma once

#include "configuration/configuration.hpp"
#include "core/keys/section.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// Of a lens in the folder of assets that holds its sort ("objectives"): a name there, or a path. A prescription without
// surfaces stands for one that could not be read, which is noted.
optics::Prescription read_prescription(const Section& section, const TextKey& key, const Configuration& configuration,
                                       const std::string& folder, const std::optional<std::string>& fallback = {});

// By the name of a glass, or of air; air for a glass that is not known, which is noted.
optics::Medium read_glass(const Section& section, const TextKey& key, const Configuration& configuration);

// Where a part stands: these keys follow those of its own in its table.
std::vector<const Key*> with_placement(std::vector<const Key*> keys);
optics::Placement read_placement(const Section& section);

// The key of the glasses' catalogues, which others ask whether it is sound.
inline constexpr const char* glass_catalogs_key = "glass_catalogs";

} // namespace vkfv
