#include "specimen/files.hpp"
#include "specimen/gltf_accessor.hpp"
#include "specimen/gltf_document.hpp"

#include "core/files/file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace vkfv::specimen {
namespace {

using gltf::Component;
using gltf::Document;
using gltf::Elements;
using gltf::Object;

// Modes of primitives in the glTF standard.
constexpr std::uint64_t mode_triangles = 4, mode_fan = 6; // strips lie between them, points and lines below

// A few kilobytes may place one mesh a million times: larger numbers are taken for a mistake (some gigabytes of
// memory).
constexpr std::uint64_t most_triangles = std::uint64_t{1} << 26, most_vertices = std::uint64_t{1} << 26;

constexpr const char* instancing = "EXT_mesh_gpu_instancing";

const gltf::Wanted wanted_indices{
    .purpose = "unsigned scalar indices",
    .type = "SCALAR",
    .components = {Component::unsigned_byte, Component::unsigned_short, Component::unsigned_int},
    .interleaved = false};

// Instance attributes are floats or normalised integers.
gltf::Wanted wanted_of_instances(std::string purpose, std::string type) {
    return {.purpose = std::move(purpose),
            .type = std::move(type),
            .components = {Component::real, Component::signed_byte, Component::signed_short, Component::unsigned_byte,
                           Component::unsigned_short},
            .normalised_only = true};
}

glm::dmat4 placed(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale) {
    glm::dmat4 matrix(1);
    matrix[3] = glm::dvec4(translation, 1);
    matrix = matrix * glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) {
        matrix[axis] *= scale[axis];
    }
    return matrix;
}

// A rotation is a unit quaternion except for rounding; other lengths are refused, as their meaning is undefined.
std::optional<glm::dquat> rotation_of(double x, double y, double z, double w) {
    constexpr double rounding = 0.02; // error of normalised bytes
    const glm::dquat rotation(w, x, y, z);
    const double length = glm::length(rotation);
    return std::abs(length - 1) <= rounding ? std::optional(rotation / length) : std::nullopt;
}

class Reader {
  public:
    explicit Reader(const Document& document) : document_(document) {}

    FileMesh read() {
        visited_.assign(document_.count("nodes"), false);
        for (const std::uint64_t root : roots()) {
            walk_tree(root);
        }
        mesh_.vertices.reserve(size_.vertices);
        mesh_.triangles.reserve(size_.triangles);
        for (const Placement& placement : placements_) {
            add_mesh(placement);
        }
        if (!lines_.empty()) {
            spdlog::warn("{}: {} primitives of points and lines are left out", document_.file().string(),
                         lines_.size());
        }
        if (!without_positions_.empty()) {
            spdlog::warn("{}: {} primitives without positions are left out", document_.file().string(),
                         without_positions_.size());
        }
        if (document_.count("animations") > 0) {
            spdlog::warn("{}: its animations are left out; everything stands where its nodes place it",
                         document_.file().string());
        }
        if (mesh_.triangles.empty()) {
            document_.root().fail("glTF", "0 triangles", "at least one triangle in the default scene",
                                  "Export the mesh anew, or name another file.");
        }
        return std::move(mesh_);
    }

  private:
    struct Size {
        std::uint64_t triangles = 0, vertices = 0;
    };
    // A mesh at the place that a node gives it.
    struct Placement {
        std::uint64_t mesh;
        std::uint64_t node;
        glm::dmat4 to_scene;
    };

    Object node_at(std::uint64_t index) const { return document_.item("nodes", "node", index); }

    // The root nodes of the default scene, else of the first one; without scenes all nodes without a parent.
    std::vector<std::uint64_t> roots() const {
        const auto scene = document_.root().integer("scene");
        if (const std::size_t scenes = document_.count("scenes"); scenes > 0 || scene) {
            if (scenes > 1 && !scene) {
                spdlog::warn("{}: of {} scenes, none of them the default, the first is taken",
                             document_.file().string(), scenes);
            }
            return document_.item("scenes", "scene", scene.value_or(0)).integers("nodes");
        }
        std::vector<bool> is_child(document_.count("nodes"), false);
        for (std::uint64_t node = 0; node < is_child.size(); ++node) {
            for (const std::uint64_t child : node_at(node).integers("children")) {
                (void)node_at(child);
                is_child[child] = true;
            }
        }
        std::vector<std::uint64_t> result;
        for (std::uint64_t node = 0; node < is_child.size(); ++node) {
            if (!is_child[node]) {
                result.push_back(node);
            }
        }
        return result;
    }

