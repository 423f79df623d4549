// Bytes that are no archive become one: main.xml up to the first NUL, the points after it, stored and with right
// checksums of ZIP, so that mutations get past the archive's own checks.
#include "surface_files/x3p.hpp"

#include "surface_fuzzing.hpp"

#include <zlib.h>

#include <algorithm>

namespace {

std::string number(std::uint32_t value, std::size_t bytes) {
    return {reinterpret_cast<const char*>(&value), bytes};
}

std::string archive_of(std::string_view bytes) {
    std::string records, directory;
    const auto add = [&](const std::string& name, std::string_view content) {
        const auto crc = static_cast<std::uint32_t>(
            crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
        const auto length = static_cast<std::uint32_t>(content.size());
        // The header of an entry: flags, method (stored), time, date; checksum and sizes; lengths of name and extra
        // field.
        const std::string common = number(0, 2) + number(0, 2) + number(0, 2) + number(33, 2) + number(crc, 4) +
                                   number(length, 4) + number(length, 4) +
                                   number(static_cast<std::uint32_t>(name.size()), 2) + number(0, 2);
        directory += "PK\x01\x02" + number(20, 2) + number(20, 2) + common + number(0, 2) + number(0, 2) +
                     number(0, 2) + number(0, 4) + number(static_cast<std::uint32_t>(records.size()), 4) + name;
        records += "PK\x03\x04" + number(20, 2) + common + name + std::string(content);
    };
    const auto end = std::min(bytes.find('\0'), bytes.size());
    add("main.xml", bytes.substr(0, end));
    add("bindata/data.bin", bytes.substr(std::min(end + 1, bytes.size())));
    return records + directory + "PK\x05\x06" + number(0, 4) + number(2, 2) + number(2, 2) +
           number(static_cast<std::uint32_t>(directory.size()), 4) +
           number(static_cast<std::uint32_t>(records.size()), 4) + number(0, 2);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (!surface::looks_like_x3p(bytes))
        bytes = archive_of(bytes);
    // A mutation hardly ever has the checksum that it states.
    const auto parse = [](std::string_view content, const std::filesystem::path& file) {
        return surface::parse_x3p(content, file, surface::Checksums::may_be_stale);
    };
    return fuzzing::read_write_read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), parse,
                                    surface::x3p_bytes);
}
