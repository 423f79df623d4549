#include "specimen/gltf_document.hpp"

#include "core/file.hpp"
#include "core/json_depth.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace vkfv::specimen::gltf {
namespace {

// Chunks of the binary container.
constexpr std::string_view binary_magic = "glTF";
constexpr std::uint64_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t container_version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

// They say how a surface looks or what it is called, never where it is: the triangles are the same without them.
constexpr std::array of_appearance = {
    "KHR_lights_punctual", "KHR_texture_basisu", "KHR_texture_transform", "KHR_xmp", "KHR_xmp_json_ld",
    "EXT_lights_image_based", "EXT_lights_ies", "EXT_texture_avif", "EXT_texture_webp", "MSFT_texture_dds",
    "MSFT_packing_normalRoughnessMetallic", "MSFT_packing_occlusionRoughnessMetallic", "KHR_materials_anisotropy",
    "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission", "KHR_materials_dispersion",
    "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness", "KHR_materials_sheen", "KHR_materials_specular", "KHR_materials_transmission",
    "KHR_materials_unlit", "KHR_materials_variants", "KHR_materials_volume"};
constexpr std::array of_geometry = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization"};
constexpr std::array of_compression = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"};

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

// "2.0"
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
    check_uris();
    load_buffers();
}

Document::~Document() = default;

std::string_view Document::json_of_container() {
    const std::string_view all = bytes_;
    if (!all.starts_with(binary_magic)) {
        return all.starts_with(byte_order_mark) ? all.substr(byte_order_mark.size()) : all;
    }
    const auto fail = [&](std::uint64_t offset, const std::string& found, const std::string& expected) {
        throw InputError({{.file = file_, .byte_offset = offset}, "glTF", found, expected,
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
            fail(at, fmt::format("a chunk of {} bytes", size), fmt::format("at most the {} that are left", length - start));
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
    } catch (const Json::exception& error) { // a number that no double holds
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
    // What asks for no least version can be read by all readers of its major one.
    if (least && (least->major != 2 || least->minor != 0)) {
        asset.fail("minVersion", fmt::format("{}.{}", least->major, least->minor), "glTF 2.0, which is all that is known here",
                   remedy);
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
    (void)item("buffers", "buffer", index);
    return buffers_[index];
}

// Files beside the document alone: others mean nothing on another machine, and no network is asked.
void Document::check_uris() const {
    for (std::uint64_t index = 0; index < count("buffers"); ++index) {
        const Object description = item("buffers", "buffer", index);
        (void)description.needed_integer("byteLength");
        const std::string* uri = description.string("uri");
        if (!uri && (index != 0 || binary_chunk_.data() == nullptr)) {
            description.fail("uri", "nothing", "a file, or as the first buffer the bytes within a .glb",
                             "Export the file anew, without compression of its meshes.");
        }
        if (uri && !is_data_uri(*uri) && !is_relative_path(*uri)) {
            description.fail("uri", '"' + uri->substr(0, 80) + '"', "a relative path or a data URI",
                             "Put the buffer beside the glTF file, or export as .glb.");
        }
    }
}

namespace {

// The files of buffers, which tinygltf asks for in their order and before any image. Textures do not matter to the shape, and
// need not even exist.
struct BufferFiles {
    std::string owner;
    std::size_t expected = 0;
    std::vector<std::filesystem::path> read;
    std::optional<InputError> failure;

    bool all_read() const { return read.size() == expected; }
    bool load(std::vector<unsigned char>& bytes, const std::filesystem::path& path) {
        try {
            const std::string content = read_file(
                path, {.key = fmt::format("{}: file {} of its buffers", owner, read.size()),
                       .expected = "the file of a buffer",
                       .remedy = "Put the file beside the glTF file that names it, or export as .glb."});
            bytes.assign(content.begin(), content.end());
        } catch (const InputError& error) {
            failure = error;
            return false;
        }
        read.push_back(path);
        return true;
    }
};

BufferFiles& files_of(void* user) {
    return *static_cast<BufferFiles*>(user);
}

tinygltf::FsCallbacks callbacks_for(BufferFiles& files) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string&, void* user) { return !files_of(user).all_read(); };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string*, const std::string& path, void* user) {
        return !files_of(user).all_read() && files_of(user).load(*bytes, path);
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = &files;
    return callbacks;
}

} // namespace

void Document::load_buffers() {
    BufferFiles files{.owner = file_.string(), .expected = 0, .read = {}, .failure = {}};
    std::vector<const std::string*> uris;
    for (std::uint64_t index = 0; index < count("buffers"); ++index) {
        uris.push_back(item("buffers", "buffer", index).string("uri"));
        files.expected += uris.back() && !is_data_uri(*uris.back()) ? 1 : 0;
    }
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks_for(files));
    loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                             void*) { return true; },
                          nullptr);
    model_ = std::make_unique<tinygltf::Model>();
    std::string errors, warnings;
    bool loaded = false;
    if (bytes_.size() > std::numeric_limits<unsigned int>::max()) {
        errors = "more than 4 GiB";
    } else {
        const auto size = static_cast<unsigned int>(bytes_.size());
        const std::string folder = file_.parent_path().string();
        try {
            loaded = json_start_ ? loader.LoadBinaryFromMemory(model_.get(), &errors, &warnings,
                                                               reinterpret_cast<const unsigned char*>(bytes_.data()), size,
                                                               folder)
                                 : loader.LoadASCIIFromString(model_.get(), &errors, &warnings, bytes_.data(), size, folder);
        } catch (const std::exception& exception) { // of its JSON parser, on input that it does not foresee
            errors = exception.what();
        }
    }
    if (files.failure) {
        throw InputError(*files.failure);
    }
    if (!loaded || model_->buffers.size() != uris.size()) {
        while (!errors.empty() && std::isspace(static_cast<unsigned char>(errors.back()))) {
            errors.pop_back();
        }
        throw InputError({{.file = file_}, "glTF", errors.empty() ? "no valid glTF" : errors, "a valid glTF 2.0 file",
                          "Export the file anew; it is damaged, truncated or no glTF."});
    }
    std::size_t external = 0;
    for (std::size_t index = 0; index < uris.size(); ++index) {
        const auto& data = model_->buffers[index].data;
        Buffer buffer{.bytes = {reinterpret_cast<const char*>(data.data()), data.size()}, .file = file_, .offset = {}};
        if (!uris[index]) {
            buffer.offset = static_cast<std::uint64_t>(binary_chunk_.data() - bytes_.data());
        } else if (!is_data_uri(*uris[index])) {
            buffer.file = files.read[external++];
            buffer.offset = 0;
        }
        buffers_.push_back(std::move(buffer));
    }
}

} // namespace vkfv::specimen::gltf
