#include "specimen/gltf_document.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::specimen::gltf {
namespace {

constexpr double largest_integer = 9007199254740992.0; // 2^53: all integers up to it are doubles

// A value as in the file, shortened to fit into a message.
std::string shown(const Json& value) {
    if (value.is_structured()) {
        return fmt::format("{} of {}", value.is_array() ? "an array" : "an object", value.size());
    }
    return value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 40);
}

} // namespace

Object::Object(const Json& value, std::string name, const std::filesystem::path& file)
    : value_(&value), name_(std::move(name)), file_(&file) {
    if (!value.is_object()) {
        fail("", shown(value), "a JSON object");
    }
}

void Object::fail(const std::string& key, const std::string& found, const std::string& expected,
                  const std::string& remedy, std::optional<SourceLocation> where) const {
    const std::string dot = name_.empty() || key.empty() ? "" : ".";
    throw InputError({where.value_or(SourceLocation{.file = *file_}), name_ + dot + key, found, expected, remedy});
}

const Json* Object::find(const char* key) const {
    const auto found = value_->find(key);
    return found == value_->end() ? nullptr : &*found;
}

const Json* Object::find(const char* key, bool (Json::*is)() const noexcept, const char* expected) const {
    const Json* value = find(key);
    if (value && !(value->*is)()) {
        fail(key, shown(*value), expected);
    }
    return value;
}

std::uint64_t Object::integer_of(const Json& value, const std::string& key) const {
    const double number = value.is_number() ? value.get<double>() : -1;
    if (!(number >= 0 && number <= largest_integer && number == std::floor(number))) {
        fail(key, shown(value), "an integer, 0 or more");
    }
    return static_cast<std::uint64_t>(number);
}

std::optional<std::uint64_t> Object::integer(const char* key) const {
    const Json* value = find(key);
    return value ? std::optional(integer_of(*value, key)) : std::nullopt;
}

bool Object::boolean(const char* key) const {
    const Json* value = find(key, &Json::is_boolean, "true or false");
    return value && value->get<bool>();
}

const std::string* Object::string(const char* key) const {
    const Json* value = find(key, &Json::is_string, "a string");
    return value ? value->get_ptr<const std::string*>() : nullptr;
}

std::vector<std::string> Object::strings(const char* key) const {
    std::vector<std::string> result;
    if (const Json* values = find(key, &Json::is_array, "an array of strings")) {
        for (const Json& value : *values) {
            if (!value.is_string()) {
                fail(key, shown(value), "strings");
            }
            result.push_back(value.get<std::string>());
        }
    }
    return result;
}

std::vector<double> Object::numbers(const char* key) const {
    std::vector<double> result;
    if (const Json* values = find(key, &Json::is_array, "an array of numbers")) {
        for (const Json& value : *values) {
            if (!value.is_number() || !std::isfinite(value.get<double>())) {
                fail(key, shown(value), "finite numbers");
            }
            result.push_back(value.get<double>());
        }
    }
    return result;
}

std::vector<double> Object::numbers(const char* key, std::size_t count) const {
    auto result = numbers(key);
    if (has(key) && result.size() != count) {
        fail(key, fmt::format("{} numbers", result.size()), fmt::format("{} numbers", count));
    }
    return result;
}

std::vector<std::uint64_t> Object::integers(const char* key) const {
    std::vector<std::uint64_t> result;
    if (const Json* values = find(key, &Json::is_array, "an array of integers")) {
        for (const Json& value : *values) {
            result.push_back(integer_of(value, key));
        }
    }
    return result;
}

std::optional<Object> Object::object(const char* key) const {
    const Json* value = find(key, &Json::is_object, "a JSON object");
    return value ? std::optional(Object(*value, name_.empty() ? key : name_ + "." + key, *file_)) : std::nullopt;
}

std::vector<Object> Object::objects(const char* key) const {
    std::vector<Object> result;
    if (const Json* values = find(key, &Json::is_array, "an array")) {
        for (const Json& value : *values) {
            result.emplace_back(value, fmt::format("{}{}{}[{}]", name_, name_.empty() ? "" : ".", key, result.size()),
                                *file_);
        }
    }
    return result;
}

std::uint64_t Object::needed_integer(const char* key) const {
    const auto value = integer(key);
    if (!value) {
        fail(key, "nothing", "an integer, 0 or more");
    }
    return *value;
}

Object Object::needed_object(const char* key) const {
    const auto value = object(key);
    if (!value) {
        fail(key, "nothing", "a JSON object");
    }
    return *value;
}

} // namespace vkfv::specimen::gltf
