#include "scan/ledger_table.hpp"

#include "core/files/file.hpp"

#include <charconv>
#include <sstream>
#include <string_view>

namespace vkfv::scan {

namespace {

// The fields of a line of CSV (RFC 4180) without line ends in its fields.
std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (line[k] == '"') {
            if (quoted && k + 1 < line.size() && line[k + 1] == '"') {
                fields.back() += line[k++];
            } else {
                quoted = !quoted;
            }
        } else if (line[k] == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[k];
        }
    }
    return fields;
}

double number_of(const std::string& text) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

} // namespace

MeanLedger mean_ledger(const std::filesystem::path& folder) {
    constexpr std::string_view unit = "_W";
    MeanLedger ledger;
    std::error_code none;
    if (!std::filesystem::exists(folder / "ledger.csv", none)) {
        return ledger;
    }
    std::istringstream lines(read_file(folder / "ledger.csv"));
    std::string line;
    std::getline(lines, line);
    const auto names = fields_of(line);
    std::vector<double> sums(names.size());
    double rows = 0;
    while (std::getline(lines, line)) {
        const auto fields = fields_of(line);
        if (fields.size() != names.size()) {
            return {};
        }
        for (std::size_t k = 0; k < fields.size(); ++k) {
            sums[k] += number_of(fields[k]);
        }
        ++rows;
    }
    for (std::size_t k = 0; k < names.size() && rows > 0; ++k) {
        const std::string& name = names[k];
        if (name == "emitted_W") {
            ledger.emitted = sums[k] / rows;
        } else if (name.ends_with(unit)) {
            ledger.shares.push_back({name.substr(0, name.size() - unit.size()), sums[k] / rows});
        }
    }
    return ledger;
}

} // namespace vkfv::scan
