// The judgement on a configuration, in plain sentences: whether it can be measured, how well, and what limits it.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/judgement/expectation.hpp"
#include "measurement/scene/verdict.hpp"
#include "optics/instrument/instrument.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::measurement {

// The verdict on a stack. Without [scan] or [specimen] there is no expectation, and the verdict says what is missing. A
// stack cannot be measured where a warning says so that leaves no heights, or where no texture stands out of the noise;
// partly where such a warning takes some of the points.
Verdict verdict_on(const Configuration& configuration, const optics::Instrument& instrument,
                   const std::optional<Expectation>& expected, const std::vector<Warning>& warnings);

// At most 110 columns wide; lines after the first begin with so many spaces.
std::string wrapped(std::string_view text, std::size_t indentation);

// The text for a terminal: the answer, its sentences, and every warning with its key below it. file: name of the
// configuration.
std::string verdict_text(const std::string& file, const Verdict& verdict);
std::string warnings_text(const std::vector<Warning>& warnings);

} // namespace vkfv::measurement
