#include "surface_files/gwy.hpp"

#include "core/parsing/byte_reader.hpp"
#include "core/parsing/length_unit.hpp"
#include "surface_files/lengths.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace vkfv::surface {
namespace {

constexpr std::string_view gwy_magic = "GWYP";
constexpr const char* gwy_provenance_key = "vkfv provenance";

// A component of an object: the letter of its type, and its bytes.
struct Component {
    char type;
    std::string_view bytes;
};
using Components = std::map<std::string, Component, std::less<>>;

std::uint64_t size_of(char type) {
    switch (type) {
    case 'b':
    case 'c':
        return 1;
    case 'i':
        return 4;
    case 'q':
    case 'd':
        return 8;
    default:
        return 0;
    }
}

// Reads the parts of a file in sequence. Views refer to the file's bytes.
class Reader {
  public:
    Reader(const ByteReader& file, std::uint64_t begin, std::uint64_t end) : file_(file), at_(begin), end_(end) {}

    bool done() const { return at_ >= end_; }
    std::uint64_t at() const { return at_; }
    std::string_view take(std::uint64_t length, const char* what) {
        if (length > end_ - at_)
            file_.fail(at_, what, fmt::format("{} bytes", end_ - at_), fmt::format("{} bytes from here on", length));
        at_ += length;
        return file_.bytes(at_ - length, length, what);
    }
    std::string_view text(const char* what) {
        const auto rest = file_.bytes(at_, end_ - at_, what);
        const auto length = rest.find('\0');
        if (length == std::string_view::npos)
            file_.fail(at_, what, "no end", "a text with a NUL behind it");
        at_ += length + 1;
        return rest.substr(0, length);
    }
    std::uint32_t number(const char* what) { return element<std::uint32_t>(take(sizeof(std::uint32_t), what), 0); }
    // Reads an object: its name and contents.
    std::pair<std::string_view, std::string_view> object() {
        const auto name = text("name of an object");
        const auto size = number("size of an object");
        return {name, take(size, "object")};
    }

    Component component() {
        const char type = take(1, "type")[0];
        const std::uint64_t begin = at_;
        if (const auto size = size_of(type))
            return {type, take(size, "value")};
        const auto array = size_of(static_cast<char>(type - 'A' + 'a'));
        if (type >= 'A' && type <= 'Z' && array > 0) {
            const auto count = number("length of an array");
            return {type, take(count * array, "array")};
        }
        if (type == 's')
            return {type, text("text")};
        if (type == 'o')
            object();
        else if (type == 'S' || type == 'O')
            for (auto count = number("length of an array"); count > 0; --count)
                type == 'S' ? (void)text("text") : (void)object();
        else
            file_.fail(begin - 1, "type", plain_line(std::string_view(&type, 1)), "a letter of bciqdsoBCIQDSO");
        return {type, file_.bytes(begin, at_ - begin, "value")};
    }

  private:
    const ByteReader& file_;
    std::uint64_t at_, end_;
};

class Object {
  public:
    // Reads the components of an object from its contents, a part of the file's bytes.
    Object(const ByteReader& file, std::string_view contents) : file_(file) {
        const auto begin = static_cast<std::uint64_t>(contents.data() - file.bytes(0, 0, "").data());
        Reader reader(file, begin, begin + contents.size());
        while (!reader.done()) {
            const auto name = reader.text("name of a component");
            components_.insert_or_assign(std::string(name), reader.component());
        }
    }

