#include "specimen/file_keys.hpp"

namespace vkfv::specimen {

FileKey needed_file_key(std::string meaning) {
    return for_example("\"specimen\"", FileKey("file", Default::none(), std::move(meaning)));
}

ChoiceKey<double> unit_key(std::optional<double> fallback, std::string meaning) {
    return {"unit", {{1.0, "mm"}, {1e-3, "um"}, {1e3, "m"}, {25.4, "inch"}}, fallback, std::move(meaning)};
}

} // namespace vkfv::specimen
