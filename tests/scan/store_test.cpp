#include "scan/store.hpp"

#include "core/messages/error.hpp"
#include "fake_stack.hpp"
#include "scan/stack_file.hpp"
#include "scan/stack_identity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <future>

namespace fs = std::filesystem;
using namespace vkfv;
using namespace vkfv::scan;
using namespace vkfv::scan::test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

// A reader of little-endian TIFF in uncompressed strips after the TIFF 6.0 specification, independent of the
// writer.
class RawTiff {
  public:
    explicit RawTiff(std::string bytes) : bytes_(std::move(bytes)) {
        EXPECT_EQ(bytes_.substr(0, 4), std::string("II*\0", 4));
        const auto directory = at<std::uint32_t>(4);
        for (int i = 0; i < at<std::uint16_t>(directory); ++i) {
            const std::size_t entry = directory + 2 + 12 * i;
            offsets_[at<std::uint16_t>(entry)] = entry;
        }
    }
    bool has(int tag) const { return offsets_.contains(tag); }
    std::uint32_t number(int tag, std::uint32_t index = 0) const {
        const std::size_t entry = offsets_.at(tag);
        const int size = at<std::uint16_t>(entry + 2) == 3 ? 2 : 4; // SHORT or LONG
        const std::size_t place = data(entry, size) + size * index;
        return size == 2 ? at<std::uint16_t>(place) : at<std::uint32_t>(place);
    }
    double rational(int tag) const {
        const std::size_t place = data(offsets_.at(tag), 8);
        return static_cast<double>(at<std::uint32_t>(place)) / at<std::uint32_t>(place + 4);
    }
    std::string text(int tag) const {
        const std::size_t entry = offsets_.at(tag);
        return bytes_.substr(data(entry, 1), at<std::uint32_t>(entry + 4) - 1);
    }
    float pixel(int column, int row) const {
        const std::uint32_t rows_per_strip = number(278);
        const std::size_t strip = number(273, row / rows_per_strip);
        return at<float>(strip + 4 * (row % rows_per_strip * number(256) + column));
    }

  private:
    template <class Value>
    Value at(std::size_t place) const {
        Value value;
        std::memcpy(&value, bytes_.substr(place, sizeof(Value)).data(), sizeof(Value));
        return value;
    }
    std::size_t data(std::size_t entry, int size) const {
        return at<std::uint32_t>(entry + 4) * size <= 4 ? entry + 8 : at<std::uint32_t>(entry + 8);
    }
    std::string bytes_;
    std::map<int, std::size_t> offsets_;
};

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string opening_message(const fs::path& folder, const StackDescription& description = describe()) {
    return message_of([&] { ImageStore store(folder, description); });
}

TEST(ImageStore, WritesFluxWithTheHighestRowFirst) {
    const FreshFolder folder("pixels");
    run(folder.path(), FakeTracer(), describe());
    for (int image = 0; image < 4; ++image) {
        const RawTiff tiff(bytes_of(folder.path() / fmt::format("images/z_000{}.tif", image)));
        ASSERT_EQ(tiff.number(256), 5u);
        ASSERT_EQ(tiff.number(257), 3u);
        ASSERT_EQ(tiff.number(258), 32u); // bits
        ASSERT_EQ(tiff.number(259), 1u);  // no compression
        ASSERT_EQ(tiff.number(339), 3u);  // floating point
        const double z = describe().positions[image];
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                EXPECT_EQ(tiff.pixel(column, row), static_cast<float>(flux(column, rows - 1 - row, z, image, 1)));
            }
        }
    }
}

TEST(ImageStore, ImagesTellTheirPitchHeightAndDistance) {
    const FreshFolder folder("tags");
    run(folder.path(), FakeTracer(), describe());
    const RawTiff tiff(bytes_of(folder.path() / "images/z_0002.tif"));
    EXPECT_EQ(tiff.number(296), 3u); // centimetres
    EXPECT_NEAR(tiff.rational(282), 5000,
                5000e-6); // pixels per cm at 2 um; a float's rounding is far below 1e-6
    const std::string text = tiff.text(270);
    EXPECT_THAT(text, testing::StartsWith("ImageJ="));
    EXPECT_THAT(text, HasSubstr("\nunit=um\nspacing=0.8\n"));
    EXPECT_THAT(text, HasSubstr("\nimage=2\nz_um=0.4\n"));
}

