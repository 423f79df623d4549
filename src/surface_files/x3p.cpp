#include "surface_files/x3p.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface/metres.hpp"

#include <openssl/evp.h>
#include <pugixml.hpp>
#include <spdlog/spdlog.h>
#include <zip.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>

namespace vkfv::surface {
namespace {

constexpr const char* xml_name = "main.xml";
constexpr const char* points_name = "bindata/data.bin";
constexpr const char* valid_name = "bindata/valid.bin";
constexpr const char* checksum_name = "md5checksum.hex";
constexpr std::uint64_t largest_xml = std::uint64_t{1} << 24;
constexpr std::uint64_t largest_checksum_file = 4096;
constexpr std::size_t md5_digits = 32;

// The MD5 sum as 32 lower-case digits.
std::string md5_of(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_md5(), nullptr) != 1)
        throw RunError("OpenSSL offers no MD5, which X3P files need. Use a configuration of OpenSSL that has it.");
    std::string text;
    for (unsigned int k = 0; k < length; ++k)
        text += fmt::format("{:02x}", digest[k]);
    return text;
}

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

// Opens an archive under a lock: libzip (1.7.3, Debian 12) determines at its first opening which capabilities a source
// needs, and stores them in two variables one after the other. A second thread that opens between the two gets a
// read-only archive.
zip_t* open_archive(zip_source_t* source, int flags, zip_error_t* error) {
    static std::mutex opening;
    const std::lock_guard lock(opening);
    return zip_open_from_source(source, flags, error);
}

class Archive {
  public:
    explicit Archive(const ByteReader& file) : file_(file) {
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* source = zip_source_buffer_create(file.bytes(0, file.size(), "").data(), file.size(), 0, &error);
        if (source)
            archive_.reset(open_archive(source, ZIP_RDONLY, &error));
        const std::string reason = zip_error_strerror(&error);
        zip_error_fini(&error);
        if (!archive_) {
            zip_source_free(source);
            file.fail({}, "", reason, "a whole ZIP archive");
        }
        find_folder();
    }

    bool has(const char* name) const { return zip_name_locate(archive_.get(), (folder_ + name).c_str(), 0) >= 0; }

    // The entry of this name in the folder of main.xml; none if there is no such entry. Memory grows with the data up
    // to the limit; an entry whose stated size exceeds the limit is refused at once.
    std::optional<std::string> read(std::string name, std::uint64_t largest) const {
        if (name.starts_with("./"))
            name.erase(0, 2);
        name.insert(0, folder_);
        const zip_int64_t index = zip_name_locate(archive_.get(), name.c_str(), 0);
        if (index < 0)
            return std::nullopt;
        const auto entry = static_cast<zip_uint64_t>(index);
        zip_stat_t stat;
        if (zip_stat_index(archive_.get(), entry, 0, &stat) != 0 || !(stat.valid & ZIP_STAT_COMP_METHOD) ||
            (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE))
            file_.fail({}, name, "packed by another method", "an entry stored or deflated");
        const auto too_long = [&](std::uint64_t bytes) {
            if (bytes > largest)
                file_.fail({}, name, fmt::format("more than {} bytes", largest), "an entry no longer than that");
        };
        std::string bytes;
        if (stat.valid & ZIP_STAT_SIZE) {
            too_long(stat.size);
            bytes.reserve(stat.size);
        }
        const std::unique_ptr<zip_file_t, Discard> stream(zip_fopen_index(archive_.get(), entry, 0));
        if (!stream)
            file_.fail({}, name, zip_strerror(archive_.get()), "an entry that can be read");
        std::array<char, 1 << 16> part;
        for (zip_int64_t count; (count = zip_fread(stream.get(), part.data(), part.size())) != 0;) {
            if (count < 0)
                file_.fail({}, name, zip_file_strerror(stream.get()), "an entry without damage");
            bytes.append(part.data(), static_cast<std::size_t>(count));
            too_long(bytes.size());
        }
        return bytes;
    }

