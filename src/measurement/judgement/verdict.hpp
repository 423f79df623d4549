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
// stack cannot be measured where a warning says that no heights are left, or where no texture stands out of the noise.
// It can partly be measured where a warning says that some heights are left out.
Verdict verdict_on(const Configuration& configuration, const optics::Instrument& instrument,
                   const std::optional<Expectation>& expected, const std::vector<Warning>& warnings);

// Text in lines of at most 110 columns. Lines after the first begin with this number of spaces.
std::string wrapped(std::string_view text, std::size_t indentation);

// Texts for a terminal: the answer with its sentences, and every warning with its key below it. file: the
// configuration's name.
std::string verdict_text(const std::string& file, const Verdict& verdict);
std::string warnings_text(const std::vector<Warning>& warnings);

} // namespace vkfv::measurement
