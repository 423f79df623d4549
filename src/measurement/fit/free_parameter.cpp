#include "measurement/fit/free_parameter.hpp"

#include "configuration/key_documents.hpp"
#include "core/messages/error.hpp"
#include "measurement/scene/configured_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_free_parameter { // files of a unity build share the unnamed namespace

enum class Scale { logistic, above, below, linear };

Scale scale_of(const NumberRange& range) {
    const bool low = std::isfinite(range.minimum), high = std::isfinite(range.maximum);
    return low && high ? Scale::logistic : low ? Scale::above : high ? Scale::below : Scale::linear;
}

double logistic(double x) {
    return 1 / (1 + std::exp(-x));
}

// The declared number of this dotted key; null: there is none.
const Key* number_key(const std::string& key) {
    for (const KeyTable* table : key_tables()) {
        for (const Key* one : table->keys) {
            if (one->type == Key::Type::number && fmt::format("{}.{}", table->path, one->name) == key) {
                return one;
            }
        }
    }
    return nullptr;
}

[[noreturn]] void refuse_key(const std::string& key, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = "command line"},
                      .key = "--free",
                      .found = key,
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

std::vector<std::string> names_of_numbers() {
    std::vector<std::string> names;
    for (const KeyTable* table : key_tables()) {
        for (const Key* one : table->keys) {
            if (one->type == Key::Type::number) {
                names.push_back(fmt::format("{}.{}", table->path, one->name));
            }
        }
    }
    return names;
}

void require_start(const FreeParameter& parameter) {
    const auto& [key, unit, range, start] = parameter;
    const bool linear = scale_of(range) == Scale::linear;
    const bool inside = linear ? start != 0 : start > range.minimum && start < range.maximum;
    if (!std::isfinite(start) || !inside) {
        throw InputError(
            {.where = {.file = "command line"},
             .key = key,
             .found = fmt::format("a start at {:g}", start),
             .expected = linear ? std::string("a start other than 0, whose magnitude is the first step's unit")
                                : fmt::format("a start between the ends of its range ({})", range.to_string()),
             .remedy = fmt::format("Give --start {}=VALUE.", key)});
    }
}

} // namespace of_free_parameter
} // namespace

double FreeParameter::value(double scaled) const {
    using namespace of_free_parameter;
    switch (scale_of(range)) {
    case Scale::logistic: {
        const double share = (start - range.minimum) / (range.maximum - range.minimum);
        return range.minimum + (range.maximum - range.minimum) * logistic(std::log(share / (1 - share)) + scaled);
    }
    case Scale::above:
        return range.minimum + (start - range.minimum) * std::exp(scaled);
    case Scale::below:
        return range.maximum - (range.maximum - start) * std::exp(-scaled);
    case Scale::linear:
        return start + std::abs(start) * scaled;
    }
    return start;
}

double FreeParameter::slope(double scaled) const {
    using namespace of_free_parameter;
    const double at = value(scaled);
    switch (scale_of(range)) {
    case Scale::logistic:
        return (at - range.minimum) * (range.maximum - at) / (range.maximum - range.minimum);
    case Scale::above:
        return at - range.minimum;
    case Scale::below:
        return range.maximum - at;
    case Scale::linear:
        return std::abs(start);
    }
    return 1;
}

double FreeParameter::known_width(double scaled) const {
    using namespace of_free_parameter;
    switch (scale_of(range)) {
    case Scale::logistic:
        return (range.maximum - range.minimum) / slope(scaled);
    case Scale::above:
    case Scale::below:
        return std::log(10.0);
    case Scale::linear:
        break;
    }
    return std::numeric_limits<double>::infinity();
}

std::string FreeParameter::known_range() const {
    using namespace of_free_parameter;
    switch (scale_of(range)) {
    case Scale::logistic:
        return fmt::format("{:g} to {:g}", range.minimum, range.maximum);
    case Scale::above:
    case Scale::below:
        return "a decade";
    case Scale::linear:
        break;
    }
    return "any number";
}

std::vector<FreeParameter> free_parameters(const Configuration& configuration, const std::vector<std::string>& keys,
                                           const std::map<std::string, double>& starts) {
    using namespace of_free_parameter;
    std::vector<FreeParameter> parameters;
    parameters.reserve(keys.size());
    for (const std::string& key : keys) {
        const Key* declared = number_key(key);
        if (declared == nullptr) {
            const auto nearest = nearest_word(key, names_of_numbers());
            refuse_key(key, "a key of the configuration that is a number, as specimen.material.g",
                       nearest ? fmt::format("Did you mean {}?", *nearest)
                               : std::string("Correct its name; vkfv keys lists all."));
        }
        if (declared->influence == Influence::nothing) {
            refuse_key(key, "a key that images depend on", "Leave it out: no stack could tell it.");
        }
        if (std::ranges::find(parameters, key, &FreeParameter::key) != parameters.end()) {
            refuse_key(key, "each key once", "Leave the second out.");
        }
        const auto configured = number_in(configuration, key);
        const auto start = starts.find(key);
        if (!configured) {
            refuse_key(key, "a number that the configuration of the stack has",
                       fmt::format("Give {} a value with --set, or leave it out.", key));
        }
        parameters.push_back({.key = key,
                              .unit = declared->unit(),
                              .range = declared->range,
                              .start = start == starts.end() ? *configured : start->second});
        require_start(parameters.back());
    }
    for (const auto& [key, start] : starts) {
        if (std::ranges::find(parameters, key, &FreeParameter::key) == parameters.end()) {
            throw InputError({.where = {.file = "command line"},
                              .key = "--start",
                              .found = key,
                              .expected = "a key that --free names",
                              .remedy = "Add it to --free, or set it with --set."});
        }
    }
    return parameters;
}

} // namespace vkfv::measurement
