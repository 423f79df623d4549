// The main.xml that is written conforms to the 2008 schema of X3P (ISO 5436-2): which elements, in which order, how
// often, with what text. The grammar is a statement of its own of what the schema asks for, sharing nothing with the
// writer.
#include "support/surface_files.hpp"
#include "surface_files/surface_file.hpp"

#include <gtest/gtest.h>
#include <pugixml.hpp>
#include <regex.h>
#include <unistd.h>
#include <zip.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace vkfv::surface {
namespace {

// Patterns of texts by XML Schema's lexical rules for the types.
constexpr const char* anything = ".*";
constexpr const char* token = "([^[:space:]](.*[^[:space:]])?)?";
constexpr const char* positive_integer = "\\+?0*[1-9][0-9]*";
constexpr const char* number = "[+-]?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([Ee][+-]?[0-9]+)?|-?INF|NaN";
constexpr const char* date_time =
    "-?[0-9]{4,}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])T([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9](\\.[0-9]+)?"
    "(Z|[+-][01][0-9]:[0-5][0-9])?";
constexpr const char* md5_sum = "[0-9A-Fa-f]{32}";

struct Element {
    const char* name;
    const char* text = nullptr; // a pattern; none: it has children
    std::vector<Element> children = {};
    int least = 1;
};

Element optional(Element element) {
    element.least = 0;
    return element;
}

Element axis(const char* name, const char* type) {
    return {name,
            nullptr,
            {{"AxisType", type},
             optional({"DataType", "[ILFD]"}),
             optional({"Increment", number}),
             optional({"Offset", number})}};
}

const Element& grammar() {
    static const Element root = {
        "p:ISO5436_2",
        nullptr,
        {{"Record1",
          nullptr,
          {{"Revision", "ISO5436 - 2000"},
           {"FeatureType", "PRF|SUR|PCL"},
           {"Axes", nullptr, {axis("CX", "[IA]"), axis("CY", "[IA]"), axis("CZ", "A")}}}},
         optional(
             {"Record2",
              nullptr,
              {{"Date", date_time},
               optional({"Creator", token}),
               {"Instrument",
                nullptr,
                {{"Manufacturer", token}, {"Model", token}, {"Serial", token}, {"Version", token}}},
               {"CalibrationDate", date_time},
               {"ProbingSystem", nullptr, {{"Type", "Contacting|NonContacting|Software"}, {"Identification", token}}},
               optional({"Comment", anything})}}),
         {"Record3",
          nullptr,
          {{"MatrixDimension",
            nullptr,
            {{"SizeX", positive_integer}, {"SizeY", positive_integer}, {"SizeZ", positive_integer}}},
           {"DataLink",
            nullptr,
            {{"PointDataLink", anything},
             {"MD5ChecksumPointData", md5_sum},
             optional({"ValidPointsLink", anything}),
             optional({"MD5ChecksumValidPoints", md5_sum})}}}},
         {"Record4", nullptr, {{"ChecksumFile", anything}}}}};
    return root;
}

bool matches(const char* text, const std::string& pattern) {
    regex_t compiled;
    EXPECT_EQ(regcomp(&compiled, ("^(" + pattern + ")$").c_str(), REG_EXTENDED | REG_NOSUB), 0) << pattern;
    const bool found = regexec(&compiled, text, 0, nullptr, 0) == 0;
    regfree(&compiled);
    return found;
}

// The first fault of the element; empty if it conforms.
std::string fault_of(const pugi::xml_node& node, const Element& element) {
    if (element.text)
        return matches(node.child_value(), element.text) ? "" : node.path() + ": " + node.child_value();
    auto child = node.first_child();
    for (const Element& expected : element.children) {
        if (std::string(child.name()) != expected.name) {
            if (expected.least > 0)
                return node.path() + ": no " + expected.name;
            continue;
        }
        if (const std::string fault = fault_of(child, expected); !fault.empty())
            return fault;
        child = child.next_sibling();
    }
    return child ? node.path() + ": " + child.name() + " has no place there" : "";
}

std::string fault_of(const pugi::xml_document& document) {
    const auto root = document.document_element();
    if (root.name() != std::string(grammar().name) ||
        root.attribute("xmlns:p").value() != std::string("http://www.opengps.eu/2008/ISO5436_2"))
        return "another root";
    return fault_of(root, grammar());
}

pugi::xml_document main_xml(const HeightMap& map, const Provenance& provenance) {
    const auto file =
        std::filesystem::path(testing::TempDir()) / ("vkfv_schema_" + std::to_string(::getpid()) + ".x3p");
    write_surface(file, map, provenance);
    pugi::xml_document document;
    zip_t* archive = zip_open(file.c_str(), ZIP_RDONLY, nullptr);
    zip_stat_t stat;
    if (!archive || zip_stat(archive, "main.xml", 0, &stat) != 0) {
        ADD_FAILURE() << "no archive with a main.xml";
        return document;
    }
    std::string text(stat.size, '\0');
    zip_file_t* entry = zip_fopen(archive, "main.xml", 0);
    EXPECT_EQ(zip_fread(entry, text.data(), text.size()), static_cast<zip_int64_t>(text.size()));
    zip_fclose(entry);
    zip_discard(archive);
    std::filesystem::remove(file);
    EXPECT_TRUE(document.load_string(text.c_str()));
    return document;
}

HeightMap map_with_gap() {
    HeightMap map{.height = Grid<double>(4, 3), .x0 = -1e-3, .y0 = 2.5e-7, .pitch_x = 1e-3, .pitch_y = 3e-4};
    map.height(1, 1) = std::numeric_limits<double>::quiet_NaN();
    return map;
}

const Provenance full = {.creator = "a & b",
                         .manufacturer = "c",
                         .model = "d",
                         .serial = "e",
                         .version = "f",
                         .date = "2026-11-21T12:00:00Z",
                         .comment = "g\n<h>"};

TEST(X3pSchema, WhatIsWrittenConforms) {
    HeightMap whole = map_with_gap();
    whole.height(1, 1) = 0;
    for (const HeightMap& map : {map_with_gap(), whole})
        for (const Provenance& provenance : {Provenance{}, full, Provenance{.date = "yesterday", .comment = "\x01"}})
            EXPECT_EQ(fault_of(main_xml(map, provenance)), "");
}

// Each of these breaks the schema, and is found.
TEST(X3pSchema, FaultsAreFound) {
    const auto fault_after = [](const std::function<void(pugi::xml_node)>& change) {
        const auto document = main_xml(map_with_gap(), full);
        change(document.document_element());
        return fault_of(document);
    };
    EXPECT_NE(fault_after([](pugi::xml_node root) { root.child("Record2").remove_child("CalibrationDate"); }), "");
    EXPECT_NE(fault_after([](pugi::xml_node root) { root.remove_child("Record4"); }), "");
    EXPECT_NE(fault_after([](pugi::xml_node root) { root.append_child("Record5"); }), "");
    EXPECT_NE(fault_after([](pugi::xml_node root) { // the order counts
                  auto record = root.child("Record2");
                  record.insert_move_before(record.child("Creator"), record.child("Date"));
              }),
              "");
    EXPECT_NE(fault_after([](pugi::xml_node root) { root.child("Record2").child("Date").text().set("21.11.2026"); }),
              "");
    EXPECT_NE(fault_after([](pugi::xml_node root) {
                  root.child("Record1").child("Axes").child("CX").child("Increment").text().set("1 um");
              }),
              "");
    EXPECT_NE(fault_after([](pugi::xml_node root) {
                  root.child("Record3").child("DataLink").child("MD5ChecksumPointData").text().set("abc");
              }),
              "");
    EXPECT_EQ(fault_after([](pugi::xml_node root) { root.remove_child("Record2"); }), ""); // it is optional
}

} // namespace
} // namespace vkfv::surface
