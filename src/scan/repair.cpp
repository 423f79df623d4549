#include "scan/repair.hpp"

#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/error.hpp"
#include "scan/stack_identity.hpp"
#include "scan/store.hpp"

#include <fmt/format.h>

#include <set>
#include <sstream>
#include <string>

namespace vkfv::scan {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& found, const std::string& expected) {
    refuse_file(file, "", found, expected,
                "Nothing was written. Trace the stack again from its first configuration, into another folder.");
}

// Throws InputError unless every row of the ledger is stored in an image.
void require_rows_of(const fs::path& file, const std::set<std::string>& rows) {
    std::error_code none;
    if (!fs::exists(file, none)) {
        return; // a shard has no ledger, as its images have their rows
    }
    std::istringstream lines(read_file(file));
    std::string line;
    std::getline(lines, line); // the names of the columns
    while (std::getline(lines, line)) {
        if (!rows.contains(line)) {
            refuse(file, fmt::format("the row \"{}\"", line.substr(0, 40)), "rows that the images carry");
        }
    }
}

} // namespace

bool was_repaired(const fs::path& folder) {
    std::error_code none;
    return fs::exists(folder / before_repair_name, none);
}

bool repair(const fs::path& folder) {
    ResultFolder results(folder);
    const fs::path copy = folder / configuration_copy_name, file = folder / configuration_name;
    const std::string text = read_file(copy, {.key = "",
                                              .expected = "the copy of stack.toml that vkfv writes beside it",
                                              .remedy = "Without it the stack cannot be repaired."});
    const std::string digest = digest_in(text);
    if (digest.empty() || Digest().add(identity_in(text)).text() != digest) {
        refuse(copy, "an identity of another digest than it states", "the copy of stack.toml as it was written");
    }
    std::set<std::string> rows;
    for (const SealedImage& image : sealed_images(folder)) {
        if (!image.whole || image.digest != digest) {
            refuse(folder / image.name, image.whole ? "an image of another stack" : "not the file that was written",
                   fmt::format("an image of the stack {}", digest));
        }
        rows.insert(image.ledger_row);
    }
    if (rows.empty()) {
        refuse(folder, "no images", "the images of a stack");
    }
    require_rows_of(folder / "ledger.csv", rows);
    std::error_code none;
    const std::string found = fs::exists(file, none) ? read_file(file) : std::string();
    if (found == text) {
        return false;
    }
    results.write(before_repair_name, found);
    results.write(configuration_name, text);
    if (fs::exists(folder / checksums_name, none)) { // an unfinished stack has no list yet
        results.write_checksums();
    }
    return true;
}

} // namespace vkfv::scan
