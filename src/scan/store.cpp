#include "scan/store.hpp"

#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/messages/safe_text.hpp"
#include "images/image_file.hpp"
#include "scan/repair.hpp"
#include "scan/stack_identity.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace vkfv::scan {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view ledger_name = "ledger.csv";
constexpr std::string_view timings_header = "what,seconds,rays_per_s";
constexpr std::string_view images_name = "images";
constexpr std::string_view lock_name = ".lock"; // shards add the name of their part (result_folder.cpp)

std::string ledger_header(const trace::Ledger& ledger) {
    std::string header = "image,z_um,rays,detected_rays,emitted_W";
    for (const auto& entry : ledger.entries) {
        header += "," + csv_cell(entry.name + "_W");
    }
    return header + ",residual_W";
}

// Numbers are written in the shortest form that reads back to the same bits.
std::string ledger_row(int image, double z, const trace::Image& exposure) {
    std::string row = fmt::format("{},{},{},{},{}", image, micrometres_text(z), exposure.rays, exposure.detected,
                                  exposure.ledger.emitted);
    for (const auto& entry : exposure.ledger.entries) {
        row += fmt::format(",{}", entry.power);
    }
    return row + fmt::format(",{}", exposure.ledger.residual());
}

// The value of `key=value` on a line of its own; empty if there is no such line.
std::string described(const std::string& description, std::string_view key) {
    const std::string label = fmt::format("\n{}=", key);
    const auto at = description.find(label);
    if (at == std::string::npos) {
        return "";
    }
    const auto begin = at + label.size();
    return description.substr(begin, description.find('\n', begin) - begin);
}

// Label in an image's description of the seal: the checksum of the whole file, computed with zeros in its place, so
// that it covers pixels, directory and text, and becomes durable with them.
constexpr std::string_view seal_label = "\nsha256_with_zeros_here=";
const std::string unsealed(64, '0');

// The place of the seal's digits; none: the file has no seal.
std::optional<std::size_t> seal_place(std::string_view bytes) {
    const auto label = bytes.find(seal_label);
    const auto place = label + seal_label.size();
    return label != std::string_view::npos && bytes.size() - place > unsealed.size() ? std::optional(place)
                                                                                     : std::nullopt;
}

std::string sealed(std::string bytes) {
    const auto place = seal_place(bytes);
    if (!place) {
        throw std::logic_error("an image without a place for its checksum");
    }
    const std::string sum = Digest().add(bytes).sha256();
    return bytes.replace(*place, sum.size(), sum);
}

bool seal_is_whole(const std::string& bytes) {
    const auto place = seal_place(bytes);
    if (!place) {
        return false;
    }
    const std::string_view all = bytes;
    const auto behind = *place + unsealed.size();
    const std::string sum = Digest().add(all.substr(0, *place)).add(unsealed).add(all.substr(behind)).sha256();
    return sum == all.substr(*place, unsealed.size());
}

struct FrameFile {
    std::string bytes; // bytes of the file
    images::StoredImage image;
};

FrameFile read_whole_frame(const fs::path& folder, int image, double z) {
    const fs::path path = folder / image_path(image);
    FrameFile frame{
        .bytes = read_file(path, {.expected = "an image of the stack",
                                  .remedy = "Trace the stack again with the same command: it keeps the other images."}),
        .image = {}};
    if (!seal_is_whole(frame.bytes)) {
        refuse_file(path, "", "bytes that are not those stored", "a whole image of a stack",
                    "Trace the stack again with the same command: it keeps the other images.");
    }
    frame.image = images::parse_tiff(frame.bytes, path);
    const std::string found = described(frame.image.description, "z_um");
    if (found != micrometres_text(z)) {
        refuse_file(path, "", fmt::format("z_um = {}", found.empty() ? "none" : found),
                    fmt::format("the focal height {} um", micrometres_text(z)),
                    "Keep the images of different stacks apart, or trace the stack again.");
    }
    return frame;
}

bool holds_nothing_but_a_beginning(const fs::path& folder) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (!entry->path().filename().string().starts_with(lock_name) && !is_unfinished_file(entry->path())) {
            return false;
        }
    }
    return !error;
}

} // namespace

std::string micrometres_text(double millimetres) {
    constexpr double per_micrometre = 1e9;
    // Adding 0 turns -0 into 0.
    return fmt::format("{}", std::round(millimetres * um_per_mm * per_micrometre) / per_micrometre + 0.0);
}

