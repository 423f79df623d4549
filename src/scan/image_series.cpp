#include "scan/image_series.hpp"

#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "scan/image_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace vkfv::scan {

namespace {

constexpr std::array extensions = {".tif",  ".tiff", ".png", ".bmp", ".jpg", ".jpeg", ".jpe", ".jfif", ".jp2", ".j2k",
                                   ".webp", ".exr",  ".hdr", ".pgm", ".ppm", ".pnm",  ".pfm", ".pbm",  ".tga"};

bool is_image(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return std::ranges::find(extensions, extension) != extensions.end() && file.filename().string().front() != '.';
}

// The chosen one of `count` channels or frames, from 0.
int chosen(const std::filesystem::path& path, const std::string& kind, const std::optional<int>& asked, int count,
           const StatedSeries& stated) {
    if (count == 1 && !asked) {
        return 0;
    }
    if (!asked || *asked < 1 || *asked > count) {
        refuse_file(path, "",
                    asked ? fmt::format("{} {}", kind, *asked)
                          : fmt::format("pages: {}, heights: {}, channels: {}, frames: {} ({})", stated.pages.size(),
                                        stated.heights, stated.channels, stated.frames, stated.by),
                    count == 1 ? fmt::format("{} 1, the only one", kind) : fmt::format("one {} of {}", kind, count),
                    count == 1 ? fmt::format("Leave --{} out.", kind)
                               : fmt::format("Choose it: --{} 1 to {}.", kind, count));
    }
    return *asked - 1;
}

// The names of files with their endings after a '/', so that files of different endings are not alike.
std::vector<std::string> names_with_endings(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const auto& file : files) {
        names.push_back(file.stem().string() + "/" + file.extension().string());
    }
    return names;
}

// True for the images with the size and channels that at least four of five have; true for all if there is no such
// size.
std::vector<bool> of_one_size(const std::vector<images::ImageStatement>& statements) {
    using Size = std::tuple<int, int, int>;
    const auto size_of = [](const images::ImageStatement& image) {
        return Size(image.columns, image.rows, image.channels);
    };
    std::map<Size, std::size_t> counts;
    for (const auto& image : statements) {
        counts[size_of(image)] += 1;
    }
    const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    const bool is_series =
        static_cast<double>(most->second) >= share_of_a_series * static_cast<double>(statements.size());
    std::vector<bool> result;
    std::ranges::transform(statements, std::back_inserter(result),
                           [&](const auto& image) { return !is_series || size_of(image) == most->first; });
    return result;
}

// Keeps the files for which `kept` is true; the others are named in a warning.
void leave_out(std::vector<std::filesystem::path>& files, const std::vector<bool>& kept,
               const std::filesystem::path& folder, const std::string& reason) {
    std::vector<std::filesystem::path> rest;
    for (std::size_t k = 0; k < files.size(); ++k) {
        if (kept[k]) {
            rest.push_back(files[k]);
        } else {
            spdlog::warn("{}: {} is left out: {}", folder.string(), files[k].filename().string(), reason);
        }
    }
    files = std::move(rest);
}

// Reads the statement of each file. Files that are no images are left out, with a warning, if at least four of five
// files are images; else the first refusal is thrown.
std::vector<images::ImageStatement> statements_of(std::vector<std::filesystem::path>& files,
                                                  const std::filesystem::path& folder) {
    std::vector<images::ImageStatement> statements;
    std::vector<bool> kept;
    std::exception_ptr first_refusal;
    for (const auto& file : files) {
        try {
            statements.push_back(images::image_statement(file));
            kept.push_back(true);
        } catch (const InputError&) {
            kept.push_back(false);
            first_refusal = first_refusal ? first_refusal : std::current_exception();
        }
    }
    if (first_refusal &&
        static_cast<double>(statements.size()) < share_of_a_series * static_cast<double>(files.size())) {
        std::rethrow_exception(first_refusal);
    }
    leave_out(files, kept, folder, "it cannot be read as an image");
    return statements;
}

} // namespace

