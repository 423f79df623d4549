// What a glTF 2.0 file says, asked for value by value: tinygltf reads the buffers, but takes what is of a wrong
// kind elsewhere for something left out. Every getter checks type and range, so that nothing of a wrong kind
// passes for something left out: what is wrong becomes an InputError that names the value ("node 3.matrix").
#pragma once

#include "core/messages/error.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::specimen::gltf {

using Json = nlohmann::json;

// A JSON object of the document, and its name in messages. Refers to the document, which outlives it.
class Object {
  public:
    Object(const Json& value, std::string name, const std::filesystem::path& file);

    const std::string& name() const { return name_; }
    bool has(const char* key) const { return value_->contains(key); }

    // Getters of values that may be missing.
    std::optional<std::uint64_t> integer(const char* key) const; // not negative, below 2^53; 3.0 is one too
    bool boolean(const char* key) const;                         // false without
    const std::string* string(const char* key) const;            // null without
    std::vector<std::string> strings(const char* key) const;
    std::vector<double> numbers(const char* key) const;                    // finite
    std::vector<double> numbers(const char* key, std::size_t count) const; // either none or as many
    std::vector<std::uint64_t> integers(const char* key) const;
    std::optional<Object> object(const char* key) const;
    std::vector<Object> objects(const char* key) const;

    // Those that must be there.
    std::uint64_t needed_integer(const char* key) const;
    Object needed_object(const char* key) const;

    // Throws.
    [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected,
                           const std::string& remedy = "Export the file anew; it is damaged or unusual.",
                           std::optional<SourceLocation> where = {}) const;

  private:
    const Json* find(const char* key) const;
    const Json* find(const char* key, bool (Json::*is)() const noexcept, const char* expected) const;
    std::uint64_t integer_of(const Json& value, const std::string& key) const;

    const Json* value_;
    std::string name_;
    const std::filesystem::path* file_;
};

// A buffer's bytes, and where they lie, for messages.
struct Buffer {
    std::string_view bytes;
    std::filesystem::path file;
    std::optional<std::uint64_t> offset; // in that file; none: in a data URI
};

class Document {
  public:
    // Of a .gltf's text or of a whole .glb. Checks the container, the version and the required extensions. Throws
    // InputError.
    Document(std::string bytes, std::filesystem::path file);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    const std::filesystem::path& file() const { return file_; }
    Object root() const;
    bool uses(std::string_view extension) const; // declared as used or required

    // The index-th of a list of the root ("nodes"), called `name` ("node 3"). Throws InputError beyond the list's end.
    std::size_t count(const char* list) const;
    Object item(const char* list, const std::string& name, std::uint64_t index) const;

    // Of a regular file beside the document, of a data URI or of the .glb; read when it is first asked for, so that
    // what no triangle needs need not exist. As long as its byteLength, or InputError.
    const Buffer& buffer(std::uint64_t index) const;

  private:
    std::string_view json_of_container();
    void parse(std::string_view text);
    void check_version() const;
    void check_extensions();
    void load(std::uint64_t index, Buffer& buffer, std::vector<unsigned char>& owned) const;

    std::string bytes_;
    std::filesystem::path file_;
    Json json_;
    std::string_view binary_chunk_;
    std::optional<std::uint64_t> json_start_; // in a .glb
    std::vector<std::string> extensions_;
    struct Loaded {
        Buffer buffer;
        std::vector<unsigned char> owned; // what it views, unless that is in the .glb
    };
    mutable std::map<std::uint64_t, Loaded> buffers_;
    mutable std::uint64_t loaded_bytes_ = 0; // beside the .glb's
};

} // namespace vkfv::specimen::gltf
