#include "scan/checkpoint_files.hpp"

#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace vkfv::scan {

namespace {

// A file has a line each for this text, the exposure, the work done, and the checksum of the numbers; then the numbers.
constexpr std::string_view first_line = "vkfv checkpoint 1\n";

std::string exposure_line(const std::string& digest, std::uint32_t image) {
    return fmt::format("{} {}\n", digest, image);
}

std::string sum_line(std::uint64_t done, std::string_view numbers) {
    return Digest().add(fmt::format("{}\n", done)).add(numbers).sha256() + "\n";
}

// Removes a beginning from the text; false if the text does not begin with it.
bool took(std::string_view& text, std::string_view beginning) {
    const bool starts = text.starts_with(beginning);
    text.remove_prefix(starts ? beginning.size() : 0);
    return starts;
}

} // namespace

CheckpointFiles::CheckpointFiles(Name name, std::string digest, double interval)
    : name_(std::move(name)), digest_(std::move(digest)), interval_(interval) {}

std::optional<trace::Checkpoint> CheckpointFiles::load(std::uint32_t image) const {
    const auto file = name_(image);
    std::error_code none;
    if (!std::filesystem::exists(file, none)) {
        return std::nullopt;
    }
    const auto leave = [&](std::string_view why) {
        spdlog::warn("{}: {}; the exposure begins anew", file.string(), why);
        return std::nullopt;
    };
    std::string bytes;
    try {
        bytes = read_file(file);
    } catch (const InputError& error) {
        return leave(error.problem().found);
    }
    std::string_view rest = bytes;
    if (!took(rest, first_line) || !took(rest, exposure_line(digest_, image))) {
        return leave("a checkpoint of another exposure");
    }
    trace::Checkpoint checkpoint;
    const auto line = rest.substr(0, rest.find('\n'));
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), checkpoint.done);
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t sum = Digest().sha256().size() + 1;
    if (error != std::errc() || end != line.data() + line.size() || rest.size() < sum ||
        rest.substr(0, sum) != sum_line(checkpoint.done, rest.substr(sum)) ||
        (rest.size() - sum) % sizeof(std::uint64_t) != 0) {
        return leave("not the bytes that were written");
    }
    rest.remove_prefix(sum);
    checkpoint.numbers.resize(rest.size() / sizeof(std::uint64_t));
    std::memcpy(checkpoint.numbers.data(), rest.data(), rest.size());
    spdlog::info("image {} goes on from {}", image, file.string());
    return checkpoint;
}

void CheckpointFiles::save(std::uint32_t image, const trace::Checkpoint& checkpoint) const {
    const std::string_view numbers(reinterpret_cast<const char*>(checkpoint.numbers.data()),
                                   checkpoint.numbers.size() * sizeof(std::uint64_t));
    std::string bytes = fmt::format("{}{}{}\n{}", first_line, exposure_line(digest_, image), checkpoint.done,
                                    sum_line(checkpoint.done, numbers));
    bytes += numbers;
    try {
        write_file(name_(image), bytes); // a folder that was removed is not made anew
    } catch (const RunError& error) {
        spdlog::warn("{}. The exposure goes on without a checkpoint", error.what());
    }
}

void CheckpointFiles::drop(std::uint32_t image) const {
    std::error_code none;
    std::filesystem::remove(name_(image), none);
}

} // namespace vkfv::scan
