#include "specimen/gltf_document.hpp"

#include "core/files/file.hpp"
#include "core/parsing/json_depth.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace vkfv::specimen::gltf {
namespace {

// Constants of the binary container and its chunks.
constexpr std::string_view binary_magic = "glTF";
constexpr std::uint64_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t container_version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

// Extensions about appearance and names, never about geometry: the triangles are the same without them.
constexpr std::array of_appearance = {"KHR_lights_punctual",
                                      "KHR_texture_basisu",
                                      "KHR_texture_transform",
                                      "KHR_xmp",
                                      "KHR_xmp_json_ld",
                                      "EXT_lights_image_based",
                                      "EXT_lights_ies",
                                      "EXT_texture_avif",
                                      "EXT_texture_webp",
                                      "MSFT_texture_dds",
                                      "MSFT_packing_normalRoughnessMetallic",
                                      "MSFT_packing_occlusionRoughnessMetallic",
                                      "KHR_materials_anisotropy",
                                      "KHR_materials_clearcoat",
                                      "KHR_materials_diffuse_transmission",
                                      "KHR_materials_dispersion",
                                      "KHR_materials_emissive_strength",
                                      "KHR_materials_ior",
                                      "KHR_materials_iridescence",
                                      "KHR_materials_pbrSpecularGlossiness",
                                      "KHR_materials_sheen",
                                      "KHR_materials_specular",
                                      "KHR_materials_transmission",
                                      "KHR_materials_unlit",
                                      "KHR_materials_variants",
                                      "KHR_materials_volume"};
constexpr std::array of_geometry = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization"};
constexpr std::array of_compression = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                       "KHR_meshopt_compression"};

std::uint32_t word_at(std::string_view bytes, std::uint64_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

bool is_relative_path(std::string_view uri) {
    const auto colon = uri.find(':');
    return !uri.empty() && !uri.starts_with('/') && !uri.starts_with('\\') &&
           (colon == std::string_view::npos || colon > uri.find('/'));
}

struct Version {
    int major = 0, minor = 0;
};

// Parses a version such as "2.0".
std::optional<Version> version_of(const std::string& text) {
    Version version;
    const char* end = text.data() + text.size();
    const auto [point, error] = std::from_chars(text.data(), end, version.major);
    if (error != std::errc() || point == end || *point != '.') {
        return std::nullopt;
    }
    const auto [last, minor_error] = std::from_chars(point + 1, end, version.minor);
    return minor_error == std::errc() && last == end ? std::optional(version) : std::nullopt;
}

} // namespace

Document::Document(std::string bytes, std::filesystem::path file) : bytes_(std::move(bytes)), file_(std::move(file)) {
    parse(json_of_container());
    check_version();
    check_extensions();
}

std::string_view Document::json_of_container() {
    const std::string_view all = bytes_;
    if (!all.starts_with(binary_magic)) {
        return all.starts_with(byte_order_mark) ? all.substr(byte_order_mark.size()) : all;
    }
    const auto fail = [&](std::uint64_t offset, const std::string& found, const std::string& expected) {
        throw InputError({{.file = file_, .byte_offset = offset},
                          "glTF",
                          found,
                          expected,
                          "Export or copy the file anew; it is damaged or truncated."});
    };
    if (all.size() < header_bytes + chunk_header_bytes) {
        fail(all.size(), fmt::format("{} bytes", all.size()), "a binary glTF's header and its JSON");
    }
    if (const auto version = word_at(all, 4); version != container_version) {
        fail(4, fmt::format("a binary container of version {}", version), "version 2, that of glTF 2.0");
    }
    const std::uint64_t length = word_at(all, 8);
    if (length > all.size()) {
        fail(8, fmt::format("{} bytes in a file of {}", length, all.size()), "a file as long as its header says");
    }
    std::string_view json;
    for (std::uint64_t at = header_bytes; at + chunk_header_bytes <= length;) {
        const std::uint64_t size = word_at(all, at);
        const std::uint32_t type = word_at(all, at + 4);
        const std::uint64_t start = at + chunk_header_bytes;
        if (size > length - start) {
            fail(at, fmt::format("a chunk of {} bytes", size),
                 fmt::format("at most the {} that are left", length - start));
        }
        const bool first = at == header_bytes;
        if (first != (type == json_chunk)) {
            fail(at + 4, first ? "another chunk" : "another chunk of JSON", "one chunk of JSON, the first");
        }
        if (first) {
            json = all.substr(start, size);
            json_start_ = start;
        } else if (type == binary_chunk && binary_chunk_.data() == nullptr) {
            binary_chunk_ = all.substr(start, size);
        }
        at = start + size;
    }
    return json;
}

