#include "report/markup.hpp"

#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"

namespace vkfv::report {

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : safe_text(text)) { // XML allows no control characters but tabs and ends of lines
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string page_json(const nlohmann::ordered_json& json) {
    std::string text;
    for (const char c : json_text(json, JsonLayout::one_line)) {
        switch (c) {
        case '<':
            text += "\\u003c";
            break;
        case '>':
            text += "\\u003e";
            break;
        case '&':
            text += "\\u0026";
            break;
        default:
            text += c;
        }
    }
    return text;
}

} // namespace vkfv::report
