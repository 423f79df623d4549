// Any bytes are a lens or an InputError, and every lens is written as a prescription that reads back and is
// written the same again.
#include "core/messages/error.hpp"
#include "optics/prescriptions/prescription_writer.hpp"
#include "optics/prescriptions/reversal.hpp"
#include "optics/prescriptions/zmx.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    static const auto glasses = optics::GlassCatalog::builtin();
    std::string text;
    try {
        const auto lens = optics::parse_zmx({reinterpret_cast<const char*>(data), size}, "fuzzed.zmx", glasses);
        text = optics::prescription_text(lens.prescription);
        (void)optics::turned_round(lens.prescription);
    } catch (const InputError&) {
        return 0;
    }
    if (optics::prescription_text(optics::parse_prescription(text, "written.toml", glasses)) != text) {
        std::abort();
    }
    return 0;
}