void Document::parse(std::string_view text) {
    check_json_depth(text, file_, json_start_);
    SourceLocation where{.file = file_, .byte_offset = json_start_};
    std::string reason = "no JSON object";
    try {
        json_ = Json::parse(text);
    } catch (const Json::parse_error& error) {
        const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
        if (json_start_) {
            where.byte_offset = *json_start_ + byte;
        } else {
            const TextPlace place = place_in(text, byte);
            where.line = place.line;
            where.column = place.column;
        }
        reason = byte >= text.size() ? "the end of the JSON text" : "no valid JSON from here on";
    } catch (const Json::exception& error) { // a number beyond double's range
        reason = error.what();
    }
    if (!json_.is_object()) {
        throw InputError({where, "glTF", reason, "a valid glTF 2.0 file",
                          "Export the file anew; it is damaged, truncated or no glTF."});
    }
}

Object Document::root() const {
    return {json_, "", file_};
}

void Document::check_version() const {
    const Object asset = root().needed_object("asset");
    constexpr const char* remedy = "Export the file as glTF 2.0.";
    const auto read = [&](const char* key) -> std::optional<Version> {
        const std::string* text = asset.string(key);
        const auto version = text ? version_of(*text) : std::nullopt;
        if (text && !version) {
            asset.fail(key, '"' + *text + '"', "a version as \"2.0\"", remedy);
        }
        return version;
    };
    const auto version = read("version");
    const auto least = read("minVersion");
    if (!version) {
        asset.fail("version", "nothing", "the version of glTF, \"2.0\"", remedy);
    }
    // A file without minVersion can be read by all readers of its major version.
    if (least && (least->major != 2 || least->minor != 0)) {
        asset.fail("minVersion", fmt::format("{}.{}", least->major, least->minor),
                   "glTF 2.0, which is all that is known here", remedy);
    }
    if (!least && version->major != 2) {
        asset.fail("version", fmt::format("{}.{}", version->major, version->minor), "glTF 2.0", remedy);
    }
}

void Document::check_extensions() {
    extensions_ = root().strings("extensionsUsed");
    for (const std::string& name : root().strings("extensionsRequired")) {
        extensions_.push_back(name);
        const auto among = [&](const auto& names) { return std::ranges::find(names, name) != names.end(); };
        if (among(of_compression)) {
            root().fail("extensionsRequired", '"' + name + '"', "triangles that are not compressed",
                        "Export the file without compression of its meshes.");
        }
        if (!among(of_appearance) && !among(of_geometry)) {
            root().fail("extensionsRequired", '"' + name + '"',
                        fmt::format("{}, {} or extensions of materials and textures", of_geometry[0], of_geometry[1]),
                        "Export the file without this extension: without it the shape may be another.");
        }
    }
}

bool Document::uses(std::string_view extension) const {
    return std::ranges::find(extensions_, extension) != extensions_.end();
}

std::size_t Document::count(const char* list) const {
    const auto found = json_.find(list);
    if (found == json_.end()) {
        return 0;
    }
    if (!found->is_array()) {
        root().fail(list, found->type_name(), "an array");
    }
    return found->size();
}

Object Document::item(const char* list, const std::string& name, std::uint64_t index) const {
    if (const std::size_t items = count(list); index >= items) {
        root().fail(name, fmt::format("{}", index), fmt::format("an index below {}", items));
    }
    return {json_[list][index], fmt::format("{} {}", name, index), file_};
}

const Buffer& Document::buffer(std::uint64_t index) const {
    auto found = buffers_.find(index);
    if (found == buffers_.end()) {
        Buffer buffer;
        std::vector<unsigned char> owned;
        load(index, buffer, owned);
        found = buffers_.emplace(index, Loaded{buffer, std::move(owned)}).first;
        if (!found->second.owned.empty()) {
            found->second.buffer.bytes = {reinterpret_cast<const char*>(found->second.owned.data()),
                                          found->second.owned.size()};
        }
    }
    return found->second.buffer;
}

