#include "specimen/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace vkfv::specimen::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "buffers are little-endian, and so is the memory");

// The limit for accessors without a buffer, whose size nothing else bounds.
constexpr std::uint64_t most_elements_without_buffer = 1u << 24;
constexpr std::uint64_t least_stride = 4, largest_stride = 252; // limits of the glTF standard

std::uint64_t bytes_of(Component component) {
    switch (component) {
    case Component::signed_byte:
    case Component::unsigned_byte:
        return 1;
    case Component::signed_short:
    case Component::unsigned_short:
        return 2;
    default:
        return 4;
    }
}

std::uint64_t parts_of(const std::string& type) {
    return type == "VEC4" ? 4 : type == "VEC3" ? 3 : 1;
}

template <class Value>
double value_at(const char* place, bool normalised) {
    Value value;
    std::memcpy(&value, place, sizeof value);
    const double number = static_cast<double>(value);
    // The most negative integer stands for -1 too, so the quotient is limited.
    return normalised ? std::max(number / static_cast<double>(std::numeric_limits<Value>::max()), -1.0) : number;
}

} // namespace

double Elements::Packed::at(std::uint64_t element, std::uint64_t part) const {
    if (!first) {
        return 0;
    }
    const char* place = first + element * stride + part * bytes_of(component);
    switch (component) {
    case Component::signed_byte:
        return value_at<std::int8_t>(place, normalised);
    case Component::unsigned_byte:
        return value_at<std::uint8_t>(place, normalised);
    case Component::signed_short:
        return value_at<std::int16_t>(place, normalised);
    case Component::unsigned_short:
        return value_at<std::uint16_t>(place, normalised);
    case Component::unsigned_int:
        return value_at<std::uint32_t>(place, false);
    default:
        return value_at<float>(place, false);
    }
}

Elements::Packed Elements::packed(const Document& document, const Object& owner, std::uint64_t element_bytes,
                                  std::uint64_t count, bool interleaved) const {
    const Object view = document.item("bufferViews", "buffer view", owner.needed_integer("bufferView"));
    const Buffer& buffer = document.buffer(view.needed_integer("buffer"));
    const std::uint64_t view_offset = view.integer("byteOffset").value_or(0);
    const std::uint64_t view_length = view.needed_integer("byteLength");
    const std::uint64_t offset = owner.integer("byteOffset").value_or(0);
    const std::uint64_t stride = view.integer("byteStride").value_or(element_bytes);
    if (view.has("byteStride") && (stride < std::max(element_bytes, least_stride) || stride > largest_stride)) {
        view.fail("byteStride", fmt::format("{}", stride),
                  fmt::format("from {} to {} for elements of {} bytes", std::max(element_bytes, least_stride),
                              largest_stride, element_bytes));
    }
    if (!interleaved && stride != element_bytes) {
        view.fail("byteStride", fmt::format("{}", stride), "elements without gaps, as indices have to be");
    }
    const std::uint64_t length = buffer.bytes.size();
    // Every sum and product below is bounded by the check before it, so none can overflow.
    const bool fits = view_offset <= length && view_length <= length - view_offset && offset <= view_length &&
                      count > 0 && element_bytes <= view_length - offset &&
                      count - 1 <= (view_length - offset - element_bytes) / stride;
    if (!fits) {
        owner.fail("",
                   fmt::format("{} elements of {} bytes at {} of a view of {} bytes at {}", count, element_bytes,
                               offset, view_length, view_offset),
                   fmt::format("elements inside the {} bytes of the buffer", length));
    }
    Packed result;
    result.first = buffer.bytes.data() + view_offset + offset;
    result.stride = stride;
    result.file = buffer.file;
    if (buffer.offset) {
        result.offset = *buffer.offset + view_offset + offset;
    }
    return result;
}

Elements::Elements(const Document& document, std::uint64_t index, const Wanted& wanted) {
    const Object accessor = document.item("accessors", "accessor", index);
    name_ = accessor.name();
    count_ = accessor.needed_integer("count");
    const auto component = static_cast<Component>(accessor.needed_integer("componentType"));
    const std::string* type = accessor.string("type");
    const bool normalised = accessor.boolean("normalized");
    if (!type || *type != wanted.type || std::ranges::find(wanted.components, component) == wanted.components.end()) {
        accessor.fail(
            "", fmt::format("type {} of components {}", type ? *type : "none", static_cast<std::uint64_t>(component)),
            wanted.purpose);
    }
    if (wanted.normalised_only && component != Component::real && !normalised) {
        accessor.fail("normalized", "false", wanted.purpose);
    }
    if (count_ == 0) {
        accessor.fail("count", "0", "at least one element");
    }
    const std::uint64_t element_bytes = bytes_of(component) * parts_of(wanted.type);
    const auto sparse = accessor.object("sparse");
    if (accessor.has("bufferView")) {
        dense_ = packed(document, accessor, element_bytes, count_, wanted.interleaved);
    } else if (!sparse) {
        accessor.fail("bufferView", "nothing", wanted.purpose + " in a buffer",
                      "Export the file without compression of its meshes.");
    } else if (count_ > most_elements_without_buffer) {
        accessor.fail("count", fmt::format("{}", count_),
                      fmt::format("at most {} elements without a buffer view", most_elements_without_buffer));
    }
    dense_.component = component;
    dense_.normalised = normalised;
    if (!dense_.first) {
        dense_.file = document.file();
    }
    if (sparse) {
        read_sparse(document, *sparse, element_bytes);
    }
}

void Elements::read_sparse(const Document& document, const Object& sparse, std::uint64_t element_bytes) {
    const std::uint64_t count = sparse.needed_integer("count");
    if (count == 0 || count > count_) {
        sparse.fail("count", fmt::format("{}", count), fmt::format("from 1 to the accessor's {} elements", count_));
    }
    const Object indices = sparse.needed_object("indices");
    const auto component = static_cast<Component>(indices.needed_integer("componentType"));
    if (component != Component::unsigned_byte && component != Component::unsigned_short &&
        component != Component::unsigned_int) {
        indices.fail("componentType", fmt::format("{}", static_cast<std::uint64_t>(component)), "unsigned integers");
    }
    Packed places = packed(document, indices, bytes_of(component), count, false);
    places.component = component;
    replacements_ = packed(document, sparse.needed_object("values"), element_bytes, count, false);
    replacements_.component = dense_.component;
    replacements_.normalised = dense_.normalised;
    for (std::uint64_t k = 0; k < count; ++k) {
        const auto place = static_cast<std::uint64_t>(places.at(k, 0));
        if (place >= count_ || (k > 0 && place <= replaced_.back())) {
            indices.fail("", fmt::format("{} as number {}", place, k),
                         fmt::format("ascending numbers below {}", count_));
        }
        replaced_.push_back(place);
    }
}

double Elements::at(std::uint64_t element, std::uint64_t component) const {
    if (!replaced_.empty()) {
        const auto found = std::ranges::lower_bound(replaced_, element);
        if (found != replaced_.end() && *found == element) {
            return replacements_.at(static_cast<std::uint64_t>(found - replaced_.begin()), component);
        }
    }
    return dense_.at(element, component);
}

SourceLocation Elements::where(std::uint64_t element) const {
    SourceLocation place{.file = dense_.file};
    if (dense_.offset) {
        place.byte_offset = *dense_.offset + element * dense_.stride;
    }
    return place;
}

} // namespace vkfv::specimen::gltf
