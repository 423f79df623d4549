// Kinds of specimens as tests describe them.
#pragma once

#include "specimen/kinds.hpp"

#include <filesystem>
#include <string>
#include <variant>

namespace vkfv::test {

// A specimen of a kind over a square.
template <class Kind>
Kind over(double size, double pitch) {
    Kind kind;
    kind.size = size;
    kind.pitch = pitch;
    return kind;
}

// The shape, represented as facets or as a function where it has a choice.
inline specimen::Shape represented(specimen::Shape shape, specimen::Representation representation) {
    std::visit(
        [&](auto& kind) {
            if constexpr (requires { kind.representation; }) {
                kind.representation = representation;
            }
        },
        shape);
    return shape;
}

// A kind by its name, with its file and else nothing but what it needs.
inline specimen::Shape shape_of(const std::filesystem::path& file, const std::string& kind) {
    for (const specimen::Shape& of_any : {specimen::Shape(specimen::Stl()), specimen::Shape(specimen::Gltf()),
                                          specimen::Shape(specimen::Image{.pitch = 0.001, .height = 0.001})}) {
        if (specimen::kinds()[of_any.index()].name == kind) {
            specimen::Shape shape = of_any;
            std::visit(
                [&](auto& one) {
                    if constexpr (requires { one.file; }) {
                        one.file = file;
                    }
                },
                shape);
            return shape;
        }
    }
    return {};
}

} // namespace vkfv::test
