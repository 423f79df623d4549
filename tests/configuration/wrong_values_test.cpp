// A value of another type, and one beside its range, are refused for every key by its declaration: at their place, with
// the key, what was expected and a remedy. Rules that several keys share are in tests/app/bad_input_test.cpp.
#include "configuration/configuration.hpp"
#include "configuration/key_documents.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {
namespace {

// The fewest lines that make a configuration, by tables.
const std::map<std::string, std::string> least = {
    {"source", "radius_mm = 0.96\nwavelength_um = 0.5876\n"},
    {"objective", "prescription = \"10x_0.28\"\n"},
    {"tube_lens", "prescription = \"200mm\"\n"},
    {"detector", "size_mm = 0.16\npixels = 8\n"},
    {"specimen", "kind = \"plane\"\nsize_mm = 0.2\n"},
    {"scan", "z_start_um = -2\nz_stop_um = 2\nz_step_um = 1\n"},
};

// The fewest lines of a table in which another stands.
const std::map<std::string, std::string> least_around = {
    {"source.spectrum", "[source]\nradius_mm = 0.96\n"},
    {"illumination.field", ""},
    {"specimen.roughness", "[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n"},
    {"specimen.material", "[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n"},
    {"specimen.material.lobe", "[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n[specimen.material]\n"},
    {"specimen.placement", "[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n"},
    {"specimen.reflectance", "[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n"},
    {"sweep.parameter", "[sweep]\nz_um = 0\n"},
    {"uncertainty.correlation", "[uncertainty]\n\"scan.z_start_um\" = {u = 1}\n\"scan.z_step_um\" = {u = 0.1}\n"},
};

// A key for a table that may have any key's name.
std::string header_of(const KeyTable& table) {
    return table.path == "uncertainty.KEY" ? "uncertainty.\"stage.scale_error\"" : table.path;
}

// The lines that must stand beside a key for it to be read at all.
const std::map<std::string, std::string> beside_it = {
    {"objective.tube_length_mm", "magnification = 10\n"},
    {"specimen.font", "text = \"a\"\n"},
    {"specimen.text_width_mm", "text = \"a\"\n"},
    {"illumination.field.falloff", "kind = \"even\"\n"},
    {"illumination.field.falloff_radius_mm", "kind = \"even\"\n"},
    {"illumination.field.brightest_x_mm", "kind = \"even\"\n"},
    {"illumination.field.brightest_y_mm", "kind = \"even\"\n"},
    {"specimen.material.lobe.weight", "scatter = \"mirror\"\n"},
    {"specimen.material.sq_wavelength_um", "sq_um = 0.01\n"},
    {"specimen.material.refractive_indices", "index_wavelengths_um = [0.5]\n"},
    {"specimen.material.extinction_coefficients", "index_wavelengths_um = [0.5]\nrefractive_indices = [1.0]\n"},
    {"specimen.material.reflectances", "reflectance_wavelengths_um = [0.5]\n"},
    {"specimen.material.lobe.sq_wavelength_um", "sq_um = 0.01\n"},
    {"specimen.material.lobe.refractive_indices", "index_wavelengths_um = [0.5]\n"},
    {"specimen.material.lobe.extinction_coefficients", "index_wavelengths_um = [0.5]\nrefractive_indices = [1.0]\n"},
    {"specimen.material.lobe.reflectances", "scatter = \"mirror\"\nreflectance_wavelengths_um = [0.5]\n"},
    {"specimen.material.lobe.reflectance_wavelengths_um", "scatter = \"mirror\"\n"},
    {"specimen.material.lobe.reflectance_file", "scatter = \"mirror\"\n"},
    {"detector.distortion", "distortion_field_mm = 1.0\n"},
    {"detector.distortion_field_mm", "distortion = 0.0\n"},
    {"uncertainty.KEY.dof", "u = 1\n"},
    {"uncertainty.KEY.type", "u = 1\n"},
    {"uncertainty.KEY.source", "u = 1\n"},
    {"uncertainty.correlation.coefficient", "keys = [\"scan.z_start_um\", \"scan.z_step_um\"]\n"},
};

// The kind of a table that has no default, for keys of every kind.
const std::map<std::string, std::string> kind_of = {{"mesh_element", "mirror"}};

struct Given {
    std::string text;
    int line; // at which the key stands
};

// The least configuration with this line in the key's table, of the first kind that has the key.
Given with(const KeyTable& table, const Key& key, const std::string& value) {
    std::string text;
    if (table.path.empty()) {
        text = key.name + " = " + value + "\n";
    }
    const std::string root = table.path.substr(0, table.path.find('.'));
    for (const auto& [name, lines] : least) {
        if (name != root) {
            text += "[" + name + "]\n" + lines;
        }
    }
    int line = 1;
    if (!table.path.empty()) {
        if (const auto around = least_around.find(table.path); around != least_around.end()) {
            text += around->second;
        }
        const bool repeated = table.presence == KeyTable::Presence::repeated;
        text += (repeated ? "[[" : "[") + header_of(table) + (repeated ? "]]\n" : "]\n");
        if (!key.kinds.empty()) {
            text += fmt::format("{} = \"{}\"\n", table.kind, key.kinds.front());
        } else if (const auto kind = kind_of.find(table.path); kind != kind_of.end() && key.name != table.kind) {
            text += fmt::format("{} = \"{}\"\n", table.kind, kind->second);
        }
        if (const auto beside = beside_it.find(table.path + "." + key.name); beside != beside_it.end()) {
            text += beside->second;
        }
        line = 1 + static_cast<int>(std::ranges::count(text, '\n'));
        text += key.name + " = " + value + "\n";
    }
    return {text, line};
}

std::string toml(double value) {
    return shortest_toml(value);
}

// Values that the declaration forbids.
std::vector<std::string> wrong_values(const Key& key) {
    std::vector<std::string> beside; // values just outside the range
    const NumberRange& range = key.range;
    for (const auto& [end, included, outward] : {std::tuple(range.minimum, range.minimum_included, -1),
                                                 std::tuple(range.maximum, range.maximum_included, 1)}) {
        if (std::isfinite(end)) {
            beside.push_back(toml(included ? end + outward * std::max(1.0, 1e-6 * std::abs(end)) : end));
        }
    }
    using enum Key::Type;
    std::vector<std::string> wrong;
    switch (key.type) {
    case number:
        wrong = {"\"wide\"", "true", "nan", "-inf"};
        wrong.insert(wrong.end(), beside.begin(), beside.end());
        break;
    case integer:
        wrong = {"\"wide\"", "8.5", "inf"};
        wrong.insert(wrong.end(), beside.begin(), beside.end());
        break;
    case integer_pair:
        wrong = {"\"wide\"", "[1, 2, 3]", "[8.5, 8]"};
        wrong.insert(wrong.end(), beside.begin(), beside.end());
        break;
    case boolean:
        wrong = {"1", "\"true\""};
        break;
    case text:
    case file:
        wrong = {"5", "[\"a\"]"};
        break;
    case choice:
        wrong = {"\"no such word\"", "5"};
        break;
    case numbers:
        wrong = {"\"wide\"", "[nan]", "[true]"};
        for (const auto& value : beside) {
            wrong.push_back("[" + value + "]");
        }
        break;
    case booleans:
        wrong = {"true", "[1]"};
        break;
    case texts:
        wrong = {"5", "[[5]]"};
        if (!key.choices.empty()) {
            wrong.emplace_back("[\"no such word\"]");
        }
        break;
    }
    return wrong;
}

// The problem that is told of the key at this line; none if it was not seen.
std::optional<InputProblem> problem_of(const Given& given, const std::string& key) {
    try {
        (void)read_configuration(TomlTable::parse(given.text, "c.toml"));
    } catch (const InputError& error) {
        for (const InputProblem& problem : error.problems()) {
            if (problem.where.line == given.line && problem.key.find(key) != std::string::npos) {
                return problem;
            }
        }
    }
    return std::nullopt;
}

TEST(WrongValues, OfEveryKeyAreRefusedAtTheirPlace) {
    int tried = 0;
    for (const KeyTable* table : key_tables()) {
        for (const Key* key : table->keys) {
            for (const auto& value : wrong_values(*key)) {
                SCOPED_TRACE(fmt::format("[{}] {} = {}", table->path, key->name, value));
                const auto given = with(*table, *key, value);
                const auto problem = problem_of(given, key->name);
                ++tried;
                if (!problem) {
                    ADD_FAILURE() << "not refused";
                    continue;
                }
                EXPECT_GT(problem->where.column, 0);
                EXPECT_FALSE(problem->expected.empty());
                EXPECT_TRUE(problem->remedy.ends_with(".")) << problem->remedy;
            }
        }
    }
    EXPECT_GT(tried, 800);
}

// The wrong twin: the default of the declaration is not refused, so a reader that refuses all is found.
TEST(WrongValues, AreNoneOfTheDefaults) {
    int tried = 0;
    for (const KeyTable* table : key_tables()) {
        for (const Key* key : table->keys) {
            if (!key->fallback.toml.empty()) {
                SCOPED_TRACE(fmt::format("[{}] {}", table->path, key->name));
                const auto given = with(*table, *key, key->fallback.toml);
                const auto problem = problem_of(given, key->name);
                EXPECT_FALSE(problem.has_value()) << problem->expected;
                ++tried;
            }
        }
    }
    EXPECT_GT(tried, 80);
}

} // namespace
} // namespace vkfv
