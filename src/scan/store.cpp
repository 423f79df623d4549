#include "scan/store.hpp"

#include "core/error.hpp"
#include "core/units.hpp"
#include "surface/image_file.hpp"

#include <OpenImageIO/imageio.h>

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace vkfv::scan {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view configuration_name = "stack.toml";
constexpr std::string_view ledger_name = "ledger.csv";
constexpr std::string_view timings_name = "timings.csv";
constexpr std::string_view images_name = "images";
constexpr std::string_view lock_name = ".lock";
constexpr std::string_view aside_suffix = ".part"; // as surface/image_file.hpp names files put aside
constexpr std::string_view identity_prefix = "#: ";
constexpr double cm_per_um = 1e-4;

[[noreturn]] void refuse(const fs::path& where, std::string found, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = where, .line = 0, .column = 0, .byte_offset = {}},
                      .key = "",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

std::string reason() {
    return std::generic_category().message(errno);
}

// Whole and on the disk under its final name, or not there at all.
void write_durably(const fs::path& path, std::string_view text) {
    fs::path aside = path;
    aside.replace_filename(fmt::format(".{}{}", path.filename().string(), aside_suffix));
    const int file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bool good = file >= 0;
    while (good && !text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        good = written >= 0 || errno == EINTR;
        text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
    good = good && ::fsync(file) == 0;
    const std::string error = good ? "" : reason();
    if (file >= 0) {
        ::close(file);
    }
    if (!good) {
        throw RunError(fmt::format("{}: cannot be written: {}", path.string(), error));
    }
    if (::rename(aside.c_str(), path.c_str()) != 0) {
        throw RunError(
            fmt::format("{}: cannot be renamed to {}: {}", aside.string(), path.string(), reason()));
    }
}

std::string read_text(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) {
        refuse(path, "a file that cannot be read", "the configuration of a stack",
               "Check the permissions, or give another --out.");
    }
    return text.str();
}

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    std::istringstream stream{std::string(text)};
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::string stack_text(const StackDescription& description) {
    std::string text = fmt::format(
        "# A stack of vkfv: its configuration, every default spelled out. `vkfv --stack` takes this file.\n"
        "# What its images depend on (digest {}); a run that differs in any of it is refused here:\n",
        description.digest);
    for (const std::string& line : lines_of(description.identity)) {
        if (!line.empty()) {
            text += fmt::format("{}{}\n", identity_prefix, line);
        }
    }
    return text + "\n" + description.configuration;
}

std::string identity_of(std::string_view stack_text) {
    std::string identity;
    for (const std::string& line : lines_of(stack_text)) {
        if (line.starts_with(identity_prefix)) {
            identity += line.substr(identity_prefix.size()) + "\n";
        }
    }
    return identity;
}

// "[trace]" and "seed = 1" become "trace.seed" -> "1".
std::map<std::string, std::string> values_by_key(std::string_view identity) {
    std::map<std::string, std::string> values;
    std::string table;
    for (const std::string& line : lines_of(identity)) {
        const auto equals = line.find(" = ");
        if (line.starts_with('[')) {
            table = line.substr(1, line.rfind(']') - 1) + ".";
        } else if (equals != std::string::npos) {
            values[table + line.substr(0, equals)] = line.substr(equals + 3);
        }
    }
    return values;
}

// A line for each key whose values differ: "  trace.seed: 1 there, 2 here".
std::string differences(std::string_view there, std::string_view here) {
    const auto old_values = values_by_key(there);
    auto new_values = values_by_key(here);
    std::string text;
    for (const auto& [key, old_value] : old_values) {
        const auto found = new_values.find(key);
        if (found == new_values.end()) {
            text += fmt::format("\n  {}: {} there, absent here", key, old_value);
        } else {
            if (found->second != old_value) {
                text += fmt::format("\n  {}: {} there, {} here", key, old_value, found->second);
            }
            new_values.erase(found);
        }
    }
    for (const auto& [key, new_value] : new_values) {
        text += fmt::format("\n  {}: absent there, {} here", key, new_value);
    }
    return text;
}

// Rounded to a femtometre: z = start + i step loses its binary tail in the text and no height its meaning.
std::string micrometres_text(double millimetres) {
    constexpr double per_micrometre = 1e9;
    // Adding 0 turns -0 into 0.
    return fmt::format("{}", std::round(millimetres * um_per_mm * per_micrometre) / per_micrometre + 0.0);
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char character : text) {
        quoted += character == '"' ? "\"\"" : std::string(1, character);
    }
    return quoted + "\"";
}

std::string ledger_header(const trace::Ledger& ledger) {
    std::string header = "image,z_um,rays,detected_rays,emitted_W";
    for (const auto& entry : ledger.entries) {
        header += "," + csv_field(entry.name + "_W");
    }
    return header + ",residual_W";
}

