// Access to a glTF 2.0 file value by value: tinygltf reads only the buffers, because elsewhere it treats a value of a
// wrong type as missing. Every getter checks type and range; a wrong value is an InputError that names it ("node
// 3.matrix").
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

// A JSON object of the document with its name for messages. It refers to the document, which must outlive it.
class Object {
  public:
    Object(const Json& value, std::string name, const std::filesystem::path& file);

    const std::string& name() const { return name_; }
    bool has(const char* key) const { return value_->contains(key); }

    // Getters of optional values.
    std::optional<std::uint64_t> integer(const char* key) const; // none if missing; >= 0, below 2^53; 3.0 counts too
    bool boolean(const char* key) const;                         // false if missing
    const std::string* string(const char* key) const;            // null if missing
    std::vector<std::string> strings(const char* key) const;
    std::vector<double> numbers(const char* key) const;                    // finite numbers
    std::vector<double> numbers(const char* key, std::size_t count) const; // either empty or of size `count`
    std::vector<std::uint64_t> integers(const char* key) const;
    std::optional<Object> object(const char* key) const;
    std::vector<Object> objects(const char* key) const;

    // Getters of required values.
    std::uint64_t needed_integer(const char* key) const;
    Object needed_object(const char* key) const;

    // Throws an InputError about the value of `key`.
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

// The bytes of a buffer, and their place in a file for messages.
struct Buffer {
    std::string_view bytes;
    std::filesystem::path file;
    std::optional<std::uint64_t> offset; // byte offset in `file`; none: a data URI
};

class Document {
  public:
    // Parses a .gltf's text or a whole .glb; checks the container, the version and the required extensions. Throws
    // InputError.
    Document(std::string bytes, std::filesystem::path file);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    const std::filesystem::path& file() const { return file_; }
    Object root() const;
    bool uses(std::string_view extension) const; // true if declared as used or required

    // An element of a root list such as "nodes", with `name` for messages ("node 3"). Throws InputError if the index
    // exceeds the list.
    std::size_t count(const char* list) const;
    Object item(const char* list, const std::string& name, std::uint64_t index) const;

    // The content of a buffer from a regular file beside the document, a data URI or the .glb. It is read at the first
    // call, so that buffers that no triangle needs may be missing. Its length is its byteLength, else InputError.
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
    std::optional<std::uint64_t> json_start_; // byte offset of the JSON in a .glb
    std::vector<std::string> extensions_;
    struct Loaded {
        Buffer buffer;
        std::vector<unsigned char> owned; // storage of the buffer, unless it is in the .glb
    };
    mutable std::map<std::uint64_t, Loaded> buffers_;
    mutable std::uint64_t loaded_bytes_ = 0; // without the .glb itself
};

} // namespace vkfv::specimen::gltf