namespace {

// A limit is needed because a few kilobytes may name one file many times.
constexpr std::uint64_t most_buffer_bytes = std::uint64_t{1} << 32;

// The request for a buffer's file, which tinygltf passes to read_buffer_file().
struct BufferFile {
    FileRequest request;
    std::uint64_t length;
    std::filesystem::path path{};
    std::optional<InputError> failure{};
};

// Reads a buffer's file for tinygltf; `user` points to a BufferFile.
bool read_buffer_file(std::vector<unsigned char>* bytes, std::string*, const std::string& path, void* user) {
    auto& file = *static_cast<BufferFile*>(user);
    try {
        file.path = path;
        const InputFile input(path, file.request);
        if (input.bytes() < file.length) {
            throw InputError({{.file = path},
                              file.request.key,
                              fmt::format("{} bytes, of which {} are there", file.length, input.bytes()),
                              "a buffer as long as it says",
                              "Export or copy the files anew; this one is truncated."});
        }
        const std::string content = input.read(file.length);
        bytes->assign(content.begin(), content.end());
        return true;
    } catch (const InputError& error) {
        file.failure = error;
        return false;
    }
}

tinygltf::FsCallbacks callbacks_for(BufferFile& file) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string&, void*) { return true; }; // a missing file is reported when it is read
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = read_buffer_file;
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = &file;
    return callbacks;
}

} // namespace

void Document::load(std::uint64_t index, Buffer& buffer, std::vector<unsigned char>& owned) const {
    const Object description = item("buffers", "buffer", index);
    const std::uint64_t length = description.needed_integer("byteLength");
    const std::string* uri = description.string("uri");
    buffer = {.bytes = {}, .file = file_, .offset = {}};
    if (!uri) {
        if (index != 0 || binary_chunk_.data() == nullptr) {
            description.fail("uri", "nothing", "a file, or as the first buffer the bytes within a .glb",
                             "Export the file anew, without compression of its meshes.");
        }
        if (binary_chunk_.size() < length) {
            description.fail("byteLength", fmt::format("{} bytes, of which {} are there", length, binary_chunk_.size()),
                             "a buffer as long as it says", "Export or copy the file anew; this one is truncated.");
        }
        buffer.bytes = binary_chunk_.substr(0, length);
        buffer.offset = static_cast<std::uint64_t>(binary_chunk_.data() - bytes_.data());
        return;
    }
    // Only files beside the document are read: others mean nothing on another machine, and no network is used.
    if (!is_data_uri(*uri) && !is_relative_path(*uri)) {
        description.fail("uri", '"' + uri->substr(0, 80) + '"', "a relative path or a data URI",
                         "Put the buffer beside the glTF file, or export as .glb.");
    }
    if (loaded_bytes_ += length; length > most_buffer_bytes || loaded_bytes_ > most_buffer_bytes) {
        description.fail("byteLength", fmt::format("{} bytes", length),
                         fmt::format("at most {} bytes of buffers in all", most_buffer_bytes));
    }
    const std::string key = fmt::format("{}: {}", file_.string(), description.name());
    BufferFile file{.request = {.key = key + ".uri",
                                .expected = "the file of a buffer",
                                .remedy = "Put the file beside the glTF file that names it, or export as .glb."},
                    .length = length};
    // The buffer is loaded in a document of its own, so that tinygltf reads or refuses nothing else.
    const std::string text =
        Json{{"asset", {{"version", "2.0"}}}, {"buffers", Json::array({json_["buffers"][index]})}}.dump();
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks_for(file));
    tinygltf::Model model;
    std::string errors, warnings;
    const bool loaded =
        text.size() <= std::numeric_limits<unsigned int>::max() &&
        loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), static_cast<unsigned int>(text.size()),
                                   file_.parent_path().string());
    if (file.failure) {
        throw InputError(*file.failure);
    }
    if (!loaded || model.buffers.size() != 1 || model.buffers[0].data.size() != length) {
        description.fail("uri", '"' + uri->substr(0, 40) + "...\"",
                         fmt::format("a data URI of {} bytes in whole base64 digits", length));
    }
    owned = std::move(model.buffers[0].data);
    if (!is_data_uri(*uri)) {
        buffer.file = file.path;
        buffer.offset = 0;
    }
}

} // namespace vkfv::specimen::gltf