  private:
    // Some writers (x3ptools) pack the folder itself instead of its contents.
    void find_folder() {
        if (has(xml_name))
            return;
        for (zip_int64_t k = 0, count = zip_get_num_entries(archive_.get(), 0); k < count; ++k) {
            const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(k), 0);
            const std::string_view entry = name ? name : "";
            if (entry.ends_with(std::string("/") + xml_name)) {
                folder_ = entry.substr(0, entry.size() - std::string_view(xml_name).size());
                return;
            }
        }
    }

    const ByteReader& file_;
    std::unique_ptr<zip_t, Discard> archive_;
    std::string folder_{}; // path of main.xml's folder, ends with a slash; empty: the root
};

// The child element of this name, with any namespace prefix, which is the writer's choice.
pugi::xml_node child(const pugi::xml_node& parent, std::string_view name) {
    for (const pugi::xml_node node : parent.children()) {
        const std::string_view full = node.name();
        if (full.substr(full.find(':') + 1) == name)
            return node;
    }
    return {};
}

std::string text_of(const pugi::xml_node& parent, std::string_view name) {
    return plain_line(child(parent, name).text().get());
}

class Document {
  public:
    Document(const ByteReader& file, const std::string& xml) : file_(file) {
        const auto result = document_.load_buffer(xml.data(), xml.size());
        if (!result)
            file.fail({}, xml_name, fmt::format("{} at byte {}", result.description(), result.offset), "XML");
        // Programs name the root differently, or without a prefix, so it is recognized by its records.
        root_ = document_.document_element();
        if (!child(root_, "Record1") || !child(root_, "Record3"))
            file.fail({}, xml_name, "another root element", "the element ISO5436_2, with its records");
    }

    pugi::xml_node root() const { return root_; }

    template <class Value>
    Value number(const pugi::xml_node& parent, const char* name, std::optional<Value> fallback = {}) const {
        const std::string text = text_of(parent, name);
        if (text.empty() && fallback)
            return *fallback;
        const auto value = number_in<Value>(text);
        if (!value)
            file_.fail({}, fmt::format("{}: {}.{}", xml_name, parent.name(), name), text.empty() ? "nothing" : text,
                       "a number");
        return *value;
    }

    void require(const pugi::xml_node& parent, const char* name, const std::string& expected) const {
        if (const std::string text = text_of(parent, name); text != expected)
            file_.fail({}, fmt::format("{}: {}.{}", xml_name, parent.name(), name), text.empty() ? "nothing" : text,
                       expected, "Export the file as a surface on a regular grid.");
    }

  private:
    const ByteReader& file_;
    pugi::xml_document document_;
    pugi::xml_node root_;
};

// The context in which the parts of a file are read.
struct Reading {
    const ByteReader& file;
    Checksums checksums;
    std::vector<std::string>& warnings;
};