    // Walks a tree of nodes with an explicit stack, as a chain of nodes may be as long as the file.
    void walk_tree(std::uint64_t root) {
        struct Task {
            std::uint64_t node;
            glm::dmat4 parent;
        };
        std::vector<Task> tasks = {{root, glm::dmat4(1)}};
        while (!tasks.empty()) {
            const Task task = tasks.back();
            tasks.pop_back();
            const Object node = node_at(task.node);
            if (visited_[task.node]) {
                node.fail("", "more than one parent", "a tree of nodes");
            }
            visited_[task.node] = true;
            const glm::dmat4 to_scene = task.parent * transform_of(node);
            if (const auto mesh = node.integer("mesh")) {
                count(*mesh, node);
                placements_.push_back({*mesh, task.node, to_scene});
            }
            const auto children = node.integers("children");
            for (auto child = children.rbegin(); child != children.rend(); ++child) {
                tasks.push_back({*child, to_scene});
            }
        }
    }

    static glm::dmat4 transform_of(const Object& node) {
        const auto matrix = node.numbers("matrix", 16);
        const auto translation = node.numbers("translation", 3);
        const auto rotation = node.numbers("rotation", 4); // order: x, y, z, w
        const auto scale = node.numbers("scale", 3);
        if (!matrix.empty()) {
            if (!translation.empty() || !rotation.empty() || !scale.empty()) {
                node.fail("matrix", "a matrix beside translation, rotation or scale", "either of them");
            }
            if (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1) {
                node.fail("matrix",
                          fmt::format("a last row {}, {}, {}, {}", matrix[3], matrix[7], matrix[11], matrix[15]),
                          "0, 0, 0, 1, column after column");
            }
            return glm::make_mat4(matrix.data());
        }
        std::optional<glm::dquat> turn = glm::dquat(1, 0, 0, 0);
        if (!rotation.empty()) {
            turn = rotation_of(rotation[0], rotation[1], rotation[2], rotation[3]);
            if (!turn) {
                node.fail("rotation",
                          fmt::format("({}, {}, {}, {})", rotation[0], rotation[1], rotation[2], rotation[3]),
                          "a quaternion of length 1");
            }
        }
        return placed(translation.empty() ? glm::dvec3(0) : glm::make_vec3(translation.data()), *turn,
                      scale.empty() ? glm::dvec3(1) : glm::make_vec3(scale.data()));
    }

    // Counts triangles and vertices before any is made, so that a mesh too large for memory is refused.
    void count(std::uint64_t mesh, const Object& node) {
        if (node.has("skin")) {
            node.fail("skin", fmt::format("{}", node.integer("skin").value_or(0)), "a mesh that no skeleton bends",
                      "Apply the skeleton's pose to the mesh before the export.");
        }
        const Size size = size_of(mesh);
        const std::uint64_t copies = instances_of(node).size();
        if (size.triangles > (most_triangles - size_.triangles) / copies ||
            size.vertices > (most_vertices - size_.vertices) / copies) {
            node.fail("mesh",
                      fmt::format("{} triangles and {} vertices, {} times", size.triangles, size.vertices, copies),
                      fmt::format("at most {} of each in all", most_triangles),
                      "Export a coarser mesh, or fewer copies of it.");
        }
        size_.triangles += size.triangles * copies;
        size_.vertices += size.vertices * copies;
    }

    Size size_of(std::uint64_t index) {
        const auto known = sizes_.find(index);
        if (known != sizes_.end()) {
            return known->second;
        }
        const Object mesh = document_.item("meshes", "mesh", index);
        const auto primitives = mesh.objects("primitives");
        if (primitives.empty()) {
            mesh.fail("primitives", "nothing", "at least one primitive");
        }
        Size size;
        for (const Object& primitive : primitives) {
            if (const auto shape = shape_of(primitive)) {
                size.triangles += shape->mode == mode_triangles ? shape->count() / 3 : shape->count() - 2;
                size.vertices += shape->points.count();
            }
        }
        return sizes_[index] = size;
    }

    void add_mesh(const Placement& placement) {
        const Object mesh = document_.item("meshes", "mesh", placement.mesh);
        const Object node = node_at(placement.node);
        const auto weights = node.has("weights") ? node.numbers("weights") : mesh.numbers("weights");
        const auto primitives = mesh.objects("primitives");
        for (const glm::dmat4& instance : instances_of(node)) {
            for (const Object& primitive : primitives) {
                if (const auto shape = shape_of(primitive)) {
                    add_primitive(primitive, *shape, weights, placement.to_scene * instance);
                }
            }
        }
    }