ImageSeries::ImageSeries(const std::filesystem::path& path, const SeriesChoice& choice) {
    if (std::filesystem::is_directory(path)) {
        take_folder(path);
        for (const auto& [kind, asked] : {std::pair("channel", choice.channel), std::pair("frame", choice.frame)}) {
            chosen(path, kind, asked, 1, stated_);
        }
        return;
    }
    if (!std::filesystem::exists(path)) {
        refuse_file(path, "", "no such file or folder",
                    "the folder of a stack (with its stack.toml), a folder of images, or a TIFF file of several pages",
                    "Check the path.");
    }
    stated_ = stated_series(images::image_statement(path), images::page_count(path), path);
    const int channel = chosen(path, "channel", choice.channel, stated_.channels, stated_);
    const int frame = chosen(path, "frame", choice.frame, stated_.frames, stated_);
    for (int height = 0; height < stated_.heights; ++height) {
        images_.push_back({path, stated_.page(height, channel, frame)});
    }
}

void ImageSeries::take_folder(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.is_regular_file() && is_image(entry.path())) {
            files.push_back(entry.path());
        }
    }
    if (files.empty()) {
        refuse_file(path, "", "no stack.toml and no image",
                    fmt::format("stack.toml or files {}", fmt::join(extensions, ", ")),
                    "Give the folder of a stack of vkfv, one with the images of another, or a TIFF file of several "
                    "pages. Develop a camera's raw files to TIFF, all with the same settings.");
    }
    std::ranges::sort(files); // the folder's own order is arbitrary
    leave_out(files, of_one_series(names_with_endings(files)), path, "its name is not like those of the others");
    if (const auto series = several_series(names_with_endings(files)); !series.empty()) {
        constexpr std::size_t most_named = 3;
        std::vector<std::string> one_of_each;
        for (std::size_t k = 0; k < std::min(series.size(), most_named); ++k) {
            one_of_each.push_back(files[series[k]].filename().string());
        }
        if (series.size() > most_named) {
            one_of_each.push_back(fmt::format("{} others", series.size() - most_named));
        }
        refuse_file(path, "", fmt::format("several series of images: those of {}", fmt::join(one_of_each, " and of ")),
                    "one series in a folder", "Move the images of the others to folders of their own.");
    }
    const auto statements = statements_of(files, path);
    leave_out(files, of_one_size(statements), path, "it has another size or kind than the others");
    std::vector<std::string> names;
    std::ranges::transform(files, std::back_inserter(names), [](const auto& file) { return file.stem().string(); });
    const auto found = order_of_names(names);
    if (!found.doubt.empty()) {
        spdlog::warn("{}: the heights of the images are in doubt: {}", path.string(), found.doubt);
    }
    for (std::size_t k = 0; k < found.order.size(); ++k) {
        const auto& file = files[found.order[k]];
        const int before = static_cast<int>(images_.size()) - 1;
        for (int height = before + 1; height < found.heights[k]; ++height) {
            images_.push_back({.file = {}, .page = 0, .before = before, .after = found.heights[k]});
        }
        if (before + 1 < found.heights[k]) {
            const int missing = found.heights[k] - before - 1;
            spdlog::warn("{}: {} missing between {} and {}, by the numbers in their names: means of these two stand in "
                         "place, so that no height there is certain",
                         path.string(), missing == 1 ? "an image is" : fmt::format("{} images are", missing),
                         images_[static_cast<std::size_t>(before)].file.filename().string(), file.filename().string());
        }
        images_.push_back({.file = file});
    }
    const auto& first = images_.front().file;
    stated_ = stated_series(images::image_statement(first), StatedSeries::uncounted, first);
    if (found.step) {
        stated_.z_by = "the names of the files";
        stated_.z_step = found.step;
        stated_.z_start = found.first;
    }
}

std::string ImageSeries::name(int image) const {
    const Place& place = images_.at(static_cast<std::size_t>(image));
    if (place.file.empty()) {
        return fmt::format("(missing, between {} and {})", name(place.before), name(place.after));
    }
    const std::string file = place.file.filename().string();
    return images_.front().file == images_.back().file ? fmt::format("{}, page {}", file, place.page) : file;
}

std::vector<Grid<float>> ImageSeries::read(int image) const {
    const Place& place = images_.at(static_cast<std::size_t>(image));
    if (!place.file.empty()) {
        return images::read_channels(place.file, place.page);
    }
    auto before = read(place.before);
    const auto after = read(place.after);
    const float share = static_cast<float>(image - place.before) / static_cast<float>(place.after - place.before);
    for (std::size_t channel = 0; channel < std::min(before.size(), after.size()); ++channel) {
        auto& values = before[channel].values;
        const auto& others = after[channel].values;
        if (values.size() == others.size()) { // another size is refused where that image is read
            std::ranges::transform(values, others, values.begin(),
                                   [share](float a, float b) { return a + share * (b - a); });
        }
    }
    return before;
}

} // namespace vkfv::scan