// The pages of images.tif are read by ImageJ's rule: all values stand behind each other up to the file's end.
TEST(ImageStore, AllImagesInOneFileAreTheSingleOnes) {
    const FreshFolder folder("stack_file");
    run(folder.path(), FakeTracer(), describe());
    ImageStore store(folder.path(), describe());
    write_stack_file(store);
    store.results().write_checksums();
    const std::string bytes = bytes_of(folder.path() / stack_file_name);
    EXPECT_THAT(bytes, HasSubstr("\nslices=4\nunit=um\nspacing=0.8\nzorigin=1.5\n"));
    std::size_t place = bytes.size() - 4 * rows * columns * sizeof(float);
    for (int image = 0; image < 4; ++image) {
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column, place += sizeof(float)) {
                float value = 0;
                std::memcpy(&value, bytes.data() + place, sizeof value);
                EXPECT_EQ(value, static_cast<float>(flux(column, rows - 1 - row, describe().positions[image],
                                                         static_cast<std::uint32_t>(image), 1)));
            }
        }
    }
    EXPECT_LE(bytes.size(), stack_file_bytes(4, rows * columns, PixelType::float32));
    // The file of all images has a checksum, and a damaged image does not enter it.
    EXPECT_THAT(bytes_of(folder.path() / "checksums.sha256"), HasSubstr(std::string(stack_file_name)));
    write_bytes(folder.path() / "images/z_0002.tif", "no image");
    EXPECT_THROW(write_stack_file(store), InputError);
    EXPECT_EQ(bytes_of(folder.path() / stack_file_name), bytes);
}

TEST(ImageStore, FramesReadBackWithTheLowestRowFirst) {
    const FreshFolder folder("frames");
    run(folder.path(), FakeTracer(), describe());
    const double z = describe().positions[1];
    const Grid<float> frame = read_frame(folder.path(), 1, z);
    ASSERT_EQ(frame.columns, columns);
    ASSERT_EQ(frame.rows, rows);
    EXPECT_EQ(frame(4, 0), static_cast<float>(flux(4, 0, z, 1, 1)));
    EXPECT_EQ(frame(0, 2), static_cast<float>(flux(0, 2, z, 1, 1)));
    EXPECT_THAT(message_of([&] { read_frame(folder.path(), 1, z + 1e-4); }), HasSubstr("expected the focal height"));
    EXPECT_THAT(message_of([&] { read_frame(folder.path(), 9, z); }), HasSubstr("z_0009.tif"));
}

TEST(ImageStore, LedgerHasARowAnImageThatReadsBackExactly) {
    const FreshFolder folder("ledger");
    run(folder.path(), FakeTracer(), describe());
    std::istringstream lines(bytes_of(folder.path() / "ledger.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "image,z_um,rays,detected_rays,emitted_W,detected_W,\"vignetted at imaging 3 (10x, back)_W\","
                    "residual_W");
    const char* heights[] = {"-1.2", "-0.4", "0.4", "1.2"};
    for (int image = 0; image < 4; ++image) {
        ASSERT_TRUE(std::getline(lines, line));
        EXPECT_THAT(line, testing::StartsWith(fmt::format("{},{},1000,{},1,", image, heights[image], 100 + image)));
        std::vector<double> numbers;
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');) {
            numbers.push_back(std::stod(field));
        }
        ASSERT_EQ(numbers.size(), 8u);
        const trace::Image exposure = FakeTracer().expose(0, image);
        EXPECT_EQ(numbers[5], exposure.ledger.entries[0].power);
        EXPECT_EQ(numbers[6], exposure.ledger.entries[1].power);
        EXPECT_EQ(numbers[7], exposure.ledger.residual());
    }
    EXPECT_FALSE(std::getline(lines, line));
}

TEST(ImageStore, KeepsWholeImagesAndTracesTheOthers) {
    const FreshFolder folder("continue");
    const FakeTracer first;
    EXPECT_FALSE(run(folder.path(), first, describe(), {.index = 1, .count = 2}).complete);
    EXPECT_THAT(first.exposed, ElementsAre(1, 3));
    const FakeTracer second;
    const StackSummary summary = run(folder.path(), second, describe());
    EXPECT_THAT(second.exposed, ElementsAre(0, 2));
    EXPECT_EQ(summary.kept, 2);
    EXPECT_EQ(summary.traced, 2);
    EXPECT_EQ(summary.rays, 2 * rays);
    EXPECT_TRUE(summary.complete);
    const FakeTracer third;
    run(folder.path(), third, describe());
    EXPECT_THAT(third.exposed, IsEmpty());
}