// Numbers in their shortest form that reads back to the same bits.
std::string ledger_row(int image, double z, const trace::Image& exposure) {
    std::string row = fmt::format("{},{},{},{},{}", image, micrometres_text(z), exposure.rays,
                                  exposure.detected, exposure.ledger.emitted);
    for (const auto& entry : exposure.ledger.entries) {
        row += fmt::format(",{}", entry.power);
    }
    return row + fmt::format(",{}", exposure.ledger.residual());
}

// The value of `key=value` on a line of its own; empty if there is none.
std::string described(const std::string& description, std::string_view key) {
    const std::string label = fmt::format("\n{}=", key);
    const auto at = description.find(label);
    if (at == std::string::npos) {
        return "";
    }
    const auto begin = at + label.size();
    return description.substr(begin, description.find('\n', begin) - begin);
}

std::string image_description(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) {
        refuse(path, OIIO::geterror(), "a readable TIFF image",
               "Trace the stack again with the same command.");
    }
    return input->spec().get_string_attribute("ImageDescription");
}

// FNV-1a, 64 bits (Fowler, Noll, Vo), over the pixels as they are in memory. A reader of TIFF may fill up a
// truncated file with zeros, and no reader finds a bit that fell over.
std::string pixel_digest(const Grid<float>& image) {
    std::uint64_t digest = 0xcbf29ce484222325u;
    for (const std::byte byte : std::as_bytes(std::span(image.values))) {
        digest = (digest ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
    }
    return fmt::format("{:016x}", digest);
}

bool holds_nothing_but_a_beginning(const fs::path& folder) {
    return std::all_of(
        fs::directory_iterator(folder), fs::directory_iterator(), [](const fs::directory_entry& entry) {
            const std::string name = entry.path().filename().string();
            return name == lock_name || name == fmt::format(".{}{}", configuration_name, aside_suffix);
        });
}

void remove_files_put_aside(const fs::path& folder) {
    std::vector<fs::path> leftovers;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file() && entry.path().extension() == aside_suffix) {
            leftovers.push_back(entry.path());
        }
    }
    for (const fs::path& leftover : leftovers) {
        fs::remove(leftover);
    }
}

// The kernel drops the lock with the process, so that a kill leaves none behind.
int lock_folder(const fs::path& folder) {
    const fs::path path = folder / lock_name;
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) {
        refuse(folder, reason(), "a folder that can be written to",
               "Check its permissions, or give another --out.");
    }
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) {
            ::close(file);
            refuse(folder, "a folder that another vkfv is writing to", "a stack that nobody else writes",
                   "Wait for the other run to end, or give another --out.");
        }
        spdlog::warn("{}: this file system offers no locks ({}): see to it that no second run writes here",
                     folder.string(), reason());
    }
    return file;
}

} // namespace

fs::path image_path(int image) {
    return fs::path(images_name) / fmt::format("z_{:04}.tif", image);
}

Grid<float> as_stored(const Grid<double>& flux) {
    Grid<float> stored(flux.columns, flux.rows);
    std::transform(flux.values.begin(), flux.values.end(), stored.values.begin(),
                   [](double power) { return static_cast<float>(power); });
    return stored;
}

Grid<float> read_frame(const fs::path& folder, int image, double z) {
    const fs::path path = folder / image_path(image);
    Grid<float> frame = surface::read_image(path);
    const std::string text = image_description(path);
    if (described(text, "pixels") != pixel_digest(frame)) {
        refuse(path, "pixels that are not those stored", "a whole image of a stack",
               "Trace the stack again with the same command: it keeps the other images.");
    }
    const std::string found = described(text, "z_um");
    if (found != micrometres_text(z)) {
        refuse(path, fmt::format("z_um = {}", found.empty() ? "none" : found),
               fmt::format("the focal height {} um", micrometres_text(z)),
               "Keep the images of different stacks apart, or trace the stack again.");
    }
    return frame;
}

ImageStore::ImageStore(fs::path folder, StackDescription description)
    : folder_(std::move(folder)), description_(std::move(description)),
      ledger_rows_(description_.positions.size()) {
    try {
        if (fs::exists(folder_) && !fs::is_directory(folder_)) {
            refuse(folder_, "a file", "a folder", "Give another --out.");
        }
        if (fs::exists(folder_) && !fs::exists(folder_ / configuration_name) &&
            !holds_nothing_but_a_beginning(folder_)) {
            refuse(folder_, fmt::format("a folder with other files and without {}", configuration_name),
                   "a new folder, an empty one, or that of the same stack", "Give another --out.");
        }
        fs::create_directories(folder_);
        lock_ = lock_folder(folder_);
        create_or_compare();
        fs::create_directories(folder_ / images_name);
        remove_files_put_aside(folder_);
        remove_files_put_aside(folder_ / images_name);
        keep_whole_images();
        write_ledger();
    } catch (const fs::filesystem_error& error) {
        if (lock_ >= 0) {
            ::close(lock_);
        }
        refuse(folder_, error.code().message(), "a folder that can be written to",
               "Check the path and its permissions, or give another --out.");
    } catch (...) {
        if (lock_ >= 0) {
            ::close(lock_);
        }
        throw;
    }
}