    // The transforms of a node's mesh that precede the node's own: the identity alone, unless the extension states
    // instances.
    std::vector<glm::dmat4> instances_of(const Object& node) const {
        const auto extensions = node.object("extensions");
        const auto extension = extensions ? extensions->object(instancing) : std::nullopt;
        if (!extension) {
            return {glm::dmat4(1)};
        }
        const Object attributes = extension->needed_object("attributes");
        std::optional<std::uint64_t> count;
        const auto read = [&](const char* key, const gltf::Wanted& wanted) -> std::optional<Elements> {
            const auto accessor = attributes.integer(key);
            if (!accessor) {
                return std::nullopt;
            }
            Elements elements(document_, *accessor, wanted);
            if (count && *count != elements.count()) {
                attributes.fail(key, fmt::format("{} elements", elements.count()),
                                fmt::format("{}, as the other attributes have", *count));
            }
            count = elements.count();
            return elements;
        };
        const auto translations = read("TRANSLATION", wanted_of_instances("translations as VEC3", "VEC3"));
        const auto rotations = read("ROTATION", wanted_of_instances("rotations as VEC4", "VEC4"));
        const auto scales = read("SCALE", wanted_of_instances("scales as VEC3", "VEC3"));
        if (!count) {
            attributes.fail("", "no TRANSLATION, ROTATION or SCALE", "at least one of them");
        }
        if (*count > most_triangles) {
            attributes.fail("", fmt::format("{} instances", *count), fmt::format("at most {}", most_triangles));
        }
        const auto vector = [](const std::optional<Elements>& elements, std::uint64_t k, double otherwise) {
            return elements ? glm::dvec3(elements->at(k, 0), elements->at(k, 1), elements->at(k, 2))
                            : glm::dvec3(otherwise);
        };
        std::vector<glm::dmat4> result;
        result.reserve(*count);
        for (std::uint64_t k = 0; k < *count; ++k) {
            std::optional<glm::dquat> rotation = glm::dquat(1, 0, 0, 0);
            if (rotations) {
                rotation =
                    rotation_of(rotations->at(k, 0), rotations->at(k, 1), rotations->at(k, 2), rotations->at(k, 3));
                if (!rotation) {
                    attributes.fail(fmt::format("ROTATION of instance {}", k), "another length",
                                    "a quaternion of length 1", "Export the file anew; it is damaged.",
                                    rotations->where(k));
                }
            }
            result.push_back(placed(vector(translations, k, 0), *rotation, vector(scales, k, 1)));
        }
        return result;
    }

    // Positions are floats, unless an extension packs them.
    gltf::Wanted wanted_positions() const {
        gltf::Wanted wanted{.purpose = "positions of three floats", .type = "VEC3", .components = {Component::real}};
        if (document_.uses("KHR_mesh_quantization")) {
            wanted.purpose = "positions of three floats, bytes or shorts";
            wanted.components = {Component::real, Component::signed_byte, Component::unsigned_byte,
                                 Component::signed_short, Component::unsigned_short};
        }
        return wanted;
    }

    struct Morph {
        double weight;
        Elements displacements;
    };