void check_md5(const Reading& reading, const std::string& what, const std::string& bytes, const std::string& stated) {
    const ByteReader& file = reading.file;
    if (stated.empty()) {
        spdlog::warn("{}: {} has no MD5 checksum", file.file().string(), what);
        return;
    }
    std::string digits = stated;
    std::ranges::transform(digits, digits.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::string md5 = md5_of(bytes);
    if (md5 == digits)
        return;
    if (reading.checksums == Checksums::must_hold)
        file.fail(
            {}, fmt::format("MD5 of {}", what), md5, fmt::format("the checksum {} that the file states", digits),
            "The file is damaged, or was changed by hand: export or copy it anew. --accept-checksum reads it as it "
            "is.");
    reading.warnings.push_back(fmt::format("{}: {} does not have the MD5 checksum that the file states: it was changed "
                                           "or damaged after that",
                                           file.file().string(), what));
}

template <class Stored>
void read_x3p_heights(std::string_view points, std::string_view valid, double offset, double increment,
                      Grid<double>& heights) {
    std::size_t index = 0;
    for (int row = heights.rows - 1; row >= 0; --row)
        for (int column = 0; column < heights.columns; ++column, ++index) {
            const bool measured =
                valid.empty() || (static_cast<unsigned char>(valid[index / 8]) >> (index % 8) & 1) != 0;
            const double metres = offset + increment * static_cast<double>(element<Stored>(points, index));
            heights(column, row) = measured ? height_from_metres(metres) : std::numeric_limits<double>::quiet_NaN();
        }
}

// The text of required elements whose value is not known; pyx3p fails at empty ones.
constexpr const char* unknown = "unknown";

std::string known_text(const pugi::xml_node& parent, const char* name) {
    const std::string text = text_of(parent, name);
    return text == unknown ? std::string() : text;
}

Provenance read_provenance(const pugi::xml_node& record) {
    const auto instrument = child(record, "Instrument");
    return {.creator = text_of(record, "Creator"),
            .manufacturer = known_text(instrument, "Manufacturer"),
            .model = known_text(instrument, "Model"),
            .serial = known_text(instrument, "Serial"),
            .version = known_text(instrument, "Version"),
            .date = known_date(text_of(record, "Date")),
            .comment = plain_lines(child(record, "Comment").text().get())};
}

std::string main_xml(const HeightMap& map, const Provenance& provenance, const std::string& points_md5,
                     const std::string& valid_md5) {
    pugi::xml_document document;
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    auto root = document.append_child("p:ISO5436_2");
    root.append_attribute("xmlns:p") = "http://www.opengps.eu/2008/ISO5436_2";
    root.append_attribute("xmlns:xsi") = "http://www.w3.org/2001/XMLSchema-instance";
    root.append_attribute("xsi:schemaLocation") =
        "http://www.opengps.eu/2008/ISO5436_2 http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd";
    const auto add = [](pugi::xml_node parent, const char* name, const std::string& text) {
        parent.append_child(name).append_child(pugi::node_pcdata).set_value(text.c_str());
    };
    auto record1 = root.append_child("Record1");
    add(record1, "Revision", "ISO5436 - 2000");
    add(record1, "FeatureType", "SUR");
    auto axes = record1.append_child("Axes");
    const auto add_axis = [&](const char* name, const char* type, double increment, double offset) {
        auto axis = axes.append_child(name);
        add(axis, "AxisType", type);
        add(axis, "DataType", "D");
        add(axis, "Increment", fmt::format("{}", increment));
        add(axis, "Offset", fmt::format("{}", offset));
    };
    add_axis("CX", "I", metres_from_mm(map.pitch_x), metres_from_mm(map.x0));
    add_axis("CY", "I", metres_from_mm(map.pitch_y), metres_from_mm(map.y0));
    add_axis("CZ", "A", 1, 0);

    auto record2 = root.append_child("Record2");
    const std::string date = date_time(provenance.date).text();
    add(record2, "Date", date);
    if (const std::string creator = plain_line(provenance.creator); !creator.empty())
        add(record2, "Creator", creator);
    auto instrument = record2.append_child("Instrument");
    const auto add_known = [&](pugi::xml_node parent, const char* name, const std::string& text) {
        const std::string line = plain_line(text);
        add(parent, name, line.empty() ? unknown : line);
    };
    add_known(instrument, "Manufacturer", provenance.manufacturer);
    add_known(instrument, "Model", provenance.model);
    add_known(instrument, "Serial", provenance.serial);
    add_known(instrument, "Version", provenance.version);
    add(record2, "CalibrationDate", date);
    auto probing = record2.append_child("ProbingSystem");
    add(probing, "Type", "Software");
    add_known(probing, "Identification", provenance.model);
    if (const std::string comment = plain_lines(provenance.comment); !comment.empty())
        add(record2, "Comment", comment);

    auto record3 = root.append_child("Record3");
    auto matrix = record3.append_child("MatrixDimension");
    add(matrix, "SizeX", fmt::format("{}", map.columns()));
    add(matrix, "SizeY", fmt::format("{}", map.rows()));
    add(matrix, "SizeZ", "1");
    auto link = record3.append_child("DataLink");
    add(link, "PointDataLink", points_name);
    add(link, "MD5ChecksumPointData", points_md5);
    if (!valid_md5.empty()) {
        add(link, "ValidPointsLink", valid_name);
        add(link, "MD5ChecksumValidPoints", valid_md5);
    }
    add(root.append_child("Record4"), "ChecksumFile", checksum_name);
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

// True if packing makes an entry at least a tenth smaller, judged by 8 parts of it. Digits of heights hardly shrink, so
// packing them wastes time; points that were not measured do.
bool shrinks(std::string_view content) {
    constexpr std::size_t part = 1 << 13, parts = 8;
    if (content.size() < 2 * part * parts) {
        return true;
    }
    std::string sample;
    for (std::size_t k = 0; k < parts; ++k) {
        sample += content.substr((content.size() - part) / (parts - 1) * k, part);
    }
    uLongf packed = compressBound(static_cast<uLong>(sample.size()));
    std::vector<Bytef> there(packed);
    constexpr double worth = 0.9;
    return compress2(there.data(), &packed, reinterpret_cast<const Bytef*>(sample.data()),
                     static_cast<uLong>(sample.size()), Z_BEST_SPEED) != Z_OK ||
           static_cast<double>(packed) < worth * static_cast<double>(sample.size());
}

// The archive's bytes, which are equal for equal entries.
std::string zip_of(const std::vector<std::pair<const char*, std::string_view>>& entries) {
    constexpr zip_uint32_t quick = 1;
    constexpr std::uint16_t first_day = 1 << 5 | 1; // 1980-01-01 in MS-DOS' notation
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(nullptr, 0, 0, &error);
    zip_t* archive = source ? open_archive(source, ZIP_TRUNCATE, &error) : nullptr;
    zip_error_fini(&error);
    std::string bytes;
    bool good = archive != nullptr;
    if (good) {
        zip_source_keep(source);
        for (const auto& [name, content] : entries) {
            zip_source_t* data = zip_source_buffer(archive, content.data(), content.size(), 0);
            const zip_int64_t index = data ? zip_file_add(archive, name, data, ZIP_FL_ENC_UTF_8) : -1;
            good = good && index >= 0 &&
                   zip_set_file_compression(archive, static_cast<zip_uint64_t>(index),
                                            shrinks(content) ? ZIP_CM_DEFLATE : ZIP_CM_STORE, quick) == 0 &&
                   zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, first_day, 0) == 0;
        }
        good = good && zip_close(archive) == 0;
        zip_stat_t stat;
        good = good && zip_source_open(source) == 0 && zip_source_stat(source, &stat) == 0;
        if (good) {
            bytes.resize(stat.size);
            good = zip_source_read(source, bytes.data(), bytes.size()) == static_cast<zip_int64_t>(bytes.size());
            zip_source_close(source);
        }
    }
    zip_source_free(source);
    if (!good)
        throw RunError("an X3P archive could not be packed in memory. Free memory and run the same command again.");
    return bytes;
}

// One bit per point, set if the point was measured; empty if all were. Some writers (pyx3p) store one byte per point.
std::string valid_points(const Reading& reading, const Archive& archive, const pugi::xml_node& link,
                         std::uint64_t count) {
    const std::string name = text_of(link, "ValidPointsLink");
    if (name.empty())
        return {};
    const std::uint64_t bytes = (count + 7) / 8;
    auto content = archive.read(name, count);
    if (!content || (content->size() != bytes && content->size() != count))
        reading.file.fail({}, name, content ? fmt::format("{} bytes", content->size()) : "no such entry",
                          fmt::format("{} bytes, a bit a point", bytes));
    check_md5(reading, name, *content, text_of(link, "MD5ChecksumValidPoints"));
    if (content->size() != bytes) {
        reading.warnings.push_back(fmt::format("{}: {} has a byte for each point, where ISO 25178-72 has a bit",
                                               reading.file.file().string(), name));
        std::string bits(bytes, '\0');
        for (std::size_t k = 0; k < count; ++k)
            if ((*content)[k] != '\0')
                bits[k / 8] = static_cast<char>(bits[k / 8] | 1 << (k % 8));
        content = std::move(bits);
    }
    return *content;
}

// Refuses rotated points, which are no heights over a grid; some writers state the identity.
void check_rotation(const ByteReader& file, const Document& document, const pugi::xml_node& axes) {
    const auto rotation = child(axes, "Rotation");
    if (!rotation)
        return;
    constexpr double rounding = 1e-9;
    for (int row = 1; row <= 3; ++row)
        for (int column = 1; column <= 3; ++column) {
            const std::string name = fmt::format("r{}{}", row, column);
            const double expected = row == column ? 1 : 0;
            if (!(std::abs(document.number<double>(rotation, name.c_str()) - expected) <= rounding))
                file.fail({}, fmt::format("{}: Rotation", xml_name), "a rotation of the points",
                          "none, or the identity", "Export the surface in the frame of its grid.");
        }
}

struct Scale {
    std::string type; // type of the points: I, L, F or D
    double offset, increment;
};

Grid<double> linked_heights(const Reading& reading, const Archive& archive, const pugi::xml_node& link,
                            const Scale& scale, std::uint64_t columns, std::uint64_t rows) {
    const ByteReader& file = reading.file;
    const std::string name = text_of(link, "PointDataLink");
    if (name.empty())
        file.fail({}, fmt::format("{}: Record3.DataLink", xml_name), "nothing",
                  "a DataList, or the name of a binary file of points");
    const std::uint64_t count = columns * rows;
    const std::uint64_t point_bytes = scale.type == "I" ? 2 : scale.type == "D" ? 8 : 4;
    file.check_packing(count * sizeof(double), name);
    const auto points = archive.read(name, count * point_bytes);
    if (!points || points->size() != count * point_bytes)
        file.fail(
            {}, name, points ? fmt::format("{} bytes", points->size()) : "no such entry",
            fmt::format("{} bytes for {} x {} points of type {}", count * point_bytes, columns, rows, scale.type));
    check_md5(reading, name, *points, text_of(link, "MD5ChecksumPointData"));
    const std::string valid = valid_points(reading, archive, link, count);
    Grid<double> heights(static_cast<int>(columns), static_cast<int>(rows));
    (scale.type == "I"   ? read_x3p_heights<std::int16_t>
     : scale.type == "L" ? read_x3p_heights<std::int32_t>
     : scale.type == "F" ? read_x3p_heights<float>
                         : read_x3p_heights<double>)(*points, valid, scale.offset, scale.increment, heights);
    return heights;
}

// The heights in a list of a Datum per point: its coordinates between semicolons, z the last of them; on a grid x and y
// may be omitted. An empty Datum is not measured (ISO 5436-2, the schema's notes on DataListType).
Grid<double> listed_heights(const ByteReader& file, const pugi::xml_node& list, const Scale& scale,
                            std::uint64_t columns, std::uint64_t rows) {
    std::uint64_t count = 0;
    for (auto datum = list.first_child(); datum; datum = datum.next_sibling())
        count += datum.type() == pugi::node_element ? 1 : 0;
    if (count != columns * rows)
        file.fail({}, fmt::format("{}: Record3.DataList", xml_name), fmt::format("{} points", count),
                  fmt::format("{} x {}", columns, rows));
    Grid<double> heights(static_cast<int>(columns), static_cast<int>(rows));
    auto datum = list.first_child();
    for (int row = heights.rows - 1; row >= 0; --row)
        for (int column = 0; column < heights.columns; ++column, datum = datum.next_sibling()) {
            while (datum.type() != pugi::node_element)
                datum = datum.next_sibling();
            const std::string text = plain_line(datum.text().get());
            const std::string z = text.substr(text.rfind(';') + 1);
            const auto value = number_in<double>(z);
            if (!value && !z.empty() && z != "NaN")
                file.fail({}, fmt::format("{}: Record3.DataList", xml_name), text, "coordinates between semicolons");
            heights(column, row) = value ? height_from_metres(scale.offset + scale.increment * *value)
                                         : std::numeric_limits<double>::quiet_NaN();
        }
    return heights;
}

} // namespace

