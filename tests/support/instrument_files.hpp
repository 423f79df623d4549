// Small files as instruments write them: 3 x 2 points, 1 2 3 um over 4 - 6 um, "-" not measured (5 um in NMS), with a
// pitch of 1 um.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace vkfv::test {

template <class Stored>
std::string raw_points(const std::vector<double>& values) {
    std::string bytes;
    for (const double value : values) {
        const auto stored = static_cast<Stored>(value);
        bytes.append(reinterpret_cast<const char*>(&stored), sizeof stored);
    }
    return bytes;
}

template <class Value>
void put(std::string& bytes, std::size_t offset, Value value, bool big_endian = false) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    if (big_endian)
        std::reverse(raw.begin(), raw.end());
    bytes.replace(offset, raw.size(), raw);
}

inline std::string plu_file() {
    std::string bytes(508, '\0');
    bytes.replace(0, 24, "Mon Apr 19 11:40:13 2021");
    put(bytes, 404, 1.0f);
    put(bytes, 408, 1.0f);
    put(bytes, 428, std::uint32_t{3});
    put(bytes, 489, std::uint8_t{1}); // layers
    put(bytes, 500, std::uint32_t{2});
    put(bytes, 504, std::uint32_t{3});
    return bytes + raw_points<float>({1, 2, 3, 4, 1000001, 6}) + std::string(8, '\0'); // an image's header
}

inline std::string opd_file() {
    std::string directory, contents;
    const auto add = [&](const char* name, std::uint16_t type, const std::string& content) {
        std::string entry(24, '\0');
        entry.replace(0, std::strlen(name), name);
        put(entry, 16, type);
        put(entry, 18, static_cast<std::uint32_t>(content.size()));
        directory += entry;
        contents += content;
    };
    add("Directory", 1, {});
    add("Mult", 6, raw_points<std::int16_t>({100}));
    // Heights are stored by columns, each from the lowest y, in waves of 500 nm.
    add("RAW_DATA", 3,
        raw_points<std::uint16_t>({3, 2, 2}) + raw_points<std::int16_t>({800, 200, 32767, 400, 1200, 600}));
    add("Pixel_size", 7, raw_points<float>({1e-3}));
    add("Wavelength", 7, raw_points<float>({500}));
    add("Date", 5, "10/26/2009");
    add("Time", 5, "11:16:55");
    put(directory, 18, static_cast<std::uint32_t>(directory.size()));
    put(directory, 22, std::uint16_t{0xffff});
    return std::string("\1\0", 2) + directory + contents;
}

inline std::string metropro_file() {
    std::string bytes(834, '\0');
    bytes.replace(0, 4, "\x88\x1b\x03\x6f");
    const auto big = [&](std::size_t offset, auto value) { put(bytes, offset, value, true); };
    big(4, std::int16_t{1});
    big(6, std::uint32_t{834});
    big(68, std::uint16_t{3});
    big(70, std::uint16_t{2});
    big(72, std::uint32_t{24});
    big(76, std::int32_t{1311439776});
    big(164, 0.5f);
    big(168, 4.096e-7f);
    big(176, 1.0f);
    big(184, 1e-6f);
    // Heights are stored in steps of 0.05 nm.
    for (const int step : {20000, 40000, 60000, 80000, 2147483640, 120000}) {
        bytes.resize(bytes.size() + 4);
        put(bytes, bytes.size() - 4, std::int32_t{step}, true);
    }
    return bytes;
}

// MetroPro's header as text, up to its "#", for two rows of three phases, whose origin is (10, 20).
inline std::string zygo_header(const std::string& title, const std::string& pitch = "1e-06") {
    return title +
           "\n0 9 1 0 \"Sat Jul 23 2011\"\n0 0 0 0 0 0\n10 20 3 2\n\"a part\"\n\"17\"\n\"\"\n0 0.5 4.096e-07 0 1 0 " +
           pitch + " 1311439776\n3 2 0 0 0 0 \"\"\n0 0 0 0 0 0 0 0 0 0\n0 1 20 2 0 0 0 0 0\n0 \"\"\n1 0\n\"\"\n#\n";
}
// A file of phases in steps of 0.05 nm, in lines that do not end with the rows.
inline std::string zygo_phases() {
    return zygo_header("Zygo ASCII Data File - Format 2") + "#\n20000 40000 60000 80000 \n2147483640 120000\n#\n";
}
inline std::string zygo_points() {
    return zygo_header("Zygo XYZ Data File - Format 1") +
           "10 20 1.0\n11 20 2.0\n12\t20\t3.0\n10 21 4.0\n11 21 No Data\n12 21 6.0\n#\n";
}

inline std::string nms_file() {
    std::string bytes(1400, '\0');
    put(bytes, 12, std::uint32_t{65535});
    put(bytes, 16, 0.0);
    put(bytes, 24, 6.5535);
    bytes.replace(32, 9, "OM_MS_2.0");
    bytes.replace(1076, 16, "2022-02-09T13:25");
    put(bytes, 1352, std::uint32_t{1400});
    put(bytes, 1356, std::uint32_t{2});
    put(bytes, 1368, std::uint32_t{3});
    put(bytes, 1372, std::uint32_t{2});
    put(bytes, 1376, 1000.0);
    put(bytes, 1384, 1000.0);
    return bytes + raw_points<std::uint16_t>({10000, 20000, 30000, 40000, 50000, 60000});
}

// The file of a format, by the ending of its names.
inline std::string instrument_file(const std::string& ending) {
    return ending == "plu" ? plu_file() : ending == "opd" ? opd_file() : ending == "dat" ? metropro_file() : nms_file();
}

} // namespace vkfv::test
