// The numbers of an accessor of a glTF file.
#pragma once

#include "specimen/gltf_document.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::specimen::gltf {

// Component types with the glTF standard's values.
enum class Component : std::uint64_t {
    signed_byte = 5120,
    unsigned_byte = 5121,
    signed_short = 5122,
    unsigned_short = 5123,
    unsigned_int = 5125,
    real = 5126
};

// The requirements on an accessor for one purpose.
struct Wanted {
    std::string purpose;               // text for messages: "positions of three floats"
    std::string type;                  // type in the file: "VEC3"
    std::vector<Component> components; // accepted component types
    bool normalised_only = false;      // true: integers must be normalised
    bool interleaved = true;           // true: the buffer view may state a stride, as for vertex attributes
};

// The elements of an accessor. The constructor checks that they lie within their buffers.
class Elements {
  public:
    // Throws InputError for an accessor that is invalid or not as wanted.
    Elements(const Document& document, std::uint64_t accessor, const Wanted& wanted);

    std::uint64_t count() const { return count_; }
    const std::string& name() const { return name_; } // for example "accessor 7"
    Component component() const { return dense_.component; }

    // The value of a component; normalised integers become [0, 1] or [-1, 1], others are unchanged.
    double at(std::uint64_t element, std::uint64_t component) const;
    // The place of an element in its file, for messages.
    SourceLocation where(std::uint64_t element) const;

  private:
    struct Packed {
        const char* first = nullptr; // null: all elements are zero
        std::uint64_t stride = 0;
        Component component = Component::real;
        bool normalised = false;
        std::filesystem::path file{};
        std::optional<std::uint64_t> offset{};

        double at(std::uint64_t element, std::uint64_t part) const;
    };
    Packed packed(const Document& document, const Object& owner, std::uint64_t element_bytes, std::uint64_t count,
                  bool interleaved) const;
    void read_sparse(const Document& document, const Object& sparse, std::uint64_t element_bytes);

    std::string name_;
    std::uint64_t count_ = 0;
    Packed dense_;
    std::vector<std::uint64_t> replaced_; // ascending indices of the elements in `replacements_`
    Packed replacements_;
};

} // namespace vkfv::specimen::gltf
