// Any bytes are a catalogue or an InputError; every glass of it has an index, or an InputError.
#include "core/messages/error.hpp"
#include "optics/media/agf.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    try {
        for (const auto& glass : optics::parse_agf({reinterpret_cast<const char*>(data), size}, "fuzzed.agf").media) {
            try {
                (void)glass.index(0.5875618);
            } catch (const InputError&) {
            }
        }
    } catch (const InputError&) {
    }
    return 0;
}