fs::path image_path(int image) {
    return fs::path(images_name) / fmt::format("z_{:04}.tif", image);
}

fs::path checkpoint_path(int image) {
    return fmt::format("partial_{:04}", image);
}

Grid<float> as_stored(const Grid<double>& flux) {
    Grid<float> stored(flux.columns, flux.rows);
    std::transform(flux.values.begin(), flux.values.end(), stored.values.begin(),
                   [](double power) { return static_cast<float>(power); });
    return stored;
}

namespace {

template <class Integer>
Grid<float> rounded_floats(const Grid<float>& values) {
    const auto integers = rounded<Integer>(values);
    Grid<float> result(values.columns, values.rows);
    std::ranges::copy(integers.values, result.values.begin());
    return result;
}

} // namespace

Grid<float> as_stored(Grid<float> values, PixelType type) {
    return type == PixelType::uint16  ? rounded_floats<std::uint16_t>(values)
           : type == PixelType::uint8 ? rounded_floats<std::uint8_t>(values)
                                      : std::move(values);
}

std::string frame_bytes(const Grid<float>& values, PixelType type, double pitch, const std::string& description) {
    const images::ImageTags tags{.pitch_x = pitch, .pitch_y = pitch, .description = description};
    return type == PixelType::uint16  ? images::tiff_bytes(rounded<std::uint16_t>(values), tags)
           : type == PixelType::uint8 ? images::tiff_bytes(rounded<std::uint8_t>(values), tags)
                                      : images::tiff_bytes(values, tags);
}

Grid<float> read_frame(const fs::path& folder, int image, double z) {
    return std::move(read_whole_frame(folder, image, z).image.values);
}

std::vector<SealedImage> sealed_images(const fs::path& folder) {
    std::vector<SealedImage> images;
    std::error_code error;
    for (fs::directory_iterator entry(folder / images_name, error), end; !error && entry != end;
         entry.increment(error)) {
        if (!is_unfinished_file(entry->path())) {
            images.emplace_back().name = fs::path(images_name) / entry->path().filename();
        }
    }
    std::ranges::sort(images, {}, &SealedImage::name);
    for (SealedImage& image : images) {
        try {
            const std::string bytes = read_file(folder / image.name);
            image.whole = seal_is_whole(bytes);
            image.damage = image.whole ? "" : "is not the file that was written";
            if (image.whole) {
                const std::string text = images::parse_tiff(bytes, image.name).description;
                image.digest = described(text, "stack");
                image.ledger_row = described(text, "ledger_row");
            }
        } catch (const InputError& problem) {
            image.whole = false;
            image.damage = problem.problem().found;
        }
    }
    return images;
}

Check check_images(const fs::path& folder) {
    Check check;
    std::string digest;
    try {
        digest = stored_digest(folder);
    } catch (const InputError& error) {
        check.damages.push_back({fs::path(configuration_name), error.problem().found});
    }
    std::error_code none;
    if (check.damages.empty() && fs::exists(folder / configuration_copy_name, none) &&
        checksum_of_file(folder / configuration_copy_name) != checksum_of_file(folder / configuration_name)) {
        check.damages.push_back(
            {fs::path(configuration_name), fmt::format("is not what its copy {} says", configuration_copy_name)});
    }
    for (const SealedImage& image : sealed_images(folder)) {
        check.files.push_back(image.name.generic_string());
        if (!image.whole || image.digest != digest) {
            check.damages.push_back({image.name, image.whole ? "is an image of another stack" : image.damage});
        }
    }
    return check;
}

namespace {

// The shard's part of the names of files and locks; empty for the whole stack.
std::string part_name(const Shard& shard) {
    return shard.is_whole() ? "" : fmt::format("{}_of_{}", shard.index + 1, shard.count);
}

fs::path timings_name(const Shard& shard) {
    return fmt::format("timings{}{}.csv", shard.is_whole() ? "" : "_", part_name(shard));
}

} // namespace

