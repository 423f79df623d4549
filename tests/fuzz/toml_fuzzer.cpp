// Any text is a prescription or an InputError, and every prescription is written so that it reads back and is written
// the same again; and so are configurations of an instrument and their canonical texts.
#include "configuration/configuration.hpp"
#include "core/messages/error.hpp"
#include "optics/prescriptions/prescription_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

using namespace vkfv;

void read_as_prescription(std::string_view given) {
    static const auto glasses = optics::GlassCatalog::builtin();
    std::string text;
    try {
        text = optics::prescription_text(optics::parse_prescription(given, "fuzzed.toml", glasses));
    } catch (const InputError&) {
        return;
    }
    if (optics::prescription_text(optics::parse_prescription(text, "fuzzed.toml", glasses)) != text) {
        std::abort();
    }
}

void read_as_configuration(std::string_view given) {
    const auto canonical = [](std::string_view text) {
        return read_configuration(TomlTable::parse(text, "fuzzed.toml"), Needs::instrument).canonical;
    };
    std::string text;
    try {
        text = canonical(given);
    } catch (const InputError&) {
        return;
    }
    if (canonical(text) != text) {
        std::abort();
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    read_as_prescription(text);
    read_as_configuration(text);
    return 0;
}
