#include "measurement/calibration/digital_certificate.hpp"

#include "core/messages/safe_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace vkfv::measurement {

namespace {
namespace of_dcc {

using Node = pugi::xml_node;
using Texts = std::vector<std::string>;

void add_text(Node parent, const char* name, const std::string& text) {
    parent.append_child(name).append_child(pugi::node_pcdata).set_value(safe_text(text).c_str());
}

// Adds an element of the schema's textType, or one of its richContentType with a paragraph for each text.
Node add_content(Node parent, const char* name, const Texts& texts) {
    Node node = parent.append_child(name);
    for (const std::string& text : texts) {
        Node content = node.append_child("dcc:content");
        content.append_attribute("lang") = "en";
        content.append_child(pugi::node_pcdata).set_value(safe_text(text).c_str());
    }
    return node;
}

// A simulation has no laboratory, customer or place, but the schema demands them: these words stand in their places.
std::string none(const std::string& what) {
    return fmt::format("{}: none. {}", what, not_traceable);
}

// The D-SI has names of its own for the units of certificate.json.
std::string unit_of(const std::string& unit) {
    if (unit.empty()) {
        return "\\one";
    }
    if (unit == "um") {
        return "\\micro\\metre";
    }
    if (unit == "nm") {
        return "\\nano\\metre";
    }
    if (unit == "deg") {
        return "\\degree";
    }
    if (unit == "percent") {
        return "\\percent";
    }
    throw std::logic_error(
        fmt::format("The D-SI's name of the unit {} is not known to digital_certificate.cpp.", unit));
}

// The D-SI takes coverage factors without an exponent, unlike other numbers.
void add_uncertainty(Node real, const CertificateFigure& figure) {
    const double expanded = figure.expanded_uncertainty();
    if (!std::isfinite(expanded)) {
        return;
    }
    Node uncertainty = real.append_child("si:measurementUncertaintyUnivariate").append_child("si:expandedMU");
    add_text(uncertainty, "si:valueExpandedMU", fmt::format("{}", expanded));
    add_text(uncertainty, "si:coverageFactor", fmt::format("{:.9f}", figure.coverage_factor()));
    add_text(uncertainty, "si:coverageProbability", "0.95");
    add_text(uncertainty, "si:distribution",
             std::isfinite(figure.degrees_of_freedom)
                 ? fmt::format("Student's t, {} degrees of freedom", figure.degrees_of_freedom)
                 : "normal");
}

Node add_real(Node quantity, const std::string& label, double value, const std::string& unit) {
    Node real = quantity.append_child("si:real");
    add_text(real, "si:label", label);
    add_text(real, "si:value", fmt::format("{}", value));
    add_text(real, "si:unit", unit_of(unit));
    return real;
}

void add_figure(Node data, const std::string& characteristic, const CertificateFigure& figure) {
    Node quantity = data.append_child("dcc:quantity");
    quantity.append_attribute("id") = fmt::format("{}.{}", characteristic, figure.key).c_str();
    add_content(quantity, "dcc:name", {figure.title});
    Texts description = {not_traceable};
    if (!std::isfinite(figure.value)) {
        add_content(quantity, "dcc:description", description);
        add_content(quantity, "dcc:noQuantity", {figure.key, "Not determined."});
        return;
    }
    if (!std::isfinite(figure.expanded_uncertainty())) {
        description.push_back("The procedure gives no uncertainty of this figure.");
    }
    add_content(quantity, "dcc:description", description);
    add_uncertainty(add_real(quantity, figure.key, figure.value, figure.unit), figure);
}

void add_software(Node parent, const char* name, const std::string& program) {
    Node software = parent.append_child(name).append_child("dcc:software");
    add_content(software, "dcc:name", {"vkfv"});
    add_text(software, "dcc:release", program.substr(0, program.find('\n')));
    add_text(software, "dcc:type", "application");
    add_content(software, "dcc:description", {program});
}

// The schema demands an address of a contact.
void add_no_place(Node contact) {
    add_content(contact.append_child("dcc:location"), "dcc:further", {none("Place")});
}

void add_core_data(Node administrative, const std::string& identifier, const std::string& date) {
    Node core = administrative.append_child("dcc:coreData");
    add_text(core, "dcc:countryCodeISO3166_1", "ZZ"); // ISO 3166-1 leaves it to its users: no country has it
    add_text(core, "dcc:usedLangCodeISO639_1", "en");
    add_text(core, "dcc:mandatoryLangCodeISO639_1", "en");
    add_text(core, "dcc:uniqueIdentifier", identifier);
    const std::string day = date.empty() ? "1970-01-01" : date;
    add_text(core, "dcc:beginPerformanceDate", day);
    add_text(core, "dcc:endPerformanceDate", day);
    add_text(core, "dcc:performanceLocation", "other");
}

void add_instrument(Node administrative, const Certificate& certificate) {
    Node item = administrative.append_child("dcc:items").append_child("dcc:item");
    add_content(item, "dcc:name", {fmt::format("Simulated focus-variation microscope: {}", certificate.title)});
    add_content(item, "dcc:description", {not_traceable});
    Node identification = item.append_child("dcc:identifications").append_child("dcc:identification");
    add_text(identification, "dcc:issuer", "other");
    add_text(identification, "dcc:value", certificate.identity_digest);
    add_content(identification, "dcc:name", {"SHA-256 of all that images depend on, but for the specimen"});
}

void add_statement(Node statements, const char* name, const Texts& declaration) {
    Node statement = statements.append_child("dcc:statement");
    add_content(statement, "dcc:name", {name});
    add_text(statement, "dcc:traceable", "false");
    add_content(statement, "dcc:declaration", declaration);
}

void add_statements(Node administrative, const Certificate& certificate, bool dated) {
    Node statements = administrative.append_child("dcc:statements");
    add_statement(statements, "Traceability", {not_traceable});
    add_statement(statements, "Standards", {smooth_standards});
    if (certificate.conditions.small) {
        add_statement(statements, "Extent",
                      {fmt::format("Measured in the middle of the field, and on {}; figures that depend on field and "
                                   "scan are those of this part.",
                                   scan_text(certificate.conditions))});
    }
    add_statement(statements, "Uncertainty",
                  {"Uncertainties are those of the procedures alone: no input of this instrument states one of its "
                   "own."});
    Texts absent = {"The country ZZ is none. Laboratory, customer and responsible person are none."};
    if (!dated) {
        absent.push_back("The date 1970-01-01 is none: the same calibration has the same bytes at any time. "
                         "SOURCE_DATE_EPOCH, an environment variable, gives a date in seconds since 1970.");
    }
    add_statement(statements, "Administrative data", absent);
}

void add_administrative_data(Node root, const Certificate& certificate, const std::string& identifier,
                             const std::string& date) {
    Node administrative = root.append_child("dcc:administrativeData");
    add_software(administrative, "dcc:dccSoftware", certificate.program);
    add_core_data(administrative, identifier, date);
    add_instrument(administrative, certificate);
    Node laboratory = administrative.append_child("dcc:calibrationLaboratory").append_child("dcc:contact");
    add_content(laboratory, "dcc:name", {none("Calibration laboratory")});
    add_no_place(laboratory);
    Node person = administrative.append_child("dcc:respPersons").append_child("dcc:respPerson");
    add_content(person.append_child("dcc:person"), "dcc:name", {none("Responsible person")});
    add_text(person, "dcc:mainSigner", "false");
    Node customer = administrative.append_child("dcc:customer");
    add_content(customer, "dcc:name", {none("Customer")});
    add_no_place(customer);
    add_statements(administrative, certificate, !date.empty());
}

void add_conditions(Node results, const Certificate& certificate) {
    Node conditions = results.append_child("dcc:influenceConditions");
    for (const auto& row : condition_rows(certificate.conditions)) {
        Node condition = conditions.append_child("dcc:influenceCondition");
        add_content(condition, "dcc:name", {row.words});
        Node quantity = condition.append_child("dcc:data").append_child("dcc:quantity");
        quantity.append_attribute("id") = fmt::format("condition.{}", row.key).c_str();
        add_real(quantity, row.key, row.value, row.unit);
    }
    const auto add_words = [&](const char* name, const std::string& words) {
        Node condition = conditions.append_child("dcc:influenceCondition");
        add_content(condition, "dcc:name", {name});
        add_content(condition.append_child("dcc:data"), "dcc:text", {words});
    };
    add_words("devices", fmt::format("{}", fmt::join(certificate.devices, "; ")));
    add_words("first seed", fmt::format("{}", certificate.conditions.seed));
    add_words("camera", certificate.conditions.camera ? "images have a camera's noise"
                                                      : "images are light, without a camera's noise");
}

void add_result(Node results, const CertificateEntry& entry) {
    const Characteristic& characteristic = *entry.characteristic;
    Node result = results.append_child("dcc:measurementResult");
    result.append_attribute("id") = characteristic.name.c_str();
    add_content(result, "dcc:name", {characteristic.title});
    Texts description = {not_traceable};
    description.insert(description.end(), entry.findings.remarks.begin(), entry.findings.remarks.end());
    add_content(result, "dcc:description", description);
    Node method = result.append_child("dcc:usedMethods").append_child("dcc:usedMethod");
    add_content(method, "dcc:name", {characteristic.name});
    Node procedure = add_content(method, "dcc:description", {characteristic.procedure});
    add_text(procedure.append_child("dcc:formula"), "dcc:latex", characteristic.equation);
    add_text(method, "dcc:norm", "ISO 25178-600");
    Node standard = result.append_child("dcc:measuringEquipments").append_child("dcc:measuringEquipment");
    add_content(standard, "dcc:name", {"Simulated standard"});
    add_content(standard, "dcc:description", {characteristic.standard});
    Node figures = result.append_child("dcc:results").append_child("dcc:result");
    add_content(figures, "dcc:name", {characteristic.title});
    add_content(figures, "dcc:description", {not_traceable, "certificate.json has the tables behind the figures."});
    Node data = figures.append_child("dcc:data");
    for (const auto& figure : entry.findings.figures) {
        add_figure(data, characteristic.name, figure);
    }
    if (entry.findings.figures.empty()) {
        add_content(data, "dcc:text", {"No figure; the description says why."});
    }
    Node traceability = result.append_child("dcc:measurementMetaData").append_child("dcc:metaData");
    add_text(traceability, "dcc:traceable", "false");
    add_content(traceability, "dcc:declaration", {not_traceable});
}

} // namespace of_dcc
} // namespace

std::string digital_certificate(const Certificate& certificate, const std::string& identifier,
                                const std::string& date) {
    pugi::xml_document document;
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    auto root = document.append_child("dcc:digitalCalibrationCertificate");
    root.append_attribute("xmlns:dcc") = "https://ptb.de/dcc";
    root.append_attribute("xmlns:si") = "https://ptb.de/si";
    root.append_attribute("xmlns:xsi") = "http://www.w3.org/2001/XMLSchema-instance";
    root.append_attribute("xsi:schemaLocation") = "https://ptb.de/dcc https://ptb.de/dcc/v3.3.0/dcc.xsd";
    root.append_attribute("schemaVersion") = "3.3.0";
    of_dcc::add_administrative_data(root, certificate, identifier, date);
    auto results = root.append_child("dcc:measurementResults");
    of_dcc::add_software(results, "dcc:usedSoftware", certificate.program);
    of_dcc::add_conditions(results, certificate);
    for (const auto& entry : certificate.entries) {
        of_dcc::add_result(results, entry);
    }
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

} // namespace vkfv::measurement