    // The morph targets that displace positions, with their weights.
    std::vector<Morph> morphs_of(const Object& primitive, const std::vector<double>& weights,
                                 std::uint64_t points) const {
        std::vector<Morph> result;
        const auto targets = primitive.objects("targets");
        if (!weights.empty() && weights.size() != targets.size()) {
            primitive.fail("targets", fmt::format("{} of them, with {} weights", targets.size(), weights.size()),
                           "a weight for each");
        }
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const auto accessor = targets[k].integer("POSITION");
            if (weights[k] == 0 || !accessor) {
                continue;
            }
            result.push_back({weights[k], Elements(document_, *accessor, wanted_positions())});
            if (result.back().displacements.count() != points) {
                targets[k].fail("POSITION", fmt::format("{} elements", result.back().displacements.count()),
                                fmt::format("as many as there are vertices, {}", points));
            }
        }
        return result;
    }

    void add_vertices(const Object& primitive, const Elements& points, const std::vector<Morph>& morphs,
                      const glm::dmat4& to_scene) {
        for (std::uint64_t i = 0; i < points.count(); ++i) {
            glm::dvec3 point(points.at(i, 0), points.at(i, 1), points.at(i, 2));
            for (const Morph& morph : morphs) {
                const Elements& by = morph.displacements;
                point += morph.weight * glm::dvec3(by.at(i, 0), by.at(i, 1), by.at(i, 2));
            }
            const glm::dvec3 vertex(to_scene * glm::dvec4(point, 1));
            if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z)) {
                primitive.fail(fmt::format("vertex {}", i), fmt::format("({}, {}, {})", point.x, point.y, point.z),
                               "finite coordinates", "Export the file anew; it is damaged.", points.where(i));
            }
            mesh_.vertices.push_back(vertex);
        }
    }

    // A primitive that consists of triangles.
    struct Shape {
        std::uint64_t mode;
        Elements points;
        std::optional<Elements> indices;

        std::uint64_t count() const { return indices ? indices->count() : points.count(); }
    };

    // The primitive as triangles; none for points and lines, and for primitives without positions.
    std::optional<Shape> shape_of(const Object& primitive) {
        const std::uint64_t mode = primitive.integer("mode").value_or(mode_triangles);
        if (mode > mode_fan) {
            primitive.fail("mode", fmt::format("{}", mode), "a number from 0 to 6");
        }
        const auto position = primitive.needed_object("attributes").integer("POSITION");
        if (mode < mode_triangles || !position) {
            (mode < mode_triangles ? lines_ : without_positions_).insert(primitive.name());
            return std::nullopt;
        }
        Shape shape{mode, Elements(document_, *position, wanted_positions()), {}};
        if (const auto accessor = primitive.integer("indices")) {
            shape.indices.emplace(document_, *accessor, wanted_indices);
        }
        if (mode == mode_triangles ? shape.count() % 3 != 0 : shape.count() < 3) {
            primitive.fail(shape.indices ? "indices" : "attributes", fmt::format("{} vertices", shape.count()),
                           mode == mode_triangles ? "three for every triangle" : "at least three for a strip or a fan");
        }
        return shape;
    }

    void add_primitive(const Object& primitive, const Shape& shape, const std::vector<double>& weights,
                       const glm::dmat4& to_scene) {
        const Elements& points = shape.points;
        const std::optional<Elements>& indices = shape.indices;
        const std::uint64_t count = shape.count();
        const std::uint64_t base = mesh_.vertices.size();
        add_vertices(primitive, points, morphs_of(primitive, weights, points.count()), to_scene);

        const auto vertex = [&](std::uint64_t i) {
            const std::uint64_t index = indices ? static_cast<std::uint64_t>(indices->at(i, 0)) : i;
            if (index >= points.count()) {
                primitive.fail(fmt::format("index {}", i), fmt::format("{}", index),
                               fmt::format("an index below {}", points.count()), "Export the file anew; it is damaged.",
                               indices->where(i));
            }
            return static_cast<std::uint32_t>(base + index);
        };
        // A mirroring transform reverses the orientation of triangles; every second one of a strip is reversed already.
        const bool mirrored = glm::determinant(glm::dmat3(to_scene)) < 0;
        const auto add = [&](std::uint64_t a, std::uint64_t b, std::uint64_t c, bool turned) {
            mesh_.triangles.emplace_back(vertex(a), vertex(turned != mirrored ? c : b),
                                         vertex(turned != mirrored ? b : c));
        };
        if (shape.mode == mode_triangles) {
            for (std::uint64_t i = 0; i < count; i += 3) {
                add(i, i + 1, i + 2, false);
            }
        } else {
            const bool fan = shape.mode == mode_fan;
            for (std::uint64_t i = 0; i + 2 < count; ++i) {
                add(fan ? 0 : i, i + 1, i + 2, !fan && i % 2 == 1);
            }
        }
    }

    const Document& document_;
    FileMesh mesh_;
    std::vector<bool> visited_; // by node
    std::vector<Placement> placements_;
    std::map<std::uint64_t, Size> sizes_;             // by mesh
    Size size_;                                       // total of all placements
    std::set<std::string> lines_, without_positions_; // names of primitives that are left out
};

} // namespace

FileMesh parse_gltf(std::string bytes, const std::filesystem::path& file) {
    const Document document(std::move(bytes), file);
    return Reader(document).read();
}

FileMesh read_gltf(const std::filesystem::path& file, const SourceLocation& mention) {
    return parse_gltf(specimen_bytes(file, mention), file);
}

} // namespace vkfv::specimen