TEST(ImageStore, ShardsOfSeparateFoldersMakeOneStack) {
    const FreshFolder whole("whole");
    const FreshFolder even("even");
    const FreshFolder odd("odd");
    run(whole.path(), FakeTracer(), describe());
    run(even.path(), FakeTracer(), describe(), {0, 2});
    run(odd.path(), FakeTracer(), describe(), {1, 2});
    {
        ImageStore merged(even.path(), describe());
        EXPECT_FALSE(merged.complete());
        EXPECT_FALSE(merged.take(2, odd.path())); // image 2 belongs to the even shard
        EXPECT_TRUE(merged.take(1, odd.path()));
        EXPECT_TRUE(merged.take(3, odd.path()));
        EXPECT_TRUE(merged.complete());
    }
    const FakeTracer none;
    EXPECT_TRUE(run(even.path(), none, describe()).complete);
    EXPECT_THAT(none.exposed, IsEmpty());
    EXPECT_EQ(differing_files(result_of(even.path()), result_of(whole.path())), "");
    EXPECT_TRUE(fs::exists(odd.path() / "timings_2_of_2.csv"));
    EXPECT_FALSE(fs::exists(even.path() / "timings_1_of_2.csv")); // it has become part of timings.csv
    EXPECT_THAT(bytes_of(even.path() / "timings.csv"), HasSubstr("image 2"));
}

TEST(ImageStore, ShardsTakeWholeImagesOfTheirStackAlone) {
    const FreshFolder whole("whole");
    const FreshFolder odd("odd");
    const FreshFolder seed("seed");
    run(odd.path(), FakeTracer(), describe(), {1, 2});
    run(seed.path(), FakeTracer(2), describe(4, 2));
    std::string bytes = bytes_of(odd.path() / image_path(3));
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_bytes(odd.path() / image_path(3), bytes);
    ImageStore merged(whole.path(), describe());
    EXPECT_TRUE(merged.take(1, odd.path()));
    EXPECT_THROW(merged.take(3, odd.path()), InputError);
    EXPECT_THROW(merged.take(2, seed.path()), InputError);
    EXPECT_NE(identity_differences(stored_identity(seed.path()), describe().identity), "");
    EXPECT_EQ(identity_differences(stored_identity(odd.path()), describe().identity), "");
}

// Tables of an array have the same keys: a difference in any of them is one.
TEST(StackIdentity, TellsTheTablesOfAnArrayApart) {
    const std::string two = "\n[[source]]\nflux_W = 1\n\n[source.spectrum]\nkind = \"lines\"\n"
                            "\n[[source]]\nflux_W = 3\n\n[source.spectrum]\nkind = \"lines\"\n\n[trace]\nseed = 1\n";
    EXPECT_EQ(identity_differences(two, two), "");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string other = two;
        other.replace(other.find(from), from.size(), to);
        return identity_differences(two, other);
    };
    EXPECT_EQ(with("flux_W = 1", "flux_W = 2"), "\n  source[0].flux_W: 1 there, 2 here");
    EXPECT_EQ(with("flux_W = 3", "flux_W = 2"), "\n  source[1].flux_W: 3 there, 2 here");
    EXPECT_EQ(with("\"lines\"", "\"table\""), "\n  source[0].spectrum.kind: \"lines\" there, \"table\" here");
    EXPECT_EQ(with("[[source]]\nflux_W = 3", "[[source]]\nflux_W = 3\n[[source]]"),
              "\n  source[1].spectrum.kind: \"lines\" there, absent here"
              "\n  source[2].spectrum.kind: absent there, \"lines\" here");
    EXPECT_EQ(with("seed = 1", "seed = 2"), "\n  trace.seed: 1 there, 2 here");
}

