#include "specimen/files.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tiny_gltf.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace vkfv::specimen {
namespace {

// Elements of an accessor, checked against the buffer they lie in before the first is read.
struct Elements {
    const unsigned char* first = nullptr;
    std::size_t count = 0;
    std::size_t stride = 0;
    int component_type = 0;
    std::size_t buffer_offset = 0; // of the first, for messages

    template <class Component>
    Component read(std::size_t element, std::size_t component) const {
        Component value;
        std::memcpy(&value, first + element * stride + component * sizeof(Component), sizeof value);
        return value;
    }
};

class Reader {
  public:
    Reader(const tinygltf::Model& model, const std::filesystem::path& file) : model_(model), file_(file) {}

    FileMesh read() {
        visited_.assign(model_.nodes.size(), false);
        if (!model_.scenes.empty()) {
            const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
            for (const int node : item(model_.scenes, scene, "scene").nodes) {
                add_node(node, glm::dmat4(1));
            }
        } else {
            // Without a scene every node that is nobody's child is a root.
            std::vector<bool> is_child(model_.nodes.size(), false);
            for (const tinygltf::Node& node : model_.nodes) {
                for (const int child : node.children) {
                    item(model_.nodes, child, "node");
                    is_child[static_cast<std::size_t>(child)] = true;
                }
            }
            for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
                if (!is_child[node]) {
                    add_node(static_cast<int>(node), glm::dmat4(1));
                }
            }
        }
        if (mesh_.triangles.empty()) {
            fail("glTF", "0 triangles", "at least one triangle in the default scene", std::nullopt);
        }
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected,
                           std::optional<std::uint64_t> offset) const {
        throw InputError(
            {{file_, 0, 0, offset}, key, found, expected, "Export the file anew; it is damaged or unusual."});
    }

    template <class Item>
    const Item& item(const std::vector<Item>& items, int index, const std::string& name) const {
        if (index < 0 || static_cast<std::size_t>(index) >= items.size()) {
            fail(name, fmt::format("{}", index), fmt::format("an index below {}", items.size()),
                 std::nullopt);
        }
        return items[static_cast<std::size_t>(index)];
    }

