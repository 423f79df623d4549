// The folder of one stack, from the first image to the last, over as many runs as it takes.
//
//   stack.toml              the configuration, and in comments the identity: all that the images depend on
//   .stack.toml             a copy of it, for repair.hpp
//   images/z_0000.tif ...   one exposure each, float32 W per pixel, or a camera's grey values; the file's first row has
//                           the highest y
//   partial_0007            an exposure that was ended before its time, if it is a long one: checkpoint_files.hpp
//   ledger.csv              a row an image: the fates of its light
//   timings.csv             (timings_2_of_8.csv of a shard) a row an exposure, the device's work and an evaluation, in
//                           the order of their making; no part of the result, since a clock is in it: all others hold
//                           the same bytes however often a run was interrupted
//   checksums.sha256, .lock core/files/result_folder.hpp
//
// Every image carries its row of the ledger and the checksum of its whole file in its ImageDescription, so that
// all become durable in one rename: there is no moment at which a kill leaves one without the other. ledger.csv
// only repeats those rows.
#pragma once

#include "core/files/result_folder.hpp"
#include "core/mathematics/grid.hpp"
#include "trace/interface/tracer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace vkfv::scan {

// Pixel types of images in files. Integers are those of a camera.
enum class PixelType { float32, uint16, uint8 };

// An image as it is stored and evaluated.
struct Frame {
    Grid<float> values;
    std::string note{}; // conversion by a camera, a line that is kept with the image; empty: light
};

// A TIFF of these values: integers are rounded and clipped to their type.
std::string frame_bytes(const Grid<float>& values, PixelType type, double pitch, const std::string& description);

// The properties of a stack.
struct StackDescription {
    // TOML that `vkfv stack` accepts; becomes stack.toml. It may change between runs as long as the identity stays the
    // same.
    std::string configuration;
    // All that the bits of the images depend on (configuration, program, device): lines of `[table]` and `key = value`,
    // a key a line. It contains nothing volatile: no date, no folder.
    std::string identity;
    std::string digest; // digest of the identity, one word; every image has it
    // Focal heights, mm, equidistant; image i is focused at positions[i].
    std::vector<double> positions;
    int columns = 0; // pixels of an image
    int rows = 0;
    double pitch = 0; // pixel pitch, mm in the object plane
    PixelType type = PixelType::float32;
    std::string quantity = "radiant flux per pixel in W"; // quantity of the values
};

// One of `count` parts of a stack: the images whose number leaves the remainder `index`. Several programs trace their
// shards at a time, into one folder or into separate ones; merged they are the same stack as one run makes.
struct Shard {
    int index = 0; // 0 .. count - 1
    int count = 1; // 1: the whole stack

    bool holds(int image) const { return image % count == index; }
    bool is_whole() const { return count == 1; }
};

class ImageStore {
  public:
    // Creates the folder, or continues the stack in it: keeps its intact images of this identity, counts others
    // (damaged, of the wrong size, without their row) as not stored, and removes the unfinished files of a killed run.
    // A shard keeps its images alone, beside other shards; the ledger is written with the whole stack. Throws
    // InputError if the folder holds something else or a stack of another identity (naming each key that differs);
    // FolderInUse if another program is writing to it, RunError if the disk fails.
    ImageStore(const std::filesystem::path& folder, StackDescription description, Shard shard = {});

    const std::filesystem::path& folder() const { return results_->path(); }
    // The folder for results made of the images.
    ResultFolder& results() { return *results_; }
    const StackDescription& description() const { return description_; }
    const Shard& shard() const { return shard_; }
    bool stored(int image) const { return !ledger_rows_[static_cast<std::size_t>(image)].empty(); }
    bool complete() const; // all images of the stack; a shard does not check the others'
    // A sentence on each image file that existed but was damaged.
    const std::vector<std::string>& damaged() const { return damaged_; }

    // Makes one exposure durable; its pixels must be those of the description. It replaces an image stored before.
    // Several threads may store different images, and stored() of others may be called meanwhile. Throws RunError if
    // the disk fails.
    void store(int image, const trace::Image& exposure, const Frame& frame);
    // The note of a stored image.
    const std::string& note(int image) const { return notes_[static_cast<std::size_t>(image)]; }

    // Copies an image unchanged from another folder of the same stack; false if there is none. Throws InputError if it
    // is damaged or belongs to another stack, RunError if the disk fails.
    bool take(int image, const std::filesystem::path& folder);

    // Writes stack.toml again, with a warning, if another program has changed or removed it since. Throws RunError.
    void restore_configuration();
    // Rewrites ledger.csv in the order of the images. Throws RunError.
    void write_ledger();
    // Appends a line to timings.csv, or to the shard's file: see append_timing().
    void append_timing(const std::string& what, double seconds, double rays = 0) const;

  private:
    struct WholeImage;

    void create_or_compare();
    void keep_whole_images();
    void gather_timings();
    WholeImage whole_image(const std::filesystem::path& folder, int image) const;
    void keep(int image, const WholeImage& whole);

    std::unique_ptr<ResultFolder> results_;
    StackDescription description_;
    Shard shard_;
    std::mutex mutex_;                     // guards the ledger
    std::string ledger_header_;            // empty until the first image
    std::vector<std::string> ledger_rows_; // row of each image, without line end; empty: not stored
    std::vector<std::string> notes_;       // note of each image
    std::vector<std::string> damaged_;
};

// The contents of an image file's description.
struct SealedImage {
    std::filesystem::path name; // relative to the stack's folder
    bool whole = false;         // its bytes are those that were stored
    std::string damage;         // reason why it is not intact; empty if it is
    std::string digest;         // digest of its stack's identity
    std::string ledger_row;
};

// The image files of a stack, in the order of their names.
std::vector<SealedImage> sealed_images(const std::filesystem::path& folder);

// Checks the images of a stack, finished or not: whether each is intact and belongs to this stack.
Check check_images(const std::filesystem::path& folder);

// The file of an image, relative to the stack's folder: "images/z_0007.tif".
std::filesystem::path image_path(int image);
// The file of an image's checkpoint while its exposure is unfinished: "partial_0007".
std::filesystem::path checkpoint_path(int image);

// A height in um as text, rounded to a femtometre, so that z = start + i step loses its binary tail but no accuracy.
std::string micrometres_text(double millimetres);

// Values as in a camera's file: rounded, and clipped to the type.
template <class Integer>
Grid<Integer> rounded(const Grid<float>& values) {
    Grid<Integer> result(values.columns, values.rows);
    constexpr double highest = std::numeric_limits<Integer>::max();
    std::ranges::transform(values.values, result.values.begin(), [&](double value) {
        return static_cast<Integer>(std::clamp(std::floor(value + 0.5), 0.0, highest));
    });
    return result;
}

// Light as it is stored, in float32.
Grid<float> as_stored(const Grid<double>& flux);
// Values as a file of this type gives them back.
Grid<float> as_stored(Grid<float> values, PixelType type);

// Appends a line to a folder's timings.csv: the time in s and, for traced rays, their number. Throws RunError.
void append_timing(const std::filesystem::path& folder, const std::string& what, double seconds, double rays = 0);

// The values of a stored image, radiant flux per pixel in W or grey values; row 0 at the lowest y. `z` is its planned
// focal height (mm). Throws InputError, with the remedy, if the image is missing, damaged or of another height: frames
// are read from finished stacks, one at a time, without a store.
Grid<float> read_frame(const std::filesystem::path& folder, int image, double z);

} // namespace vkfv::scan