ImageStore::ImageStore(const fs::path& folder, StackDescription description, Shard shard)
    : description_(std::move(description)), shard_(shard), ledger_rows_(description_.positions.size()),
      notes_(description_.positions.size()) {
    if (shard.count < 1 || shard.index < 0 || shard.index >= shard.count) {
        throw std::invalid_argument("a shard is one of 0 .. count - 1");
    }
    std::error_code none;
    if (fs::exists(folder, none) && !fs::is_directory(folder, none)) {
        refuse_file(folder, "", "a file", "a folder", "Give another --out.");
    }
    if (fs::exists(folder, none) && !fs::exists(folder / configuration_name, none) &&
        !holds_nothing_but_a_beginning(folder) && !fs::exists(folder / configuration_name, none)) {
        refuse_file(folder, "", fmt::format("a folder with other files and without {}", configuration_name),
                    "a new folder, an empty one, or that of the same stack",
                    fs::exists(folder / configuration_copy_name, none)
                        ? fmt::format("If {} was lost, vkfv verify {} --repair writes it again; else give another "
                                      "--out.",
                                      configuration_name, folder.string())
                        : "Give another --out.");
    }
    results_ = std::make_unique<ResultFolder>(folder, part_name(shard_));
    {
        std::optional<ResultFolder::Turn> turn; // shards begin a folder together
        if (!shard_.is_whole()) {
            turn.emplace(*results_);
        }
        create_or_compare();
    }
    make_folder(folder / images_name);
    remove_unfinished_files(folder / images_name);
    keep_whole_images();
    if (shard_.is_whole()) {
        write_ledger();
        gather_timings();
    }
}

void ImageStore::create_or_compare() {
    const fs::path path = folder() / configuration_name;
    const std::string text = stack_text(description_);
    std::error_code none;
    const auto write = [&] {
        results_->write(configuration_name, text);
        results_->write(configuration_copy_name, text);
    };
    if (!fs::exists(path, none)) {
        write();
        return;
    }
    const std::string difference = identity_differences(stored_identity(folder()), description_.identity);
    if (!difference.empty()) {
        refuse_file(path, "", "a stack of another configuration", "the configuration of this run",
                    "Give another --out, or remove the folder. What differs:" + difference);
    }
    // Parts of the text that do not affect the images, such as the evaluation, may differ.
    const fs::path copy = folder() / configuration_copy_name;
    if (read_file(path) != text || !fs::exists(copy, none) || read_file(copy) != text) {
        write();
    } else {
        results_->note(configuration_name, text);
        results_->note(configuration_copy_name, text);
    }
}

void ImageStore::restore_configuration() {
    const std::string text = stack_text(description_);
    const fs::path path = folder() / configuration_name;
    std::error_code none;
    if (!fs::exists(path, none) || read_file(path) != text) {
        spdlog::warn("{}: was changed while the stack was traced; it is written again", path.string());
        results_->write(configuration_name, text);
    }
}

struct ImageStore::WholeImage {
    std::string bytes; // bytes of the file
    std::string ledger_header;
    std::string ledger_row;
    std::string note;
};

// Reads an image; throws InputError if it is damaged or belongs to another stack.
ImageStore::WholeImage ImageStore::whole_image(const fs::path& folder, int image) const {
    FrameFile frame = read_whole_frame(folder, image, description_.positions[static_cast<std::size_t>(image)]);
    const std::string& text = frame.image.description;
    const Grid<float>& values = frame.image.values;
    const auto refuse = [&](const std::string& found) {
        refuse_file(folder / image_path(image), "", found, "an image of this stack",
                    "Trace the stack again with the same command: it keeps the other images.");
    };
    if (values.columns != description_.columns || values.rows != description_.rows) {
        refuse(fmt::format("{} x {} pixels where {} x {} belong", values.columns, values.rows, description_.columns,
                           description_.rows));
    }
    if (described(text, "stack") != description_.digest) {
        refuse("an image of another stack");
    }
    WholeImage whole{.bytes = std::move(frame.bytes),
                     .ledger_header = described(text, "ledger_columns"),
                     .ledger_row = described(text, "ledger_row"),
                     .note = described(text, "camera")};
    if (whole.ledger_row.empty() || (!ledger_header_.empty() && whole.ledger_header != ledger_header_)) {
        refuse("its row of the ledger is missing");
    }
    return whole;
}

void ImageStore::keep(int image, const WholeImage& whole) {
    ledger_header_ = whole.ledger_header;
    ledger_rows_[static_cast<std::size_t>(image)] = whole.ledger_row;
    notes_[static_cast<std::size_t>(image)] = whole.note;
}