    void add_node(int index, const glm::dmat4& parent) {
        const tinygltf::Node& node = item(model_.nodes, index, "node");
        if (visited_[static_cast<std::size_t>(index)]) {
            fail(fmt::format("node {}", index), "more than one parent", "a tree of nodes", std::nullopt);
        }
        visited_[static_cast<std::size_t>(index)] = true;
        glm::dmat4 local(1);
        if (node.matrix.size() == 16) {
            local = glm::make_mat4(node.matrix.data());
        } else {
            if (node.translation.size() == 3) {
                local[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1);
            }
            if (node.rotation.size() == 4) { // x, y, z, w
                const std::vector<double>& r = node.rotation;
                local = local * glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
            }
            if (node.scale.size() == 3) {
                for (int axis = 0; axis < 3; ++axis) {
                    local[axis] *= node.scale[static_cast<std::size_t>(axis)];
                }
            }
        }
        const glm::dmat4 to_scene = parent * local;
        if (node.mesh >= 0) {
            const tinygltf::Mesh& mesh = item(model_.meshes, node.mesh, "mesh");
            for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
                add_primitive(mesh.primitives[i], to_scene,
                              fmt::format("mesh {} primitive {}", node.mesh, i));
            }
        }
        for (const int child : node.children) {
            add_node(child, to_scene);
        }
    }

    Elements elements(int index, int type, std::initializer_list<int> component_types) const {
        const std::string key = fmt::format("accessor {}", index);
        const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
        if (accessor.sparse.isSparse || accessor.bufferView < 0) {
            fail(key, "a sparse or compressed accessor", "plain data in a buffer", std::nullopt);
        }
        if (accessor.type != type || std::find(component_types.begin(), component_types.end(),
                                               accessor.componentType) == component_types.end()) {
            fail(key, fmt::format("type {} of components {}", accessor.type, accessor.componentType),
                 type == TINYGLTF_TYPE_VEC3 ? "positions of three floats" : "unsigned scalar indices",
                 std::nullopt);
        }
        const tinygltf::BufferView& view = item(model_.bufferViews, accessor.bufferView, "buffer view");
        const tinygltf::Buffer& buffer = item(model_.buffers, view.buffer, "buffer");
        const std::size_t size =
            static_cast<std::size_t>(
                tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType))) *
            static_cast<std::size_t>(
                tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
        Elements result;
        result.stride = view.byteStride > 0 ? view.byteStride : size;
        result.count = accessor.count;
        result.component_type = accessor.componentType;
        // Every sum and product below is bounded by the one before, so none can wrap round.
        const std::size_t length = buffer.data.size();
        const bool view_fits = view.byteOffset <= length && view.byteLength <= length - view.byteOffset;
        const bool fits =
            view_fits && result.stride >= size && accessor.byteOffset <= view.byteLength &&
            size <= view.byteLength - accessor.byteOffset && accessor.count > 0 &&
            accessor.count - 1 <= (view.byteLength - accessor.byteOffset - size) / result.stride;
        if (!fits) {
            fail(key,
                 fmt::format("{} elements of {} bytes at {} of a view of {} bytes at {}", accessor.count,
                             size, accessor.byteOffset, view.byteLength, view.byteOffset),
                 fmt::format("elements inside the {} bytes of buffer {}", length, view.buffer),
                 static_cast<std::uint64_t>(view.byteOffset));
        }
        result.buffer_offset = view.byteOffset + accessor.byteOffset;
        result.first = buffer.data.data() + result.buffer_offset;
        return result;
    }

    void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& to_scene,
                       const std::string& key) {
        if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            primitive.mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            spdlog::warn("{}: {}: points and lines are left out", file_.string(), key);
            return;
        }
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) {
            fail(key, "no attribute POSITION", "positions", std::nullopt);
        }
        const Elements points =
            elements(position->second, TINYGLTF_TYPE_VEC3, {TINYGLTF_COMPONENT_TYPE_FLOAT});
        const std::size_t base = mesh_.vertices.size();
        if (points.count > std::numeric_limits<std::uint32_t>::max() - base) {
            fail(key, fmt::format("{} vertices", points.count), "fewer than 2^32 vertices", std::nullopt);
        }
        for (std::size_t i = 0; i < points.count; ++i) {
            const glm::dvec4 point(points.read<float>(i, 0), points.read<float>(i, 1),
                                   points.read<float>(i, 2), 1);
            const glm::dvec3 placed(to_scene * point);
            if (!std::isfinite(placed.x) || !std::isfinite(placed.y) || !std::isfinite(placed.z)) {
                fail(fmt::format("{} vertex {}", key, i),
                     fmt::format("({}, {}, {})", point.x, point.y, point.z), "finite coordinates",
                     static_cast<std::uint64_t>(points.buffer_offset + i * points.stride));
            }
            mesh_.vertices.push_back(placed);
        }

        Elements indices;
        indices.count = points.count;
        if (primitive.indices >= 0) {
            indices = elements(primitive.indices, TINYGLTF_TYPE_SCALAR,
                               {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                                TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT});
        }
        const auto vertex = [&](std::size_t i) {
            std::size_t index = i;
            switch (indices.component_type) {
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                index = indices.read<std::uint8_t>(i, 0);
                break;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                index = indices.read<std::uint16_t>(i, 0);
                break;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                index = indices.read<std::uint32_t>(i, 0);
                break;
            default: // no indices: the vertices in their order
                break;
            }
            if (index >= points.count) {
                fail(fmt::format("{} index {}", key, i), fmt::format("{}", index),
                     fmt::format("an index below {}", points.count),
                     static_cast<std::uint64_t>(indices.buffer_offset + i * indices.stride));
            }
            return static_cast<std::uint32_t>(base + index);
        };
        // A mirroring transform turns the sense of the triangles round; a strip's every second one is turned
        // already.
        const bool mirrored = glm::determinant(glm::dmat3(to_scene)) < 0;
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c, bool turned) {
            mesh_.triangles.emplace_back(vertex(a), vertex(turned != mirrored ? c : b),
                                         vertex(turned != mirrored ? b : c));
        };
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            for (std::size_t i = 0; i + 2 < indices.count; i += 3) {
                add(i, i + 1, i + 2, false);
            }
        } else {
            const bool fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
            for (std::size_t i = 0; i + 2 < indices.count; ++i) {
                add(fan ? 0 : i, i + 1, i + 2, !fan && i % 2 == 1);
            }
        }
    }

    const tinygltf::Model& model_;
    const std::filesystem::path& file_;
    FileMesh mesh_;
    std::vector<bool> visited_;
};

} // namespace

FileMesh read_gltf(const std::filesystem::path& file, const SourceLocation& mention) {
    const std::string bytes = read_file(file, mention);
    tinygltf::TinyGLTF loader;
    // Textures do not matter to the shape, and need not even exist.
    loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    bool loaded = false;
    if (bytes.size() > std::numeric_limits<unsigned int>::max()) {
        errors = "more than 4 GiB";
    } else {
        const unsigned int size = static_cast<unsigned int>(bytes.size());
        try {
            loaded = bytes.starts_with("glTF")
                         ? loader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                       reinterpret_cast<const unsigned char*>(bytes.data()),
                                                       size, file.parent_path().string())
                         : loader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), size,
                                                      file.parent_path().string());
        } catch (const std::exception& exception) { // of the JSON parser, on input that it does not foresee
            errors = exception.what();
        }
    }
    if (!warnings.empty()) {
        spdlog::warn("{}: {}", file.string(), warnings);
    }
    if (!loaded) {
        while (!errors.empty() && std::isspace(static_cast<unsigned char>(errors.back()))) {
            errors.pop_back();
        }
        // The parser's own message names the byte where it knows it.
        throw InputError({{file, 0, 0, {}},
                          "glTF",
                          errors.empty() ? "no valid glTF" : errors,
                          "a valid glTF 2.0 file",
                          "Export the file anew; it is damaged or truncated."});
    }
    return Reader(model, file).read();
}

} // namespace vkfv::specimen
