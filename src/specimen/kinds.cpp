#include "specimen/kinds.hpp"

#include "core/keys/section.hpp"

#include <type_traits>
#include <utility>
#include <variant>

namespace vkfv::specimen {
namespace {

template <class OneKind>
Kind said_of() {
    return {.name = OneKind::name,
            .meaning = OneKind::meaning,
            .keys = OneKind::keys(),
            .read = [](const Section& section) -> Shape { return OneKind::read(section); },
            .takes_roughness = !MeshKind<OneKind>};
}

template <std::size_t... places>
std::vector<Kind> list(std::index_sequence<places...>) {
    return {said_of<std::variant_alternative_t<places, Shape>>()...};
}

} // namespace

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = list(std::make_index_sequence<std::variant_size_v<Shape>>());
    return all;
}

std::filesystem::path file_of(const Shape& shape) {
    return std::visit(
        [](const auto& kind) -> std::filesystem::path {
            if constexpr (requires { kind.file; }) {
                return kind.file;
            } else {
                return {};
            }
        },
        shape);
}

double size_of(const Shape& shape) {
    return std::visit(
        [](const auto& kind) -> double {
            if constexpr (requires { kind.size; }) {
                return kind.size;
            } else {
                return 0;
            }
        },
        shape);
}

std::optional<dimensions::Feature> feature_of(const Shape& shape) {
    return std::visit(
        [](const auto& kind) -> std::optional<dimensions::Feature> {
            if constexpr (requires { kind.feature(); }) {
                return kind.feature();
            } else {
                return std::nullopt;
            }
        },
        shape);
}

surface::Form usual_form(const Shape& shape) {
    const bool has_heights = std::visit(
        [](const auto& kind) {
            if constexpr (requires { kind.feature(); }) {
                return !std::is_same_v<decltype(kind.feature()), dimensions::Flat>;
            } else {
                return false;
            }
        },
        shape);
    return {.kind = has_heights ? surface::Form::Kind::truth : surface::Form::Kind::plane};
}

Shape with_pitch(Shape shape, double pitch) {
    std::visit(
        [pitch](auto& kind) {
            if constexpr (requires { kind.pitch; }) {
                kind.pitch = pitch;
            }
        },
        shape);
    return shape;
}

} // namespace vkfv::specimen
