// The numbers that an accessor of a glTF file stands for.
#pragma once

#include "specimen/gltf_document.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::specimen::gltf {

// Numbers of the standard.
enum class Component : std::uint64_t {
    signed_byte = 5120,
    unsigned_byte = 5121,
    signed_short = 5122,
    unsigned_short = 5123,
    unsigned_int = 5125,
    real = 5126
};

// What an accessor must be to serve a purpose.
struct Wanted {
    std::string purpose;               // "positions of three floats"
    std::string type;                  // "VEC3"
    std::vector<Component> components; // any of these
    bool normalised_only = false;      // integers must be fractions of the largest
    bool interleaved = true;           // whether a buffer view may state a stride, as for attributes of vertices
};

// Checked against the buffers that they lie in before the first is read.
class Elements {
  public:
    // Throws InputError.
    Elements(const Document& document, std::uint64_t accessor, const Wanted& wanted);

    std::uint64_t count() const { return count_; }
    const std::string& name() const { return name_; } // "accessor 7"
    Component component() const { return dense_.component; }

    // Normalised integers in [0, 1] or [-1, 1], others as they are.
    double at(std::uint64_t element, std::uint64_t component) const;
    // Where the element lies, for messages.
    SourceLocation where(std::uint64_t element) const;

  private:
    struct Packed {
        const char* first = nullptr; // null: all are zero
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
    std::vector<std::uint64_t> replaced_; // ascending: elements that stand in `replacements_`
    Packed replacements_;
};

} // namespace vkfv::specimen::gltf