    const Components& components() const { return components_; }
    template <class Value>
    Value number(const char* name, char type, std::optional<Value> fallback = {}) const {
        const auto component = components_.find(name);
        if (component == components_.end() && fallback)
            return *fallback;
        if (component == components_.end() || component->second.type != type)
            file_.fail({}, name, component == components_.end() ? "nothing" : "another type", "a number");
        return element<Value>(component->second.bytes, 0);
    }
    std::string text(const char* name) const {
        const auto component = components_.find(name);
        return component == components_.end() || component->second.type != 's' ? std::string()
                                                                               : std::string(component->second.bytes);
    }
    // The object of this name; none unless it is of this class.
    std::optional<Object> object(const std::string& name, std::string_view kind) const {
        const auto component = components_.find(name);
        if (component == components_.end() || component->second.type != 'o')
            return std::nullopt;
        const std::string_view bytes = component->second.bytes;
        const auto begin = static_cast<std::uint64_t>(bytes.data() - file_.bytes(0, 0, "").data());
        const auto [found, contents] = Reader(file_, begin, begin + bytes.size()).object();
        return found == kind ? std::optional(Object(file_, contents)) : std::nullopt;
    }
    // The unit in mm; none for another quantity. Gwyddion omits the object of a quantity without unit.
    std::optional<double> unit(const char* name) const {
        const auto unit = object(name, "GwySIUnit");
        return unit ? mm_per_length_unit(unit->text("unitstr")) : std::nullopt;
    }
    std::string_view doubles(const char* name, std::uint64_t count) const {
        const auto component = components_.find(name);
        const std::uint64_t bytes =
            component == components_.end() || component->second.type != 'D' ? 0 : component->second.bytes.size();
        if (bytes != count * sizeof(double))
            file_.fail({}, name, fmt::format("{} bytes", bytes), fmt::format("{} numbers of 8 bytes", count));
        return component->second.bytes;
    }

  private:
    const ByteReader& file_;
    Components components_;
};

HeightMap map_of(const ByteReader& file, const Object& field, const std::optional<Object>& mask, double unit_xy,
                 double unit_z) {
    const auto columns = static_cast<std::uint64_t>(std::max(field.number<std::int32_t>("xres", 'i'), 0)),
               rows = static_cast<std::uint64_t>(std::max(field.number<std::int32_t>("yres", 'i'), 0));
    file.check_size(columns, rows);
    const auto points = field.doubles("data", columns * rows);
    std::string_view masked;
    if (mask && mask->number<std::int32_t>("xres", 'i') == static_cast<std::int32_t>(columns))
        masked = mask->doubles("data", columns * rows);
    HeightMap map;
    const auto pitch = [&](const char* key, std::uint64_t count) {
        const double extent = field.number<double>(key, 'd');
        const double mm = unit_xy == mm_per_metre ? pitch_from_extent(extent, static_cast<int>(count))
                                                  : extent * unit_xy / static_cast<double>(count);
        file.check_spacing(mm, key);
        return mm;
    };
    map.pitch_x = pitch("xreal", columns);
    map.pitch_y = pitch("yreal", rows);
    map.x0 = mm_from(field.number<double>("xoff", 'd', 0.0), unit_xy);
    map.y0 = mm_from(field.number<double>("yoff", 'd', 0.0), unit_xy);
    if (!std::isfinite(map.x0) || !std::isfinite(map.y0))
        file.fail({}, "xoff, yoff", fmt::format("{}, {}", map.x0, map.y0), "finite lengths");
    map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows));
    std::size_t index = 0;
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column, ++index)
            map.height(column, row) = !masked.empty() && element<double>(masked, index) > 0
                                          ? std::numeric_limits<double>::quiet_NaN()
                                          : height_from(element<double>(points, index), unit_z);
    return map;
}

// The functions below write files.

void add_number(std::string& bytes, const char* name, std::int32_t value) {
    bytes += fmt::format("{}{}i", name, '\0');
    append(bytes, value);
}
void add_number(std::string& bytes, const char* name, double value) {
    bytes += fmt::format("{}{}d", name, '\0');
    append(bytes, value);
}
void add_text(std::string& bytes, std::string_view name, std::string_view text) {
    bytes += fmt::format("{}{}s{}{}", name, '\0', text, '\0');
}
std::string object_of(const char* kind, const std::string& contents) {
    if (contents.size() > std::numeric_limits<std::uint32_t>::max())
        throw RunError("the surface has too many points for GWY. Choose another format.");
    std::string bytes(kind);
    bytes += '\0';
    append(bytes, static_cast<std::uint32_t>(contents.size()));
    return bytes + contents;
}
void add_object(std::string& bytes, std::string_view name, const std::string& object) {
    bytes += fmt::format("{}{}o", name, '\0');
    bytes += object;
}
std::string unit_of(std::string_view unit) {
    std::string contents;
    add_text(contents, "unitstr", unit);
    return object_of("GwySIUnit", contents);
}

