#include "trace/device/device_specimen.hpp"

#include "core/messages/error.hpp"
#include "specimen/description.hpp"
#include "trace/interface/device_records.hpp"
#include "trace/structures/bounding_volume_hierarchy.hpp"
#include "trace/structures/entry_nodes.hpp"
#include "trace/structures/mesh_lattice.hpp"
#include "trace/structures/pyramid.hpp"
#include "trace/structures/triangle_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <variant>

namespace vkfv::trace {

namespace {

// Size of the buffers that the chosen kind of specimen does not read, which must be bound all the same.
constexpr std::size_t unread_bytes = 64;

// Number of boxes along a side of an analytic surface: with many more the tree costs more than the march it saves.
constexpr int boxes_along_side = 64;

struct Triangulation {
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// Two triangles a cell of a height field, counter-clockwise seen from +z.
Triangulation triangulate(const specimen::HeightField& field) {
    const Grid<float>& heights = field.heights;
    Triangulation result;
    result.vertices.reserve(heights.values.size());
    for (int row = 0; row < heights.rows; ++row) {
        for (int column = 0; column < heights.columns; ++column) {
            result.vertices.emplace_back(static_cast<float>(field.x_min + column * field.pitch_x),
                                         static_cast<float>(field.y_min + row * field.pitch_y), heights(column, row));
        }
    }
    result.triangles.reserve(2 * heights.values.size());
    for (int row = 0; row + 1 < heights.rows; ++row) {
        for (int column = 0; column + 1 < heights.columns; ++column) {
            const auto corner = static_cast<std::uint32_t>(heights.index(column, row));
            const auto above = static_cast<std::uint32_t>(heights.index(column, row + 1));
            result.triangles.emplace_back(corner, corner + 1, above + 1);
            result.triangles.emplace_back(corner, above + 1, above);
        }
    }
    return result;
}

// Two points of a column at each step, (i, j) and (i, j+1), row by row except the last.
std::vector<glm::vec2> column_steps(const Grid<float>& heights) {
    std::vector<glm::vec2> steps;
    steps.reserve(heights.values.size());
    for (int row = 0; row + 1 < heights.rows; ++row) {
        for (int column = 0; column < heights.columns; ++column) {
            steps.emplace_back(heights(column, row), heights(column, row + 1));
        }
    }
    return steps;
}

// Reorders values: result[k] = values[order[k]].
template <class Value>
std::vector<Value> in_order(const std::vector<Value>& values, const std::vector<std::uint32_t>& order) {
    std::vector<Value> result;
    result.reserve(values.size());
    for (const std::uint32_t index : order) {
        result.push_back(values[index]);
    }
    return result;
}

std::vector<glm::uvec3> in_median_order(const std::vector<glm::vec3>& vertices,
                                        const std::vector<glm::uvec3>& triangles) {
    std::vector<glm::vec3> centres;
    centres.reserve(triangles.size());
    for (const glm::uvec3& triangle : triangles) {
        centres.push_back((vertices[triangle.x] + vertices[triangle.y] + vertices[triangle.z]) / 3.0F);
    }
    return in_order(triangles, vulkan::median_order(centres));
}

// Blocks of the pyramid as boxes, in median order.
std::vector<vulkan::Box> boxes_of(const Pyramid& pyramid, const specimen::Analytic& surface) {
    const PyramidHeader& header = pyramid.header;
    int level = 0;
    while (level < header.top_level && std::max(header.cells_x, header.cells_y) >> level > boxes_along_side) {
        ++level;
    }
    const int side = 1 << level;
    const glm::dvec2 cell((surface.x_max - surface.x_min) / header.cells_x,
                          (surface.y_max - surface.y_min) / header.cells_y);
    std::vector<vulkan::Box> boxes;
    std::vector<glm::vec3> centres;
    for (int row = 0; row * side < header.cells_y; ++row) {
        for (int column = 0; column * side < header.cells_x; ++column) {
            const glm::vec2 range = pyramid.range(level, column, row);
            const auto x = [&](int block) { return surface.x_min + std::min(block * side, header.cells_x) * cell.x; };
            const auto y = [&](int block) { return surface.y_min + std::min(block * side, header.cells_y) * cell.y; };
            boxes.push_back({glm::vec3(x(column), y(row), range.x), glm::vec3(x(column + 1), y(row + 1), range.y)});
            centres.push_back(0.5F * (boxes.back().minimum + boxes.back().maximum));
        }
    }
    return in_order(boxes, vulkan::median_order(centres));
}

// Makes the buffers of one specimen, each no larger than a kernel may reach.
class Uploader {
  public:
    Uploader(const vulkan::Device& device, std::map<std::uint32_t, vulkan::Buffer>& buffers)
        : device_(&device), buffers_(&buffers) {}