TEST(ImageStore, ShardsShareAFolder) {
    const FreshFolder whole("whole");
    const FreshFolder shared("shared");
    run(whole.path(), FakeTracer(), describe(9));
    {
        // All shards write at a time; nobody else may, nor the same shard twice.
        ImageStore first(shared.path(), describe(9), {0, 3});
        ImageStore second(shared.path(), describe(9), {1, 3});
        EXPECT_THROW(ImageStore(shared.path(), describe(9)), FolderInUse);
        EXPECT_THROW(ImageStore(shared.path(), describe(9), {1, 3}), FolderInUse);
        EXPECT_THROW(ImageStore(shared.path(), describe(9, 2), {2, 3}), InputError);
        std::vector<std::jthread> threads;
        for (ImageStore* store : {&first, &second}) {
            threads.emplace_back([store] {
                std::ostringstream nowhere;
                Progress progress(nowhere, Progress::Style::quiet);
                run_stack(FakeTracer(), *store, progress);
            });
        }
        threads.emplace_back([&] { run(shared.path(), FakeTracer(), describe(9), {2, 3}); });
    }
    const FakeTracer none;
    EXPECT_TRUE(run(shared.path(), none, describe(9)).complete);
    EXPECT_THAT(none.exposed, IsEmpty());
    EXPECT_EQ(differing_files(result_of(shared.path()), result_of(whole.path())), "");
}

TEST(Stack, ShowsEveryImageOnceInOrderAsItIsStored) {
    const FreshFolder folder("shown");
    const auto show = [&](const FakeTracer& tracer) {
        ImageStore store(folder.path(), describe());
        std::ostringstream nowhere;
        Progress progress(nowhere, Progress::Style::quiet);
        std::vector<int> images;
        std::vector<std::vector<float>> fluxes;
        run_stack(tracer, store, progress, [&](int image, Grid<float> flux) {
            images.push_back(image);
            fluxes.push_back(std::move(flux.values));
        });
        EXPECT_THAT(images, ElementsAre(0, 1, 2, 3));
        for (std::size_t k = 0; k < fluxes.size(); ++k) {
            EXPECT_EQ(fluxes[k], read_frame(folder.path(), static_cast<int>(k), describe().positions[k]).values);
        }
    };
    show(FakeTracer());
    fs::remove(folder.path() / "images/z_0002.tif");
    const FakeTracer again;
    show(again);
    EXPECT_THAT(again.exposed, ElementsAre(2));
}

// Pixels, directory and text all stand under the image's checksum.
TEST(ImageStore, NoFlippedBitOfAnImagePasses) {
    const FreshFolder folder("flipped");
    run(folder.path(), FakeTracer(), describe());
    EXPECT_THAT(check_images(folder.path()).damages, IsEmpty());
    const fs::path file = folder.path() / "images/z_0001.tif";
    const std::string whole = bytes_of(file);
    for (std::size_t place = 0; place < whole.size(); ++place) {
        std::string flipped = whole;
        flipped[place] ^= static_cast<char>(1 << place % 8);
        write_bytes(file, flipped);
        EXPECT_THROW(read_frame(folder.path(), 1, describe().positions[1]), InputError) << place;
        EXPECT_EQ(check_images(folder.path()).damages.size(), 1u) << place;
    }
    write_bytes(file, whole);
    EXPECT_THAT(check_images(folder.path()).damages, IsEmpty());
    EXPECT_EQ(check_images(folder.path()).files.size(), 4u);
}

