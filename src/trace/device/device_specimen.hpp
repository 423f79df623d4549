// A specimen in a device's memory, in the form that one traversal takes.
#pragma once

#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"
#include "vulkan/kernel.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vkfv::trace {

const char* traversal_name(Traversal traversal);

struct ChosenTraversal {
    Traversal traversal; // never automatic
    std::string reason;  // clause that names the traversal and says why it was chosen
};

// Chooses the traversal for a specimen on a device: the one asked for, or the faster one if automatic. Throws
// InputError (the quadtree needs a height field, or a mesh that is one) or DeviceError (ray query asked for or needed
// where the device has none).
ChosenTraversal choose_traversal(const vulkan::DeviceReport& device, const specimen::Specimen& specimen,
                                 Traversal asked, bool nonsequential = false);

// The specimen's buffers, to which shaders/device/specimen_hit.glsl is bound. The device must outlive it.
class DeviceSpecimen {
  public:
    // traversal: never automatic. elements: boxes of the instrument's elements in their own frame, put into one
    // structure with the specimen, for non-sequential paths. Throws DeviceError with sizes when a part exceeds what a
    // buffer may span.
    DeviceSpecimen(const vulkan::Device& device, const specimen::Specimen& specimen, Traversal traversal,
                   std::span<const vulkan::Box> elements = {});

    std::vector<vulkan::Binding> bindings() const; // valid as long as this object, also when it is moved
    std::vector<vulkan::BindingDeclaration> declarations() const;
    std::vector<vulkan::SpecializationConstant> constants() const; // the specimen's kind and its scatter models
    // The specimen's record in float; bottom and top still enclose the surface.
    physics::f32::SpecimenRecord record(int max_bounces) const;
    std::uint32_t features() const; // FEATURE_* that the specimen has
    std::size_t bytes() const;      // device memory taken
    // Root of the elements' tree among the nodes, and by box index the element or facet in the box.
    std::uint32_t elements_root() const { return elements_root_; }
    const std::vector<std::uint32_t>& element_order() const { return element_order_; }

  private:
    physics::f32::SpecimenRecord record_{};
    bool has_reflectance_map_ = false;
    bool has_spectral_material_ = false;
    bool has_falling_cells_ = false;                  // a mesh's cells are split the other way: mesh_lattice.hpp
    std::map<std::uint32_t, vulkan::Buffer> buffers_; // by binding number
    std::unique_ptr<vulkan::AccelerationStructure> structure_;
    std::uint32_t elements_root_ = 0;
    std::vector<std::uint32_t> element_order_;
};

} // namespace vkfv::trace