    const vulkan::Device& device() const { return *device_; }

    void expect(const char* what, std::size_t bytes) const {
        const std::uint64_t limit = device_->report().max_storage_buffer_bytes;
        if (bytes > limit) {
            throw DeviceError(fmt::format("the specimen's {} take {} bytes, but {} reaches at most {} bytes of one "
                                          "buffer; give the specimen fewer points (a larger pitch or a smaller size)",
                                          what, bytes, device_->report().name, limit));
        }
    }

    vulkan::Buffer& reserve(std::uint32_t slot, const char* what, std::size_t bytes) {
        expect(what, bytes);
        return buffers_->emplace(slot, vulkan::Buffer(*device_, bytes)).first->second;
    }

    template <class Value>
    void put(std::uint32_t slot, const char* what, const std::vector<Value>& values) {
        reserve(slot, what, values.size() * sizeof(Value)).write_values(std::span<const Value>(values));
    }

    void put_ceilings(const Ceilings& ceilings) {
        vulkan::Buffer& buffer = reserve(kernels::BINDING_CEILINGS, "ceilings",
                                         sizeof ceilings.header + ceilings.heights.size() * sizeof(float));
        buffer.write(std::as_bytes(std::span(&ceilings.header, 1)));
        buffer.write(std::as_bytes(std::span(ceilings.heights)), sizeof ceilings.header);
    }

    void put_entries(const EntryNodes& entries) {
        const auto finest = static_cast<std::int32_t>(entries.finest_level);
        vulkan::Buffer& buffer = reserve(kernels::BINDING_ENTRY_NODES, "entries into the hierarchy",
                                         sizeof finest + entries.nodes.size() * sizeof(std::uint32_t));
        buffer.write(std::as_bytes(std::span(&finest, 1)));
        buffer.write(std::as_bytes(std::span(entries.nodes)), sizeof finest);
    }

    void leave_unread(std::uint32_t slot) {
        if (!buffers_->contains(slot)) {
            reserve(slot, "unread bytes", unread_bytes).fill_zero();
        }
    }