// Every state that a kill or a disk may leave behind heals to the bytes of an undisturbed run.
TEST(ImageStore, HealsWhatIsDamaged) {
    const FreshFolder whole("undisturbed");
    run(whole.path(), FakeTracer(), describe());
    const auto expected = result_of(whole.path());
    const std::string tiff = bytes_of(whole.path() / "images/z_0001.tif");
    const FreshFolder other("other");
    run(other.path(), FakeTracer(2), describe(4, 2));
    const std::string foreign = bytes_of(other.path() / "images/z_0001.tif");
    std::string without_row = tiff;
    without_row.replace(without_row.find("ledger_row="), 11, "ledger_ruw=");

    std::string flipped_bit = tiff;
    flipped_bit.back() ^= 1; // the last pixel's exponent

    const auto image = fs::path("images") / "z_0001.tif";
    struct Damage {
        std::string name;
        fs::path file;
        std::string bytes;
        int retraced;
        int reported;
    };
    const std::vector<Damage> damages{
        {"empty image", image, "", 1, 1},
        {"header only", image, tiff.substr(0, 8), 1, 1},
        {"last byte missing", image, tiff.substr(0, tiff.size() - 1), 1, 1},
        {"a bit fell over", image, flipped_bit, 1, 1},
        {"no TIFF", image, "<html>", 1, 1},
        {"another image of the stack", image, bytes_of(whole.path() / "images/z_0002.tif"), 1, 1},
        {"an image of another stack", image, foreign, 1, 1},
        {"no ledger row", image, without_row, 1, 1},
        {"image put aside", "images/.z_0003.tif.part", tiff.substr(0, 100), 0, 0},
        {"configuration put aside", ".stack.toml.part", "[trace]", 0, 0},
        {"half a row", "ledger.csv", "image,z_um\n0,-1", 0, 0},
        {"empty ledger", "ledger.csv", "", 0, 0},
    };
    for (const Damage& damage : damages) {
        SCOPED_TRACE(damage.name);
        const FreshFolder folder("damaged");
        fs::copy(whole.path(), folder.path(), fs::copy_options::recursive);
        write_bytes(folder.path() / damage.file, damage.bytes);
        ASSERT_TRUE(result_of(folder.path()) != expected);
        EXPECT_EQ(ImageStore(folder.path(), describe()).damaged().size(), damage.reported);
        const FakeTracer tracer;
        run(folder.path(), tracer, describe());
        EXPECT_EQ(tracer.exposed.size(), damage.retraced);
        EXPECT_EQ(differing_files(result_of(folder.path()), expected), "");
    }
}

TEST(ImageStore, AFolderLeftBeforeItsConfigurationWasWrittenIsNew) {
    const FreshFolder folder("begun");
    fs::create_directories(folder.path());
    write_bytes(folder.path() / ".lock", "");
    write_bytes(folder.path() / ".stack.toml.part", "[tra");
    EXPECT_TRUE(run(folder.path(), FakeTracer(), describe()).complete);
}

TEST(ImageStore, RefusesAnotherConfigurationAndNamesEachKey) {
    const FreshFolder folder("refused");
    run(folder.path(), FakeTracer(), describe());
    const auto before = result_of(folder.path());
    StackDescription other = describe(4, 2);
    other.identity += "max_bounces = 2\n[specimen]\nkind = \"step\"\n";
    other.identity.erase(other.identity.find("rays"), std::string("rays = 1000\n").size());
    const std::string message = opening_message(folder.path(), other);
    EXPECT_THAT(message, HasSubstr("\n  trace.seed: 1 there, 2 here"));
    EXPECT_THAT(message, HasSubstr("\n  trace.rays: 1000 there, absent here"));
    EXPECT_THAT(message, HasSubstr("\n  trace.max_bounces: absent there, 2 here"));
    EXPECT_THAT(message, HasSubstr("\n  specimen.kind: absent there, \"step\" here"));
    EXPECT_THAT(message, Not(HasSubstr("program")));
    EXPECT_THAT(message, HasSubstr("Give another --out, or remove the folder"));
    EXPECT_EQ(differing_files(result_of(folder.path()), before), "");
}

TEST(ImageStore, TheConfigurationMayChangeWhereTheIdentityDoesNot) {
    const FreshFolder folder("reevaluated");
    run(folder.path(), FakeTracer(), describe());
    StackDescription other = describe();
    other.configuration = "[trace]\nseed = 1\n\n[topography]\nwindow_px = 9\n";
    const FakeTracer tracer;
    run(folder.path(), tracer, other);
    EXPECT_THAT(tracer.exposed, IsEmpty());
    EXPECT_THAT(bytes_of(folder.path() / "stack.toml"), testing::EndsWith(other.configuration));
    EXPECT_THAT(bytes_of(folder.path() / "stack.toml"), HasSubstr("#: program = \"vkfv 0\"\n"));
}

