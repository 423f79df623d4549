// The table [[mesh_element]]: its keys and its reader.
#include "configuration/optical_parts.hpp"
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/files/digest.hpp"
#include "specimen/files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <span>

namespace vkfv {

namespace {

using optics::MeshElement;

constexpr double mm_per_gltf_unit = 1e3; // glTF 2.0 lengths are metres
constexpr double largest_coordinate = 1e6;

const ChoiceKey<MeshElement::Kind> mesh_kind = for_example(
    "\"glass\"",
    ChoiceKey<MeshElement::Kind>("kind",
                                 {{MeshElement::Kind::glass, "glass", "a closed body that refracts"},
                                  {MeshElement::Kind::mirror, "mirror", "reflects on both sides"},
                                  {MeshElement::Kind::absorber, "absorber", "stops all light: a mount, a baffle"}},
                                 needed, "What the facets do to light."));
const FileKey mesh_file =
    for_example("\"prism.stl\"", FileKey("file", Default::none(), "The mesh: an STL or glTF file. Facets are flat."));
const ChoiceKey<double> mesh_unit = [] {
    ChoiceKey<double> key("unit", {{1.0, "mm"}, {1e-3, "um"}, {1e3, "m"}, {25.4, "inch"}}, needed,
                          "Of the file's lengths.");
    key.fallback = Default::in_words("mm for STL, m for glTF");
    return key;
}();
const TextKey mesh_glass =
    of_kinds({"glass"}, for_example("\"N-BK7\"", TextKey("glass", Default::none(), "Glass of the body.")));
const TextKey mesh_surrounding = of_kinds({"glass"}, TextKey("surrounding", Default::of(std::string("air")),
                                                             "What is around it: air, or a glass or liquid by name."));
const NumberKey mesh_reflectance =
    of_kinds({"mirror"}, NumberKey("reflectance", share_range, 1.0, "Share of the light that the mirror keeps."));
const NumbersKey mesh_position = for_example(
    "[0.0, 0.0, 60.0]",
    NumbersKey("position_mm", NumberRange::within(-largest_coordinate, largest_coordinate), Default::none(),
               "Place of the file's origin: x, y and z from the object's plane on, where the light really goes (behind "
               "a beam splitter and fold mirrors as they stand)."));
const NumberKey mesh_tilt_x("tilt_x_deg", tilt_range_deg, 0.0, "Turn about x through the file's origin.");
const NumberKey mesh_tilt_y("tilt_y_deg", tilt_range_deg, 0.0, "Turn about the y axis that this gives.");
const NumberKey mesh_tilt_z("tilt_z_deg", tilt_range_deg, 0.0, "Turn about the z axis that both give.");

bool ends_with(const std::filesystem::path& file, std::initializer_list<std::string_view> endings) {
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    return std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); });
}

std::string digest_of(const optics::Facets& facets) {
    return Digest()
        .add_values(std::span<const glm::dvec3>(facets.vertices))
        .add_values(std::span<const glm::uvec3>(facets.triangles))
        .text();
}

// The mesh of the file, converted to mm.
optics::Facets read_facets(const Section& section, const std::string& dotted_key) {
    const TomlTable& table = section.table();
    std::optional<double> unit;
    if (section.has(mesh_unit)) {
        unit = section.choice(mesh_unit);
    }
    optics::Facets facets;
    table.attempt(mesh_file.name, [&] {
        const auto path = looked_for(table.file_path(mesh_file.name));
        const bool is_stl = ends_with(path, {".stl"});
        const double scale = unit.value_or(is_stl ? 1.0 : mm_per_gltf_unit);
        if (!is_stl && !ends_with(path, {".gltf", ".glb"})) {
            table.fail(mesh_file.name, "a file whose name ends in .stl, .gltf or .glb",
                       "Export the mesh as one of these.");
        }
        std::string bytes = specimen::specimen_bytes(path, table.where(mesh_file.name), dotted_key);
        specimen::FileMesh mesh =
            is_stl ? specimen::parse_stl(bytes, path) : specimen::parse_gltf(std::move(bytes), path);
        for (glm::dvec3& vertex : mesh.vertices) {
            vertex *= scale;
            if (!(std::max({std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)}) <= largest_coordinate)) {
                table.fail(mesh_file.name, fmt::format("coordinates up to {} mm", largest_coordinate),
                           "Correct the unit, or the file.");
            }
        }
        facets = optics::welded(mesh.vertices, mesh.triangles);
        if (facets.triangles.empty()) {
            table.fail(mesh_file.name, "a mesh with triangles of three different corners", "Export the mesh anew.");
        }
        section.record_reference(mesh_file, absolute_path(path).string(), digest_of(facets));
    });
    return facets;
}

void require_closed(const Section& section, const optics::Facets& facets) {
    const optics::Openness openness = optics::openness_of(facets);
    if (!facets.triangles.empty() && !openness.closed()) {
        section.note(mesh_file,
                     fmt::format("a closed mesh for kind = \"glass\"; this one has {} edges with a facet on one side "
                                 "alone and {} whose facets go round different ways or are more than two, the first at "
                                 "({:.6g}, {:.6g}, {:.6g}) mm",
                                 openness.open_edges, openness.turned_edges, openness.first.x, openness.first.y,
                                 openness.first.z),
                     "Mend the mesh where it was made, or choose kind = \"mirror\" or \"absorber\".");
    }
}

} // namespace

const KeyTable& mesh_element_keys() {
    static const KeyTable table{
        .path = "mesh_element",
        .presence = KeyTable::Presence::repeated,
        .meaning = "Elements of any form, as meshes of flat facets: with trace.mode = \"nonsequential\" alone.",
        .subject = "a mesh element",
        .kind = "kind",
        .keys = {&mesh_kind, &mesh_file, &mesh_unit, &mesh_glass, &mesh_surrounding, &mesh_reflectance, &mesh_position,
                 &mesh_tilt_x, &mesh_tilt_y, &mesh_tilt_z}};
    return table;
}

void read_mesh_elements(const TomlTable& root, Configuration& configuration) {
    for (const auto& table : root.optional_tables("mesh_element")) {
        const Section section(table, mesh_element_keys(), configuration);
        MeshElement element;
        element.kind = section.kind(mesh_kind);
        element.facets =
            read_facets(section, fmt::format("mesh_element[{}].file", configuration.instrument.meshes.size()));
        element.name = std::filesystem::path(table.optional_string(mesh_file.name).value_or("")).filename().string();
        if (element.kind == MeshElement::Kind::glass) {
            require_closed(section, element.facets);
            if (section.has(mesh_glass)) {
                element.glass = read_glass(section, mesh_glass, configuration);
            } else {
                (void)table.string(mesh_glass.name); // reports that the key is missing
            }
            element.surrounding = read_glass(section, mesh_surrounding, configuration);
        } else if (element.kind == MeshElement::Kind::mirror) {
            element.reflectance = section.number(mesh_reflectance);
        }
        const auto place = section.numbers(mesh_position);
        if (place.size() == 3) {
            element.pose.origin = glm::dvec3(place[0], place[1], place[2]);
        } else {
            section.note(mesh_position, "three numbers: x, y and z in mm, from the object's plane on",
                         "Give the place of the file's origin.");
        }
        element.pose = element.pose.turned({.tilt_x = section.number(mesh_tilt_x) * radians_per_degree,
                                            .tilt_y = section.number(mesh_tilt_y) * radians_per_degree,
                                            .tilt_z = section.number(mesh_tilt_z) * radians_per_degree});
        configuration.instrument.meshes.push_back(std::move(element));
    }
}

} // namespace vkfv
