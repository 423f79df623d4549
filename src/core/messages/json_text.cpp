#include "core/messages/json_text.hpp"

#include "core/messages/safe_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace vkfv {

std::string json_text(const nlohmann::ordered_json& json, JsonLayout layout) {
    const std::string text = json.dump(layout == JsonLayout::indented ? 2 : -1, ' ', false,
                                       nlohmann::ordered_json::error_handler_t::replace);
    std::string result;
    result.reserve(text.size());
    for (std::string_view rest = text; !rest.empty();) {
        const Utf8Character character = first_character(rest);
        const std::size_t bytes = character.bytes > 0 ? character.bytes : 1;
        if (character.code >= 0x7f && is_unsafe_character(character.code)) { // only strings hold such characters
            result += fmt::format("\\u{:04x}", character.code);
        } else {
            result += rest.substr(0, bytes);
        }
        rest.remove_prefix(bytes);
    }
    return result;
}

} // namespace vkfv
