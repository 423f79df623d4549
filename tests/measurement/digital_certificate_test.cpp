// A certificate as a digital calibration certificate holds the figures of certificate.json, says everywhere that it is
// of a simulated instrument, and has the elements of version 3.3.0 of the schema in their order. The order that
// the schema asks for stands here once more, so that it shares nothing with the writer.
#include "measurement/calibration/digital_certificate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>

namespace vkfv::measurement {
namespace {

using testing::HasSubstr;
using testing::Not;

const Characteristic& characteristic_named(const std::string& name) {
    return *std::ranges::find(characteristics(), name, &Characteristic::name);
}

CertificateFigure made_figure(const std::string& key, const std::string& unit, double value, double uncertainty,
                              double degrees_of_freedom) {
    return {.key = key,
            .title = "the " + key,
            .unit = unit,
            .value = value,
            .standard_uncertainty = uncertainty,
            .degrees_of_freedom = degrees_of_freedom};
}

// It has figures of every unit, with and without uncertainty, one not determined and a characteristic without any.
Certificate made_certificate() {
    constexpr double never = surface::undefined, infinite = std::numeric_limits<double>::infinity();
    Certificate certificate{.program = "vkfv 9.8.7\ncommit: 0123456789ab",
                            .title = "<R&D>\x1b \"20x\"",
                            .identity_digest = std::string(64, 'a'),
                            .devices = {"host", "a & b"},
                            .conditions = {.pixels = {.columns = 160, .rows = 120},
                                           .pitch = 0.000345,
                                           .window = 0.0024,
                                           .resolution = 0.0012,
                                           .lowest = -0.03,
                                           .range = 0.06,
                                           .step = 0.001,
                                           .curve_deviation = 0.003,
                                           .blur = 0.006,
                                           .camera = true,
                                           .small = true,
                                           .seed = 7},
                            .layout = "<svg/>",
                            .entries = {},
                            .configuration = "[scan]\n"};
    certificate.entries = {{.characteristic = &characteristic_named("alpha_z"),
                            .findings = {.figures = {made_figure("alpha_z", "", 1.00123456789012345, 2.5e-5, 19),
                                                     made_figure("l_z_nm", "nm", 31.25, 1.5, infinite)},
                                         .tables = {},
                                         .charts = {},
                                         .remarks = {"One of 21 grooves was not measured & does not count."}},
                            .trials = {"alpha_z/depth_0_place_0"}},
                           {.characteristic = &characteristic_named("alpha_xy"),
                            .findings = {.figures = {made_figure("perpendicularity_deg", "deg", -1e-7, 3e-12, 1),
                                                     made_figure("mapping_deviation_um", "um", 0.0125, 0.001, 0.5)},
                                         .tables = {},
                                         .charts = {},
                                         .remarks = {}},
                            .trials = {}},
                           {.characteristic = &characteristic_named("slope"),
                            .findings = {.figures = {made_figure("slope_limit_deg", "deg", never, never, infinite),
                                                     made_figure("most_wrong_percent", "percent", 0, never, infinite)},
                                         .tables = {},
                                         .charts = {},
                                         .remarks = {}},
                            .trials = {}},
                           {.characteristic = &characteristic_named("N_M"), .findings = {}, .trials = {}}};
    return certificate;
}

pugi::xml_document parsed_certificate(const std::string& date = "2026-01-31") {
    pugi::xml_document document;
    const std::string text = digital_certificate(made_certificate(), "vkfv-0123", date);
    const auto parsed = document.load_buffer(text.data(), text.size());
    EXPECT_TRUE(parsed) << parsed.description() << " at " << parsed.offset;
    return document;
}

std::string words_of(const pugi::xml_node& node) {
    std::string words;
    for (const auto& found : node.select_nodes(".//text()")) {
        words += std::string(found.node().value()) + "\n";
    }
    return words;
}

std::string text_at(const pugi::xml_node& node, const std::string& path) {
    return node.select_node(path.c_str()).node().text().get();
}

TEST(DigitalCertificate, HoldsEveryFigureWithItsUncertainty) {
    const std::map<std::string, std::string> units = {{"", "\\one"},
                                                      {"um", "\\micro\\metre"},
                                                      {"nm", "\\nano\\metre"},
                                                      {"deg", "\\degree"},
                                                      {"percent", "\\percent"}};
    const auto document = parsed_certificate();
    const auto json = certificate_json(made_certificate());
    int figures = 0, uncertainties = 0;
    for (const auto& characteristic : json.at("characteristics")) {
        const std::string name = characteristic.at("name");
        const auto result = document.select_node(("//dcc:measurementResult[@id='" + name + "']").c_str()).node();
        const auto method = result.child("dcc:usedMethods").child("dcc:usedMethod");
        EXPECT_EQ(text_at(method, "dcc:name/dcc:content"), name);
        EXPECT_EQ(text_at(method, "dcc:description/dcc:content"), characteristic.at("procedure").get<std::string>());
        EXPECT_EQ(text_at(method, "dcc:description/dcc:formula/dcc:latex"),
                  characteristic.at("equation").get<std::string>());
        for (const auto& remark : characteristic.at("remarks")) {
            EXPECT_THAT(words_of(result.child("dcc:description")), HasSubstr(remark.get<std::string>()));
        }
        EXPECT_EQ(result.select_nodes(".//dcc:quantity").size(), characteristic.at("figures").size());
        for (const auto& figure : characteristic.at("figures")) {
            const std::string key = figure.at("key");
            const auto quantity =
                result.select_node((".//dcc:quantity[@id='" + name + "." + key + "']").c_str()).node();
            EXPECT_EQ(text_at(quantity, "dcc:name/dcc:content"), figure.at("title").get<std::string>());
            ++figures;
            const double value = figure.at("value"), u = figure.at("standard_uncertainty");
            const auto real = quantity.child("si:real");
            if (!std::isfinite(value)) {
                EXPECT_FALSE(real);
                EXPECT_THAT(words_of(quantity.child("dcc:noQuantity")), HasSubstr("Not determined"));
                continue;
            }
            EXPECT_EQ(text_at(real, "si:label"), key);
            EXPECT_EQ(real.child("si:value").text().as_double(), value);
            EXPECT_EQ(text_at(real, "si:unit"), units.at(figure.at("unit").get<std::string>()));
            const auto uncertainty = real.child("si:measurementUncertaintyUnivariate").child("si:expandedMU");
            EXPECT_EQ(static_cast<bool>(uncertainty), std::isfinite(u)) << key;
            if (uncertainty) {
                ++uncertainties;
                const double expanded = figure.at("expanded_uncertainty_95");
                EXPECT_EQ(uncertainty.child("si:valueExpandedMU").text().as_double(), expanded);
                const std::string factor = uncertainty.child("si:coverageFactor").text().get();
                EXPECT_NEAR(expanded / std::stod(factor), u, 1e-8 * u);
                EXPECT_TRUE(std::regex_match(factor, std::regex("[1-9][0-9]*(\\.[0-9]*)?"))) << factor;
                EXPECT_EQ(uncertainty.child("si:coverageProbability").text().as_double(), 0.95);
                const double freedom = figure.at("degrees_of_freedom");
                EXPECT_EQ(text_at(uncertainty, "si:distribution") == "normal", std::isinf(freedom));
            } else {
                EXPECT_THAT(words_of(quantity.child("dcc:description")), HasSubstr("no uncertainty"));
            }
        }
    }
    EXPECT_EQ(figures, 6);
    EXPECT_EQ(uncertainties, 4);
    // 95 % of Student's distribution with one degree of freedom, which is Cauchy's: tan(0.475 pi).
    const auto factor = document.select_node("//dcc:quantity[@id='alpha_xy.perpendicularity_deg']//si:coverageFactor");
    EXPECT_NEAR(factor.node().text().as_double(), 12.7062, 1e-4);
    for (const auto& [key, value] : json.at("conditions").items()) {
        const auto real = document.select_node(("//dcc:quantity[@id='condition." + key + "']/si:real").c_str()).node();
        EXPECT_EQ(real.child("si:value").text().as_double(), value.get<double>()) << key;
        EXPECT_EQ(text_at(real, "si:unit"), key.ends_with("_um") ? "\\micro\\metre" : "\\one");
    }
}

TEST(DigitalCertificate, SaysWhereverItIsReadThatItIsOfASimulation) {
    const auto document = parsed_certificate();
    for (const char* path :
         {"//dcc:calibrationLaboratory//dcc:name", "//dcc:calibrationLaboratory//dcc:location",
          "//dcc:respPerson/dcc:person", "//dcc:customer/dcc:name", "//dcc:customer/dcc:location",
          "//dcc:item/dcc:description", "//dcc:statements/dcc:statement[1]/dcc:declaration",
          "//dcc:measurementResult/dcc:description", "//dcc:measurementResult/dcc:measurementMetaData",
          "//dcc:result/dcc:description", "//dcc:result//dcc:quantity/dcc:description"}) {
        const auto places = document.select_nodes(path);
        EXPECT_FALSE(places.empty()) << path;
        for (const auto& place : places) {
            EXPECT_THAT(words_of(place.node()), HasSubstr(not_traceable)) << path;
        }
    }
    EXPECT_EQ(document.select_nodes("//dcc:result//dcc:quantity/dcc:description").size(), 6u);
    for (const auto& traceable : document.select_nodes("//dcc:traceable")) {
        EXPECT_STREQ(traceable.node().text().get(), "false");
    }
    EXPECT_STREQ(document.select_node("//dcc:mainSigner").node().text().get(), "false");
    EXPECT_THAT(words_of(document.select_node("//dcc:item/dcc:name").node()), HasSubstr("<R&D>\\x1b \"20x\""));
}

TEST(DigitalCertificate, AnUnknownDateIsSaidToBeNone) {
    const auto date_in = [](const pugi::xml_document& document, const char* which) {
        return std::string(
            document.select_node((std::string("//dcc:coreData/dcc:") + which).c_str()).node().text().get());
    };
    const auto dated = parsed_certificate("2026-01-31"), undated = parsed_certificate("");
    for (const char* which : {"beginPerformanceDate", "endPerformanceDate"}) {
        EXPECT_EQ(date_in(dated, which), "2026-01-31");
        EXPECT_EQ(date_in(undated, which), "1970-01-01");
    }
    EXPECT_THAT(words_of(dated), Not(HasSubstr("1970-01-01 is none")));
    EXPECT_THAT(words_of(undated), HasSubstr("1970-01-01 is none"));
}

// The schema's elements have these children in this order; those that must be there have "!".
const std::map<std::string, std::vector<std::string>>& schema_order() {
    static const std::vector<std::string> text = {"dcc:content!"}, rich = {"dcc:content", "dcc:formula"};
    static const std::map<std::string, std::vector<std::string>> order = {
        {"dcc:digitalCalibrationCertificate", {"dcc:administrativeData!", "dcc:measurementResults!"}},
        {"dcc:administrativeData",
         {"dcc:dccSoftware!", "dcc:coreData!", "dcc:items!", "dcc:calibrationLaboratory!", "dcc:respPersons!",
          "dcc:customer!", "dcc:statements"}},
        {"dcc:dccSoftware", {"dcc:software!"}},
        {"dcc:usedSoftware", {"dcc:software!"}},
        {"dcc:software", {"dcc:name!", "dcc:release!", "dcc:type", "dcc:description"}},
        {"dcc:coreData",
         {"dcc:countryCodeISO3166_1!", "dcc:usedLangCodeISO639_1!", "dcc:mandatoryLangCodeISO639_1!",
          "dcc:uniqueIdentifier!", "dcc:beginPerformanceDate!", "dcc:endPerformanceDate!", "dcc:performanceLocation!"}},
        {"dcc:items", {"dcc:item!"}},
        {"dcc:item", {"dcc:name!", "dcc:description", "dcc:identifications!"}},
        {"dcc:identifications", {"dcc:identification!"}},
        {"dcc:identification", {"dcc:issuer!", "dcc:value!", "dcc:name"}},
        {"dcc:calibrationLaboratory", {"dcc:contact!"}},
        {"dcc:contact", {"dcc:name!", "dcc:location!"}},
        {"dcc:customer", {"dcc:name!", "dcc:location!"}},
        {"dcc:location", {"dcc:further!"}},
        {"dcc:respPersons", {"dcc:respPerson!"}},
        {"dcc:respPerson", {"dcc:person!", "dcc:mainSigner"}},
        {"dcc:person", {"dcc:name!"}},
        {"dcc:statements", {"dcc:statement!"}},
        {"dcc:statement", {"dcc:name", "dcc:traceable", "dcc:declaration"}},
        {"dcc:metaData", {"dcc:name", "dcc:traceable", "dcc:declaration"}},
        {"dcc:measurementMetaData", {"dcc:metaData!"}},
        {"dcc:measurementResults", {"dcc:usedSoftware", "dcc:influenceConditions", "dcc:measurementResult!"}},
        {"dcc:measurementResult",
         {"dcc:name!", "dcc:description", "dcc:usedMethods", "dcc:measuringEquipments", "dcc:results!",
          "dcc:measurementMetaData"}},
        {"dcc:usedMethods", {"dcc:usedMethod!"}},
        {"dcc:usedMethod", {"dcc:name!", "dcc:description", "dcc:norm"}},
        {"dcc:measuringEquipments", {"dcc:measuringEquipment!"}},
        {"dcc:measuringEquipment", {"dcc:name!", "dcc:description"}},
        {"dcc:influenceConditions", {"dcc:influenceCondition!"}},
        {"dcc:influenceCondition", {"dcc:name!", "dcc:data!"}},
        {"dcc:results", {"dcc:result!"}},
        {"dcc:result", {"dcc:name!", "dcc:description", "dcc:data!"}},
        {"dcc:quantity", {"dcc:name", "dcc:description", "dcc:noQuantity", "si:real"}},
        {"si:real", {"si:label", "si:value!", "si:unit!", "si:measurementUncertaintyUnivariate"}},
        {"si:measurementUncertaintyUnivariate", {"si:expandedMU!"}},
        {"si:expandedMU", {"si:valueExpandedMU!", "si:coverageFactor!", "si:coverageProbability!", "si:distribution"}},
        {"dcc:data", {"dcc:text", "dcc:quantity"}},
        {"dcc:formula", {"dcc:latex!"}},
        {"dcc:name", text},
        {"dcc:description", rich},
        {"dcc:declaration", rich},
        {"dcc:further", rich},
        {"dcc:text", rich},
        {"dcc:noQuantity", rich}};
    return order;
}

// An element and all below it are compared with the schema's order; each breach is a sentence.
void collect_breaches(const pugi::xml_node& node, std::vector<std::string>& breaches) {
    const auto found = schema_order().find(node.name());
    const std::vector<std::string> none;
    const auto& order = found == schema_order().end() ? none : found->second;
    std::size_t place = 0;
    std::set<std::string> present;
    for (const auto& child : node.children()) {
        if (child.type() != pugi::node_element) {
            if (found != schema_order().end()) {
                breaches.push_back(std::string(node.name()) + " has text");
            }
            continue;
        }
        const std::string name = child.name();
        while (place < order.size() && order[place] != name && order[place] != name + "!") {
            ++place;
        }
        if (place == order.size()) {
            breaches.push_back(std::string(node.name()) + " has " + name + " at a wrong place");
            return;
        }
        present.insert(name);
        collect_breaches(child, breaches);
    }
    for (const auto& name : order) {
        if (name.ends_with('!') && !present.contains(name.substr(0, name.size() - 1))) {
            breaches.push_back(std::string(node.name()) + " lacks " + name.substr(0, name.size() - 1));
        }
    }
    if (order.empty() && node.text().empty()) {
        breaches.push_back(std::string(node.name()) + " is empty");
    }
}

TEST(DigitalCertificate, HasTheElementsOfTheSchemaInTheirOrder) {
    auto document = parsed_certificate();
    std::vector<std::string> breaches;
    collect_breaches(document.document_element(), breaches);
    EXPECT_THAT(breaches, testing::IsEmpty());
    EXPECT_STREQ(document.document_element().attribute("schemaVersion").value(), "3.3.0");
    std::set<std::string> names;
    for (const auto& found : document.select_nodes("//@id")) {
        const std::string name = found.attribute().value();
        EXPECT_TRUE(std::regex_match(name, std::regex("[A-Za-z_][A-Za-z0-9._-]*"))) << name;
        EXPECT_TRUE(names.insert(name).second) << name << " stands twice";
    }
    EXPECT_GT(names.size(), 15u);
    // Wrong twins: an element moved, and one taken away.
    auto core = document.select_node("//dcc:coreData").node();
    core.prepend_move(core.child("dcc:uniqueIdentifier"));
    collect_breaches(document.document_element(), breaches);
    EXPECT_FALSE(breaches.empty());
    auto other = parsed_certificate();
    auto customer = other.select_node("//dcc:customer").node();
    customer.remove_child("dcc:location");
    breaches.clear();
    collect_breaches(other.document_element(), breaches);
    EXPECT_THAT(breaches, testing::ElementsAre("dcc:customer lacks dcc:location"));
}

} // namespace
} // namespace vkfv::measurement
