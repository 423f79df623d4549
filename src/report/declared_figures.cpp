#include "report/declared_figures.hpp"

#include "core/mathematics/units.hpp"
#include "report/page_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace vkfv::report {

namespace {

using Json = nlohmann::ordered_json;

// How a declared unit is spelled in keys, and the factor to it from the unit that vkfv computes in (mm, rad). Only
// units with another spelling or a factor are listed.
struct Unit {
    std::string_view declared;
    std::string_view in_keys;
    double factor;
};
constexpr std::array<Unit, 7> units = {{{"um", "um", um_per_mm},
                                        {"um3/um2", "um3_per_um2", um_per_mm},
                                        {"deg", "deg", 1 / radians_per_degree},
                                        {"%", "percent", 100},
                                        {"1/mm2", "per_mm2", 1},
                                        {"1/mm", "per_mm", 1},
                                        {"1", "", 1}}};

Unit unit_of(std::string_view declared) {
    const auto known = std::ranges::find(units, declared, &Unit::declared);
    return known == units.end() ? Unit{declared, declared, 1} : *known;
}

const Json& schema(const std::string& name) {
    static const auto all = [] {
        std::map<std::string, Json> read;
        for (const char* each : {"results", "sweep", "image"}) {
            read[each] = Json::parse(page_file(fmt::format("{}.schema.json", each)));
        }
        return read;
    }();
    return all.at(name);
}

// A property of a schema, or the whole schema.
class Declaration {
  public:
    Declaration(const Json& root, const Json& node) : root_(&root), node_(&node) { follow(); }

    std::string_view title() const { return title_; }
    // Members without a unit have that of the whole, such as measured and true value of a parameter.
    std::string_view unit() const { return unit_; }

    // A member by its name, with its key; none: the schema does not declare it.
    std::optional<std::pair<std::string, Declaration>> member(std::string_view name) const {
        const auto members = node_->find("properties");
        if (members == node_->end()) {
            return std::nullopt;
        }
        for (const auto& [key, node] : members->items()) {
            if (key.starts_with(name)) {
                Declaration declared(*root_, node);
                const std::string_view suffix = unit_of(declared.unit_).in_keys,
                                       rest = std::string_view(key).substr(name.size());
                if (rest.empty() || rest == fmt::format("_{}", suffix) || rest == fmt::format(" / {}", suffix)) {
                    declared.unit_ = declared.unit_.empty() ? unit_ : declared.unit_;
                    return std::pair(key, declared);
                }
            }
        }
        return std::nullopt;
    }

  private:
    // Follows references, and goes to the items of a list. The first unit and title on this way count.
    void follow() {
        while (true) {
            unit_ = unit_.empty() ? text("unit") : unit_;
            title_ = title_.empty() ? text("title") : title_;
            if (const auto reference = text("$ref"); !reference.empty()) {
                node_ = &root_->at(Json::json_pointer(std::string(reference.substr(1))));
            } else if (const auto items = node_->find("items"); items != node_->end()) {
                node_ = &*items;
            } else {
                return;
            }
        }
    }

    std::string_view text(const char* keyword) const {
        const auto found = node_->find(keyword);
        return found == node_->end() ? std::string_view() : std::string_view(found->get_ref<const std::string&>());
    }

    const Json* root_;
    const Json* node_;
    std::string_view unit_, title_;
};

std::pair<std::string, Declaration> member(const Declaration& object, std::string_view name, std::string_view place) {
    auto found = object.member(name);
    if (!found) {
        throw std::logic_error(fmt::format("assets/schemas declares no {} in {}", name, place));
    }
    return std::move(*found);
}

Declaration object_at(std::string_view place) {
    auto end = std::min(place.find('.'), place.size());
    const Json& root = schema(std::string(place.substr(0, end)));
    Declaration object(root, root);
    while (end < place.size()) {
        const auto begin = end + 1;
        end = std::min(place.find('.', begin), place.size());
        object = member(object, place.substr(begin, end - begin), place).second;
    }
    return object;
}

Json written(const Declaration& declared, const Json& value, std::string_view place) {
    Json result = value;
    if (value.is_object()) {
        result = Json::object();
        for (const auto& [name, figure] : value.items()) {
            const auto [key, of_figure] = member(declared, name, place);
            result[key] = written(of_figure, figure, place);
        }
    } else if (value.is_array()) {
        std::ranges::transform(value, result.begin(), [&](const Json& item) { return written(declared, item, place); });
    } else if (value.is_number_float()) {
        result = value.get<double>() * unit_of(declared.unit()).factor;
    }
    return result;
}

} // namespace

DeclaredFigure declared_figure(std::string_view place, std::string_view name) {
    const auto [key, declared] = member(object_at(place), name, place);
    const Unit unit = unit_of(declared.unit());
    return {
        .key = key, .title = std::string(declared.title()), .unit = std::string(unit.in_keys), .factor = unit.factor};
}

Json as_declared(std::string_view place, const Json& figures) {
    return written(object_at(place), figures, place);
}

} // namespace vkfv::report