bool looks_like_x3p(std::string_view bytes) {
    return bytes.starts_with("PK\x03\x04");
}

SurfaceFile parse_x3p(std::string_view bytes, const std::filesystem::path& path, Checksums checksums) {
    const ByteReader file(bytes, path);
    SurfaceFile result;
    const Reading reading{file, checksums, result.warnings};
    const Archive archive(file);
    if (!archive.has(xml_name))
        refuse_file(path, "", fmt::format("a ZIP archive of another kind, without {}", xml_name),
                    "a surface file of a format that is read here", "Export the surface as X3P.");
    const auto xml = archive.read(xml_name, largest_xml);
    const Document document(file, *xml);

    const auto record1 = child(document.root(), "Record1");
    document.require(record1, "FeatureType", "SUR");
    const auto axes = child(record1, "Axes");
    check_rotation(file, document, axes);
    const auto x = child(axes, "CX"), y = child(axes, "CY"), z = child(axes, "CZ");
    document.require(x, "AxisType", "I");
    document.require(y, "AxisType", "I");
    const auto pitch = [&](const pugi::xml_node& axis) {
        const double mm = mm_from_metres(document.number<double>(axis, "Increment"));
        file.check_spacing(mm, axis.name());
        return mm;
    };
    const auto position = [&](const pugi::xml_node& axis) {
        const double mm = mm_from_metres(document.number<double>(axis, "Offset", 0.0));
        if (!std::isfinite(mm))
            file.fail({}, fmt::format("{}: {}.Offset", xml_name, axis.name()), fmt::format("{} mm", mm), "a length");
        return mm;
    };
    result.map.pitch_x = pitch(x);
    result.map.pitch_y = pitch(y);
    result.map.x0 = position(x);
    result.map.y0 = position(y);
    const Scale scale = {.type = text_of(z, "DataType"),
                         .offset = document.number<double>(z, "Offset", 0.0),
                         .increment = document.number<double>(z, "Increment", 1.0)};
    const std::string& type = scale.type;
    if (type != "I" && type != "L" && type != "F" && type != "D")
        file.fail({}, fmt::format("{}: CZ.DataType", xml_name), type.empty() ? "nothing" : type, "I, L, F or D");
    if (scale.increment == 0)
        file.fail({}, fmt::format("{}: CZ.Increment", xml_name), "0", "another number");

    const auto record3 = child(document.root(), "Record3");
    const auto matrix = child(record3, "MatrixDimension");
    const auto columns = document.number<std::uint64_t>(matrix, "SizeX");
    const auto rows = document.number<std::uint64_t>(matrix, "SizeY");
    file.check_size(columns, rows);
    document.require(matrix, "SizeZ", "1");
    const auto checksum = archive.read(checksum_name, largest_checksum_file);
    check_md5(reading, xml_name, *xml, checksum ? checksum->substr(0, md5_digits) : "");
    const auto list = child(record3, "DataList");
    result.map.height = list ? listed_heights(file, list, scale, columns, rows)
                             : linked_heights(reading, archive, child(record3, "DataLink"), scale, columns, rows);
    result.provenance = read_provenance(child(document.root(), "Record2"));
    return result;
}

std::string x3p_bytes(const HeightMap& map, const Provenance& provenance) {
    const std::size_t count = map.height.values.size();
    std::string points, valid((count + 7) / 8, '\0');
    points.reserve(count * sizeof(double));
    bool all_measured = true;
    std::size_t index = 0;
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column, ++index) {
            const double mm = map.height(column, row);
            const bool measured = std::isfinite(mm);
            append(points, measured ? metres_from_mm(mm) : std::numeric_limits<double>::quiet_NaN());
            all_measured = all_measured && measured;
            if (measured)
                valid[index / 8] = static_cast<char>(valid[index / 8] | 1 << (index % 8));
        }
    const std::string xml = main_xml(map, provenance, md5_of(points), all_measured ? "" : md5_of(valid));
    const std::string checksum = fmt::format("{} *{}\n", md5_of(xml), xml_name);
    std::vector<std::pair<const char*, std::string_view>> entries = {
        {xml_name, xml}, {checksum_name, checksum}, {points_name, points}};
    if (!all_measured)
        entries.emplace_back(valid_name, valid);
    return zip_of(entries);
}

} // namespace vkfv::surface