  private:
    const vulkan::Device* device_;
    std::map<std::uint32_t, vulkan::Buffer>* buffers_;
};

Pyramid pyramid_of(const specimen::Specimen& specimen, const specimen::Analytic& surface) {
    specimen::Analytic shape = surface;
    shape.lattice.reset();
    return make_pyramid(surface, specimen::record({shape, specimen.material}, 0));
}

std::vector<glm::uvec3> upload_triangles(Uploader& uploader, const std::vector<glm::vec3>& vertices,
                                         const std::vector<glm::uvec3>& triangles) {
    uploader.expect("vertices", vertices.size() * sizeof(glm::vec3));
    uploader.expect("triangles", triangles.size() * sizeof(glm::uvec3));
    std::vector<glm::uvec3> ordered = in_median_order(vertices, triangles);
    uploader.put(kernels::BINDING_VERTICES, "vertices", vertices);
    uploader.put(kernels::BINDING_TRIANGLES, "triangles", ordered);
    return ordered;
}

// Uploads pairs of triangles in the order of their hierarchy; returns its nodes.
std::vector<HierarchyNode> upload_in_hierarchy(Uploader& uploader, const std::vector<glm::vec3>& vertices,
                                               const std::vector<glm::uvec3>& triangles) {
    const std::vector<TrianglePair> pairs = pair_triangles(vertices, triangles);
    uploader.expect("triangles", pairs.size() * sizeof(TrianglePair));
    std::vector<vulkan::Box> boxes;
    boxes.reserve(pairs.size());
    for (const TrianglePair& pair : pairs) {
        boxes.push_back(pair.box());
    }
    // More primitives to a slot would save few nodes, as most are not full, and cost more pairs met in vain.
    BoundingVolumeHierarchy hierarchy = build_hierarchy(boxes, 1);
    uploader.put(kernels::BINDING_VERTICES, "triangles", in_order(pairs, hierarchy.order));
    return std::move(hierarchy.nodes);
}

// A hierarchy over the parts of a specimen: an acceleration structure for ray queries, or nodes of vkfv's own tree. The
// quadtree has neither.
struct Hierarchy {
    std::unique_ptr<vulkan::AccelerationStructure> structure;
    std::vector<HierarchyNode> nodes;
};

Hierarchy over_triangles(Uploader& uploader, const std::vector<glm::vec3>& vertices,
                         const std::vector<glm::uvec3>& triangles, Traversal traversal) {
    if (traversal == Traversal::bvh) {
        return {nullptr, upload_in_hierarchy(uploader, vertices, triangles)};
    }
    const auto ordered = upload_triangles(uploader, vertices, triangles);
    return {std::make_unique<vulkan::AccelerationStructure>(
                vulkan::AccelerationStructure::of_triangles(uploader.device(), vertices, ordered)),
            {}};
}

Hierarchy upload(Uploader& uploader, const specimen::Specimen&, const specimen::HeightField& field, Traversal traversal,
                 double) {
    if (traversal == Traversal::quadtree) {
        uploader.expect("heights", field.heights.values.size() * sizeof(glm::vec2));
        uploader.put(kernels::BINDING_HEIGHTS, "heights", column_steps(field.heights));
        uploader.put_ceilings(make_ceilings(field));
        return {};
    }
    const Triangulation surface = triangulate(field);
    return over_triangles(uploader, surface.vertices, surface.triangles, traversal);
}

// Uploads an analytic surface for a traversal. relief: highest less lowest height, mm.
Hierarchy upload(Uploader& uploader, const specimen::Specimen& specimen, const specimen::Analytic& surface,
                 Traversal traversal, double relief) {
    if (surface.lattice) {
        uploader.put(kernels::BINDING_HEIGHTS, "heights", surface.lattice->heights.values);
    }
    const Pyramid pyramid = pyramid_of(specimen, surface);
    if (traversal == Traversal::quadtree) {
        uploader.put_ceilings(make_ceilings(pyramid, relief));
        return {};
    }
    const std::vector<vulkan::Box> boxes = boxes_of(pyramid, surface);
    if (traversal == Traversal::bvh) {
        // One box a slot, as a march costs far more than a box.
        BoundingVolumeHierarchy hierarchy = build_hierarchy(boxes, 1);
        uploader.put(kernels::BINDING_TILES, "tiles", in_order(boxes, hierarchy.order));
        return {nullptr, std::move(hierarchy.nodes)};
    }
    uploader.put(kernels::BINDING_TILES, "tiles", boxes);
    return {std::make_unique<vulkan::AccelerationStructure>(
                vulkan::AccelerationStructure::of_boxes(uploader.device(), boxes)),
            {}};
}

Hierarchy upload(Uploader& uploader, const specimen::Specimen&, const specimen::Mesh& mesh, Traversal traversal,
                 double) {
    return over_triangles(uploader, mesh.vertices, mesh.triangles, traversal);
}

// The height field of a mesh that is one, with each cell's diagonal in the last bit of its first height: the walk over
// the cells reads it there (shaders/device/specimen_quadtree.glsl). A height changes by a rounding step at most.
specimen::HeightField marked_field(MeshLattice lattice) {
    Grid<float>& heights = lattice.field.heights;
    for (int row = 0; row < heights.rows; ++row) {
        for (int column = 0; column < heights.columns; ++column) {
            const bool has_cell = column + 1 < heights.columns && row + 1 < heights.rows;
            const std::size_t cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(heights.columns - 1) +
                                     static_cast<std::size_t>(column);
            const std::uint32_t mark = has_cell && lattice.falling[cell] ? 1U : 0U;
            const auto bits = std::bit_cast<std::uint32_t>(heights(column, row));
            heights(column, row) = std::bit_cast<float>((bits & ~1U) | mark);
        }
    }
    return std::move(lattice.field);
}

// Appends a tree to another in one buffer; returns the index of its root there.
std::uint32_t append_tree(std::vector<HierarchyNode>& nodes, const std::vector<HierarchyNode>& tree) {
    const auto root = static_cast<std::uint32_t>(nodes.size());
    for (HierarchyNode node : tree) {
        node.first_node += root;
        nodes.push_back(node);
    }
    return root;
}

} // namespace

const char* traversal_name(Traversal traversal) {
    return traversal == Traversal::ray_query ? "ray-query" : traversal == Traversal::bvh ? "bvh" : "quadtree";
}

ChosenTraversal choose_traversal(const vulkan::DeviceReport& device, const specimen::Specimen& specimen,
                                 Traversal asked, bool nonsequential) {
    const bool mesh = std::holds_alternative<specimen::Mesh>(specimen.geometry);
    if (nonsequential && asked == Traversal::quadtree) {
        throw std::logic_error("elements are traced by ray query or bvh");
    }
    const bool may_take_ray_query = asked == Traversal::automatic && device.ray_query && !vulkan::is_software(device);
    // Whether a mesh is a lattice is tested only where it matters, as the test takes time.
    const bool lattice = mesh && !nonsequential && !may_take_ray_query &&
                         (asked == Traversal::quadtree || asked == Traversal::automatic) &&
                         lattice_of(std::get<specimen::Mesh>(specimen.geometry)).has_value();
    if (mesh && !lattice && asked == Traversal::quadtree) {
        throw InputError(
            {{},
             "trace.traversal",
             "quadtree",
             "a specimen that is a height field; this one is a mesh whose points are not those of a regular grid",
             "Use traversal = \"auto\", \"bvh\" or \"ray-query\", or give the specimen as a height map image."});
    }
    if (asked == Traversal::ray_query && !device.ray_query) {
        throw DeviceError(fmt::format("{} has no VK_KHR_ray_query, which traversal = \"ray-query\" asks for; use "
                                      "another device (vkfv devices lists them) or traversal = \"{}\"",
                                      device.name, mesh || nonsequential ? "bvh" : "quadtree"));
    }
    if (asked != Traversal::automatic) {
        return {asked, fmt::format("{} (as asked)", traversal_name(asked))};
    }
    const Traversal own = (mesh && !lattice) || nonsequential ? Traversal::bvh : Traversal::quadtree;
    if (lattice) {
        return {own, "quadtree (the mesh is a height field)"};
    }
    if (!device.ray_query) {
        return {own, fmt::format("{} (the device has no ray query)", traversal_name(own))};
    }
    if (vulkan::is_software(device)) {
        return {own, fmt::format("{} (faster than ray query on a CPU)", traversal_name(own))};
    }
    return {Traversal::ray_query, "ray-query (the device has it)"};
}

DeviceSpecimen::DeviceSpecimen(const vulkan::Device& device, const specimen::Specimen& specimen, Traversal traversal,
                               std::span<const vulkan::Box> elements)
    : record_(to_float(specimen::record(specimen, 0))), has_reflectance_map_(specimen.reflectance.has_value()) {
    if (traversal == Traversal::automatic) {
        throw std::logic_error("DeviceSpecimen takes a traversal that has been chosen");
    }
    if (!elements.empty() && traversal == Traversal::quadtree) {
        throw std::logic_error("elements are traced by ray query or bvh");
    }
    Uploader uploader(device, buffers_);
    const auto upload_as = [&](const specimen::Specimen& whole) {
        return std::visit(
            [&](const auto& geometry) {
                return upload(uploader, whole, geometry, traversal, record_.top - record_.bottom);
            },
            whole.geometry);
    };
    Hierarchy hierarchy;
    const auto* mesh = std::get_if<specimen::Mesh>(&specimen.geometry);
    if (mesh != nullptr && traversal == Traversal::quadtree) {
        auto lattice = lattice_of(*mesh);
        if (!lattice) {
            throw std::logic_error("a mesh that is no height field is not traced by the quadtree");
        }
        has_falling_cells_ = std::ranges::find(lattice->falling, true) != lattice->falling.end();
        const specimen::Specimen as_field{marked_field(*std::move(lattice)), specimen.material, specimen.reflectance};
        record_ = to_float(specimen::record(as_field, 0));
        hierarchy = upload_as(as_field);
    } else {
        hierarchy = upload_as(specimen);
    }
    if (traversal == Traversal::bvh) {
        uploader.put_entries(
            entry_nodes(hierarchy.nodes, {record_.x_min, record_.y_min}, {record_.x_max, record_.y_max}));
    }
    if (!elements.empty() && traversal == Traversal::ray_query) {
        std::vector<vulkan::AccelerationStructure> parts;
        parts.push_back(std::move(*hierarchy.structure));
        parts.push_back(vulkan::AccelerationStructure::of_boxes(device, elements));
        *hierarchy.structure = vulkan::AccelerationStructure::join(device, std::move(parts));
        element_order_.resize(elements.size());
        std::iota(element_order_.begin(), element_order_.end(), 0u);
    } else if (!elements.empty()) {
        // One box a slot, as meeting an element costs far more than a box.
        BoundingVolumeHierarchy of_elements = build_hierarchy(elements, 1);
        elements_root_ = append_tree(hierarchy.nodes, of_elements.nodes);
        element_order_ = std::move(of_elements.order);
    }
    if (traversal == Traversal::bvh) {
        uploader.put(kernels::BINDING_STRUCTURE, "hierarchy of boxes", hierarchy.nodes);
    }
    structure_ = std::move(hierarchy.structure);
    if (specimen.reflectance && !specimen.reflectance->values.values.empty()) {
        uploader.put(kernels::BINDING_REFLECTANCES, "reflectances", specimen.reflectance->values.values);
    }
    uploader.leave_unread(kernels::BINDING_REFLECTANCES);
    if (const specimen::MaterialNumbers material = specimen::material_numbers(specimen.material);
        !material.numbers.empty()) {
        has_spectral_material_ = material.spectral_points > 0;
        uploader.put(kernels::BINDING_MATERIAL, "scatter tables", material.numbers);
    }
    uploader.leave_unread(kernels::BINDING_MATERIAL);
    uploader.leave_unread(kernels::BINDING_HEIGHTS);
    if (traversal != Traversal::quadtree) {
        uploader.leave_unread(kernels::BINDING_VERTICES);
        uploader.leave_unread(kernels::BINDING_TRIANGLES);
        uploader.leave_unread(kernels::BINDING_TILES);
    }
}

std::vector<vulkan::Binding> DeviceSpecimen::bindings() const {
    std::vector<vulkan::Binding> result;
    for (const auto& [slot, buffer] : buffers_) {
        result.push_back({slot, &buffer});
    }
    if (structure_) {
        result.push_back({kernels::BINDING_STRUCTURE, structure_.get()});
    }
    return result;
}

std::vector<vulkan::BindingDeclaration> DeviceSpecimen::declarations() const {
    std::vector<vulkan::BindingDeclaration> result;
    for (const auto& [slot, buffer] : buffers_) {
        result.push_back({slot, vulkan::BindingKind::storage_buffer});
    }
    if (structure_) {
        result.push_back({kernels::BINDING_STRUCTURE, vulkan::BindingKind::acceleration_structure});
    }
    return result;
}

std::vector<vulkan::SpecializationConstant> DeviceSpecimen::constants() const {
    const auto& material = record_.material;
    const bool one_white_lobe =
        material.lobe_0.weight >= 1 && material.lobe_1.weight <= 0 && !has_reflectance_map_ && !has_spectral_material_;
    std::uint32_t models = one_white_lobe ? 0u : physics::f32::SCATTER_CHOICE;
    for (const auto& lobe : {material.lobe_0, material.lobe_1, material.lobe_2, material.lobe_3}) {
        models |= lobe.weight > 0 ? 1u << lobe.model : 0u;
        models |= lobe.weight > 0 && physics::f32::lobe_is_delta(lobe) ? physics::f32::SCATTER_DELTA : 0u;
        models |= lobe.weight > 0 && physics::f32::lobe_has_index(lobe) ? physics::f32::SCATTER_INDEX : 0u;
    }
    return {{kernels::CONSTANT_SPECIMEN_KIND, record_.kind},
            {kernels::CONSTANT_SCATTER_MODELS, models},
            {kernels::CONSTANT_FALLING_CELLS, has_falling_cells_ ? 1U : 0U}};
}

physics::f32::SpecimenRecord DeviceSpecimen::record(int max_bounces) const {
    physics::f32::SpecimenRecord result = record_;
    result.max_bounces = max_bounces;
    return result;
}

std::uint32_t DeviceSpecimen::features() const {
    return (has_reflectance_map_ ? physics::f32::FEATURE_REFLECTANCE_MAP : 0u) |
           (has_spectral_material_ ? physics::f32::FEATURE_SPECTRAL_MATERIAL : 0u);
}

std::size_t DeviceSpecimen::bytes() const {
    std::size_t total = structure_ ? structure_->bytes() : 0;
    for (const auto& [slot, buffer] : buffers_) {
        total += buffer.bytes();
    }
    return total;
}

} // namespace vkfv::trace
