// Reads what an image file states of itself: the first byte is the number of its pages, the rest its description.
#include "core/messages/error.hpp"
#include "scan/stated_series.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    vkfv::images::ImageStatement statement;
    statement.description = std::string(reinterpret_cast<const char*>(data) + 1, size - 1);
    statement.columns_per_unit = statement.rows_per_unit = 2;
    statement.unit = vkfv::images::ImageStatement::Unit::centimetre;
    const int pages = data[0];
    try {
        const auto stated = vkfv::scan::stated_series(statement, pages, "file.tif");
        for (const int page : stated.pages) { // every one of them is in the file
            if (page < 0 || page >= pages) {
                std::abort();
            }
        }
        if (pages > 0 && stated.pages.size() != static_cast<std::size_t>(pages)) {
            std::abort();
        }
    } catch (const vkfv::InputError&) { // a statement that the pages do not fit
    }
    return 0;
}