TEST(ImageStore, RefusesWhatIsNoStack) {
    const FreshFolder folder("foreign");
    fs::create_directories(folder.path());
    write_bytes(folder.path() / "thesis.tex", "years of work");
    EXPECT_THAT(opening_message(folder.path()), HasSubstr("without stack.toml"));
    EXPECT_THAT(opening_message(folder.path() / "thesis.tex"), HasSubstr("expected a folder"));
    EXPECT_THROW(ImageStore(folder.path() / "thesis.tex" / "out", describe()), RunError);
    write_bytes(folder.path() / "stack.toml", "[trace]\nseed = 1\n"); // a user's own file, not an output's
    EXPECT_THAT(opening_message(folder.path()), HasSubstr("without the identity of a stack"));
    EXPECT_EQ(result_of(folder.path()).at("thesis.tex"), "years of work");
}

TEST(ImageStore, OneProgramAtATime) {
    const FreshFolder folder("locked");
    {
        const ImageStore holder(folder.path(), describe());
        EXPECT_THROW(ImageStore(folder.path(), describe()), FolderInUse);
    }
    EXPECT_EQ(opening_message(folder.path()), "");
}

// A tracer that counts the images that a device has at a time; images that are stored are not begun again.
class AheadTracer final : public FakeTracer {
  public:
    std::future<trace::Image>
    begin(trace::FocalPosition position, std::uint32_t image,
          std::shared_ptr<const trace::Checkpoints> /*checkpoints*/ = nullptr) const override {
        ++under_way_;
        most = std::max(most, under_way_);
        return std::async(std::launch::deferred, [this, position, image] {
            --under_way_;
            return expose(position, image);
        });
    }
    int most_under_way() const override { return 3; }
    mutable int most = 0;

  private:
    mutable int under_way_ = 0;
};

TEST(RunStack, BeginsAheadAndKeepsTheOrder) {
    const FreshFolder one("one_by_one");
    const FreshFolder ahead("ahead");
    const auto description = describe(9);
    run(one.path(), FakeTracer(), description);
    run(ahead.path(), FakeTracer(), description, {.index = 1, .count = 3}); // 1, 4, 7
    const AheadTracer tracer;
    ImageStore store(ahead.path(), description);
    std::ostringstream nowhere;
    Progress progress(nowhere, Progress::Style::quiet);
    std::vector<int> visited;
    const auto summary = run_stack(tracer, store, progress, [&](int image, const Grid<float>& flux) {
        visited.push_back(image);
        const double z = description.positions[static_cast<std::size_t>(image)];
        EXPECT_EQ(flux.values, read_frame(one.path(), image, z).values);
    });
    EXPECT_EQ(tracer.most, 3);
    EXPECT_THAT(tracer.exposed, ElementsAre(0, 2, 3, 5, 6, 8));
    EXPECT_THAT(visited, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
    EXPECT_EQ(summary.traced, 6);
    EXPECT_EQ(summary.kept, 3);
    EXPECT_TRUE(summary.complete);
    for (int image = 0; image < 9; ++image) {
        EXPECT_EQ(bytes_of(one.path() / image_path(image)), bytes_of(ahead.path() / image_path(image)));
    }
    EXPECT_EQ(bytes_of(one.path() / "ledger.csv"), bytes_of(ahead.path() / "ledger.csv"));
}

TEST(RunStack, AnExceptionOfTheTraceLeavesWhatIsStored) {
    class Failing : public FakeTracer {
        trace::Image expose(trace::FocalPosition z, std::uint32_t image) const override {
            return image == 2 ? throw RunError("device lost") : FakeTracer::expose(z, image);
        }
    };
    const FreshFolder folder("failing");
    EXPECT_THROW(run(folder.path(), Failing(), describe()), RunError);
    const FakeTracer tracer;
    run(folder.path(), tracer, describe());
    EXPECT_THAT(tracer.exposed, ElementsAre(2, 3));
}

TEST(RunStack, ADiskThatFailsIsARunThatCanBeContinued) {
    const FreshFolder folder("disk");
    ImageStore store(folder.path(), describe());
    // A folder in the image's place can be neither written nor replaced, whoever runs the test.
    fs::create_directories(folder.path() / "images/z_0002.tif/occupied");
    std::ostringstream nowhere;
    Progress progress(nowhere, Progress::Style::quiet);
    try {
        run_stack(FakeTracer(), store, progress);
        FAIL();
    } catch (const RunError& error) {
        EXPECT_THAT(error.what(), HasSubstr("2 of 4 images are stored"));
        EXPECT_THAT(error.what(), HasSubstr("same command again"));
    }
}

} // namespace
