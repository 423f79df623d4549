// Any text is a prescription or an InputError, and every prescription is written so that it reads back and is
// written the same again.
#include "core/error.hpp"
#include "optics/prescription_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    static const auto glasses = optics::GlassCatalog::builtin();
    std::string text;
    try {
        text = optics::prescription_text(
            optics::parse_prescription({reinterpret_cast<const char*>(data), size}, "fuzzed.toml", glasses));
    } catch (const InputError&) {
        return 0;
    }
    if (optics::prescription_text(optics::parse_prescription(text, "fuzzed.toml", glasses)) != text) {
        std::abort();
    }
    return 0;
}