void ImageStore::keep_whole_images() {
    for (int image = shard_.index; image < static_cast<int>(ledger_rows_.size()); image += shard_.count) {
        const fs::path path = folder() / image_path(image);
        std::error_code none;
        if (!fs::exists(path, none)) {
            continue;
        }
        try {
            const WholeImage whole = whole_image(folder(), image);
            keep(image, whole);
            results_->note(image_path(image), whole.bytes);
        } catch (const InputError& error) {
            damaged_.push_back(fmt::format("{}: {}", path.string(), error.problem().found));
        }
    }
}

bool ImageStore::take(int image, const fs::path& from) {
    std::error_code none;
    if (!fs::exists(from / image_path(image), none)) {
        return false;
    }
    const WholeImage whole = whole_image(from, image);
    results_->write(image_path(image), whole.bytes);
    keep(image, whole);
    return true;
}

bool ImageStore::complete() const {
    return std::none_of(ledger_rows_.begin(), ledger_rows_.end(), [](const std::string& row) { return row.empty(); });
}

void ImageStore::store(int image, const trace::Image& exposure, const Frame& frame) {
    const auto index = static_cast<std::size_t>(image);
    if (frame.values.columns != description_.columns || frame.values.rows != description_.rows) {
        throw std::logic_error("an exposure of another size than the stack's");
    }
    const double z = description_.positions.at(index);
    const std::string header = ledger_header(exposure.ledger);
    const std::string row = ledger_row(image, z, exposure);

    // ImageJ and Fiji read the unit and the distance of the images from the first lines. A stack of one image has no
    // distance.
    std::string text = "ImageJ=1.11a\nunit=um\n";
    if (description_.positions.size() > 1) {
        text += fmt::format("spacing={:.12g}\n", (description_.positions[1] - description_.positions[0]) * um_per_mm);
    }
    text += fmt::format("image={}\nz_um={}\nvalues={}\n{}first_row=highest y\nstack={}\n"
                        "ledger_columns={}\nledger_row={}{}{}\n",
                        image, micrometres_text(z), description_.quantity,
                        frame.note.empty() ? "" : fmt::format("camera={}\n", frame.note), description_.digest, header,
                        row, seal_label, unsealed);
    results_->write(image_path(image), sealed(frame_bytes(frame.values, description_.type, description_.pitch, text)));

    const std::scoped_lock lock(mutex_);
    const bool first = ledger_header_.empty();
    ledger_header_ = header;
    ledger_rows_[index] = row;
    notes_[index] = frame.note;
    if (shard_.is_whole()) {
        // The row is for users who watch; if it is lost, it is still in the image, and the next opening writes the file
        // anew.
        append_line(folder() / ledger_name, (first ? header + "\n" : "") + row);
    }
    append_timing(fmt::format("image {}", image), exposure.seconds, static_cast<double>(exposure.rays));
}

void ImageStore::write_ledger() {
    std::string text = ledger_header_.empty() ? "" : ledger_header_ + "\n";
    for (const std::string& row : ledger_rows_) {
        text += row.empty() ? "" : row + "\n";
    }
    results_->write(ledger_name, text);
}

namespace {

void append_timing_to(const fs::path& path, const std::string& what, double seconds, double rays) {
    std::error_code none;
    if (!fs::exists(path, none)) {
        append_line(path, timings_header);
    }
    append_line(path, fmt::format("{},{:.6g},{}", csv_cell(what), seconds,
                                  rays > 0 && seconds > 0 ? fmt::format("{:.6g}", rays / seconds) : ""));
}

} // namespace

void append_timing(const fs::path& folder, const std::string& what, double seconds, double rays) {
    append_timing_to(folder / timings_name({}), what, seconds, rays);
}

void ImageStore::append_timing(const std::string& what, double seconds, double rays) const {
    append_timing_to(folder() / timings_name(shard_), what, seconds, rays);
}

// Appends the timings of shards to the stack's own.
void ImageStore::gather_timings() {
    std::vector<fs::path> parts;
    std::error_code error;
    for (fs::directory_iterator entry(folder(), error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with("timings_") && name.ends_with(".csv")) {
            parts.push_back(entry->path());
        }
    }
    std::ranges::sort(parts);
    const fs::path path = folder() / timings_name({});
    for (const fs::path& part : parts) {
        std::string rows = read_file(part);
        if (fs::exists(path, error) && rows.starts_with(timings_header)) {
            rows.erase(0, timings_header.size() + 1);
        }
        while (rows.ends_with('\n')) {
            rows.pop_back();
        }
        if (!rows.empty()) {
            append_line(path, rows);
        }
        fs::remove(part, error);
    }
}

} // namespace vkfv::scan
