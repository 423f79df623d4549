// JSON documents as text that is valid and safe to show, whatever their strings contain.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace vkfv {

// The JSON text of a document, with two blanks for each level, or in one line, without an end of line. Bytes that are
// not UTF-8 become U+FFFD, and characters that a terminal obeys are escaped.
enum class JsonLayout { indented, one_line };
std::string json_text(const nlohmann::ordered_json& json, JsonLayout layout = JsonLayout::indented);

} // namespace vkfv