ImageStore::~ImageStore() {
    ::close(lock_);
}

void ImageStore::create_or_compare() const {
    const fs::path path = folder_ / configuration_name;
    const std::string text = stack_text(description_);
    if (!fs::exists(path)) {
        write_durably(path, text);
        return;
    }
    const std::string text_there = read_text(path);
    const std::string identity_there = identity_of(text_there);
    if (identity_there.empty()) {
        refuse(path, "a file without the identity of a stack", "the stack.toml of a stack that vkfv traced",
               "Give another --out: the configuration belongs outside of the output folder.");
    }
    const std::string difference = differences(identity_there, description_.identity);
    if (!difference.empty()) {
        refuse(path, "a stack of another configuration", "the configuration of this run",
               "Give another --out, or remove the folder. What differs:" + difference);
    }
    // What does not touch the images, such as the evaluation, may differ.
    if (text_there != text) {
        write_durably(path, text);
    }
}

void ImageStore::keep_whole_images() {
    for (std::size_t i = 0; i < ledger_rows_.size(); ++i) {
        const int image = static_cast<int>(i);
        const fs::path path = folder_ / image_path(image);
        if (!fs::exists(path)) {
            continue;
        }
        try {
            const Grid<float> frame = read_frame(folder_, image, description_.positions[i]);
            const std::string text = image_description(path);
            const std::string header = described(text, "ledger_columns");
            const std::string row = described(text, "ledger_row");
            if (frame.columns != description_.columns || frame.rows != description_.rows) {
                damaged_.push_back(fmt::format("{}: {} x {} pixels where {} x {} belong", path.string(),
                                               frame.columns, frame.rows, description_.columns,
                                               description_.rows));
            } else if (described(text, "stack") != description_.digest) {
                damaged_.push_back(fmt::format("{}: an image of another stack", path.string()));
            } else if (row.empty() || (!ledger_header_.empty() && header != ledger_header_)) {
                damaged_.push_back(fmt::format("{}: its row of the ledger is missing", path.string()));
            } else {
                ledger_header_ = header;
                ledger_rows_[i] = row;
            }
        } catch (const InputError& error) {
            damaged_.push_back(fmt::format("{}: {}", path.string(), error.problem().found));
        }
    }
}

bool ImageStore::complete() const {
    return std::none_of(ledger_rows_.begin(), ledger_rows_.end(),
                        [](const std::string& row) { return row.empty(); });
}

void ImageStore::store(int image, const trace::Image& exposure) {
    const auto index = static_cast<std::size_t>(image);
    if (exposure.flux.columns != description_.columns || exposure.flux.rows != description_.rows) {
        throw std::logic_error("an exposure of another size than the stack's");
    }
    const double z = description_.positions.at(index);
    const std::string header = ledger_header(exposure.ledger);
    const std::string row = ledger_row(image, z, exposure);

    const Grid<float> flux = as_stored(exposure.flux);
    // The first lines are what ImageJ and Fiji take the distance of the images from; it is in the unit of the
    // resolution tags. A stack of one image has none.
    std::string text = "ImageJ=1.11a\nunit=cm\n";
    if (description_.positions.size() > 1) {
        text += fmt::format("spacing={:.12g}\n",
                            (description_.positions[1] - description_.positions[0]) * um_per_mm * cm_per_um);
    }
    text += fmt::format(
        "image={}\nz_um={}\nvalues=radiant flux per pixel in W\nfirst_row=highest y\npixels={}\nstack={}\n"
        "ledger_columns={}\nledger_row={}\n",
        image, micrometres_text(z), pixel_digest(flux), description_.digest, header, row);
    surface::write_tiff(folder_ / image_path(image), flux,
                        {.pitch_x = description_.pitch, .pitch_y = description_.pitch, .description = text});

    const bool first = ledger_header_.empty();
    ledger_header_ = header;
    ledger_rows_[index] = row;
    // For those who watch; a row lost here is in its image, and the next opening writes the file anew.
    std::ofstream ledger(folder_ / ledger_name, std::ios::app);
    ledger << (first ? header + "\n" : "") << row << "\n";

    const fs::path timings_path = folder_ / timings_name;
    const bool new_timings = !fs::exists(timings_path);
    std::ofstream timings(timings_path, std::ios::app);
    timings << (new_timings ? "image,trace_s,rays_per_s\n" : "")
            << fmt::format("{},{:.6g},{:.6g}\n", image, exposure.seconds,
                           exposure.seconds > 0 ? static_cast<double>(exposure.rays) / exposure.seconds : 0);
}

void ImageStore::write_ledger() const {
    std::string text = ledger_header_.empty() ? "" : ledger_header_ + "\n";
    for (const std::string& row : ledger_rows_) {
        text += row.empty() ? "" : row + "\n";
    }
    write_durably(folder_ / ledger_name, text);
}

} // namespace vkfv::scan