template <class Value>
std::string field_of(const HeightMap& map, std::string_view unit, Value value) {
    std::string contents;
    add_number(contents, "xres", std::int32_t{map.columns()});
    add_number(contents, "yres", std::int32_t{map.rows()});
    add_number(contents, "xreal", extent_from_pitch(map.pitch_x, map.columns()));
    add_number(contents, "yreal", extent_from_pitch(map.pitch_y, map.rows()));
    add_number(contents, "xoff", metres_from_mm(map.x0));
    add_number(contents, "yoff", metres_from_mm(map.y0));
    add_object(contents, "si_unit_xy", unit_of("m"));
    add_object(contents, "si_unit_z", unit_of(unit));
    contents += std::string("data\0D", 6);
    append(contents, static_cast<std::uint32_t>(map.height.values.size()));
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column)
            append(contents, double{value(map.height(column, row))});
    return object_of("GwyDataField", contents);
}

} // namespace

bool looks_like_gwy(std::string_view bytes) {
    return bytes.starts_with(gwy_magic);
}

SurfaceFile parse_gwy(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const auto [kind, contents] = Reader(file, gwy_magic.size(), file.size()).object();
    if (kind != "GwyContainer")
        file.fail(gwy_magic.size(), "object", plain_line(kind.substr(0, 40)), "GwyContainer");
    const Object container(file, contents);
    // The channels "/0/data", ..., keyed by number.
    std::map<int, std::string> channels;
    for (const auto& [name, component] : container.components())
        if (name.starts_with('/') && name.ends_with("/data"))
            if (const auto number = number_in<int>(std::string_view(name).substr(1, name.size() - 6)))
                channels.emplace(*number, name);
    std::optional<SurfaceFile> first;
    std::string title;
    int with_heights = 0;
    for (const auto& [number, name] : channels) {
        const auto field = container.object(name, "GwyDataField");
        const auto unit_xy = field ? field->unit("si_unit_xy") : std::nullopt;
        const auto unit_z = field ? field->unit("si_unit_z") : std::nullopt;
        if (!unit_xy || !unit_z || ++with_heights > 1)
            continue;
        title = plain_line(container.text((name + "/title").c_str()));
        const auto mask = container.object(fmt::format("/{}/mask", number), "GwyDataField");
        SurfaceFile result{.map = map_of(file, *field, mask, *unit_xy, *unit_z), .provenance = {}};
        if (const auto meta = container.object(fmt::format("/{}/meta", number), "GwyContainer"))
            result.provenance = parse_provenance(meta->text(gwy_provenance_key));
        first = std::move(result);
    }
    if (first && with_heights > 1)
        first->warnings.push_back(fmt::format("{}: the first of its {} channels of heights is read, \"{}\"",
                                              path.string(), with_heights, title));
    if (first)
        return *std::move(first);
    file.fail({}, "channels", fmt::format("{} without heights", channels.size()),
              "a channel whose values and axes are lengths", "Save a channel of heights.");
}

std::string gwy_bytes(const std::vector<GwyChannel>& channels, const Provenance& provenance) {
    std::string contents;
    int number = 0;
    for (const auto& [title, unit, map] : channels) {
        for (const double length : {map.pitch_x * map.columns(), map.pitch_y * map.rows()})
            if (!(std::isfinite(length) && metres_from_mm(length) > 0))
                throw RunError(fmt::format("{} mm cannot be written as GWY. Choose another format.", length));
        const bool lengths = unit == "m";
        bool gaps = false;
        const auto value = [&](double height) {
            gaps = gaps || !std::isfinite(height);
            return !std::isfinite(height) ? 0.0 : lengths ? metres_from_mm(height) : height;
        };
        add_object(contents, fmt::format("/{}/data", number), field_of(map, unit, value));
        add_text(contents, fmt::format("/{}/data/title", number), plain_line(title));
        if (gaps)
            add_object(contents, fmt::format("/{}/mask", number),
                       field_of(map, "", [](double height) { return std::isfinite(height) ? 0.0 : 1.0; }));
        if (const std::string text = provenance_text(provenance); !text.empty()) {
            std::string meta;
            add_text(meta, gwy_provenance_key, text);
            add_object(contents, fmt::format("/{}/meta", number), object_of("GwyContainer", meta));
        }
        contents += fmt::format("/{}/data/visible{}b{}", number, '\0', '\1');
        ++number;
    }
    return std::string(gwy_magic) + object_of("GwyContainer", contents);
}

std::string gwy_bytes(const HeightMap& map, const Provenance& provenance) {
    return gwy_bytes({{.title = "Height", .unit = "m", .map = map}}, provenance);
}

} // namespace vkfv::surface
