// On disks that fail, each call by which a command changes files fails once. The command says so, every file is the one
// of before or the new one, whole, and the same command once more ends as if nothing had been.
#include "faults/faults.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

using Arguments = std::vector<std::string>;

constexpr int run_failed = 4;

// The folder of a command's results, below the folder in which it runs.
const std::string results = "results";

Arguments joined(Arguments arguments, const Arguments& further) {
    arguments.insert(arguments.end(), further.begin(), further.end());
    return arguments;
}

// The name that sync_folder() and write_file() use in messages: a file that is being written goes by its final name.
std::string final_name(const fs::path& file) {
    const std::string name = file.filename().string();
    const bool unfinished = name.starts_with('.') && name.ends_with(".part");
    return unfinished ? name.substr(1, name.size() - 6) : name;
}

// The file of text that grows by a line an image, and is written whole at the end.
constexpr const char* growing = "ledger.csv";

bool concerns(const Fault& fault, const char* name) {
    return fs::path(fault.subject).filename() == name;
}

// Whether the command may succeed in spite of this fault.
bool may_pass(const Fault& fault) {
    return fault.effect == "short"                                // the rest is written next
           || (fault.call == "close" && concerns(fault, ".lock")) // nothing was written to it
           || (fault.effect == "lost" && (concerns(fault, "timings.csv") || concerns(fault, growing)));
}

// Whether a list of files may stand so while a sweep runs, which writes it after each image: in whole lines, each of
// the list of before or of the one to be.
bool is_list_between(const std::string& name, const std::string& bytes, const Files& before, const Files& after) {
    if (!name.ends_with("checksums.sha256") || !bytes.ends_with('\n')) {
        return false;
    }
    const auto has_line = [&](const Files& files, const std::string& line) {
        const auto found = files.find(name);
        return found != files.end() && ("\n" + found->second).find("\n" + line + "\n") != std::string::npos;
    };
    std::istringstream lines(bytes);
    for (std::string line; std::getline(lines, line);) {
        if (!has_line(before, line) && !has_line(after, line)) {
            return false;
        }
    }
    return true;
}

// Whether a file is as it was, as it is to be, or a beginning of that in whole lines where it grows.
bool is_whole(const std::string& name, const std::string& bytes, const Files& before, const Files& after) {
    const auto is_in = [&](const Files& files) { return files.contains(name) && files.at(name) == bytes; };
    const bool grows =
        name.ends_with(growing) && after.at(name).starts_with(bytes) && (bytes.empty() || bytes.ends_with('\n'));
    return is_in(before) || is_in(after) || grows || is_list_between(name, bytes, before, after) ||
           name.ends_with(".part");
}

// Whether this call is to fail on a machine with little time: each call that writes is, and of the others some of every
// file and kind.
bool is_taken(const Fault& call, std::size_t place, std::size_t calls) {
    constexpr std::size_t few = 40, step = 11; // a file takes seven calls
    return every_fault() || calls < few || call.call == "write" || place % step == 0;
}

std::vector<std::string> effects_of(const Fault& call) {
    if (call.call == "fsync" || call.call == "close") {
        return {"EIO"};
    }
    if (call.call != "write") {
        return {"ENOSPC"};
    }
    const std::vector<std::string> effects = {"ENOSPC", "short-ENOSPC", "lost", "EIO", "short"};
    return every_fault() ? effects : Arguments{effects[static_cast<std::size_t>(call.number) % effects.size()]};
}

class FileFaults : public testing::Test {
  protected:
    FileFaults() : folder_(fresh_folder("work")) {
        write_file(folder_ / "c.toml",
                   replaced(ideal_configuration(), "[trace]\n", "[trace]\ndevice = \"host\"\n") +
                       "[diffraction]\nmodel = \"none\"\n[sweep]\nz_um = 0\n[[sweep.parameter]]\nkey = "
                       "\"specimen.material.g\"\nvalues = [0.3, 1.0]\n");
    }

    // Three small images are traced on the host and without waves, so that many runs cost little.
    static Arguments traced(const std::string& command, const std::string& out, const Arguments& further = {}) {
        return joined({command, "c.toml", "--out", out, "--rays", "500", "--quiet", "--set", "scan.z_start_um=-1",
                       "--set", "scan.z_stop_um=1"},
                      further);
    }

    void prepare(const Arguments& arguments) {
        fs::create_directories(folder_ / results);
        const auto result = run_program(arguments, folder_);
        ASSERT_EQ(result.exit_code, 0) << fmt::format("{}", arguments) << result.standard_error;
    }

    const fs::path& folder() const { return folder_; }

    // Fails each call of the command that changes a file below `results`, which holds what was prepared there.
    void fail_every_call_of(const Arguments& arguments) {
        fs::create_directories(folder_ / results);
        fs::copy(folder_ / results, folder_ / "kept", fs::copy_options::recursive);
        const Files before = files_below(folder_ / results);

        const auto log = folder_ / "calls.log";
        fs::remove(log);
        Environment counting = preload();
        counting["VKFV_FAULT_LOG"] = log.string();
        const auto undisturbed = run_program(arguments, folder_, counting);
        ASSERT_EQ(undisturbed.exit_code, 0) << undisturbed.standard_error;
        const Files after = files_below(folder_ / results);
        ASSERT_THAT(differing(before, after), Not(IsEmpty())); // it has something to lose

        const auto calls = counted_calls(log);
        std::map<std::string, int> outcomes;
        std::set<Files> states_left;
        for (std::size_t place = 0; place < calls.size(); ++place) {
            ASSERT_NE(calls[place].call, "fopen") << calls[place].subject << " is written past write_file()";
            if (!is_taken(calls[place], place, calls.size())) {
                continue;
            }
            for (const std::string& effect : effects_of(calls[place])) {
                Fault fault = calls[place];
                fault.effect = effect;
                SCOPED_TRACE(text_of(fault));
                fs::remove_all(folder_ / results);
                fs::copy(folder_ / "kept", folder_ / results, fs::copy_options::recursive);
                ++outcomes[fail_once(arguments, fault, before, after)];
                // From the same files the same command goes on in the same way: once is enough.
                if (states_left.insert(files_below(folder_ / results)).second || every_fault()) {
                    expect_a_good_end(arguments, after);
                }
            }
        }
        fmt::print("{} calls, {} states left: {}\n", calls.size(), states_left.size(), outcomes);
    }

  private:
    Environment preload() const {
        // The sanitizer wants to be the first library, but need not be. Leaks are looked for by other tests.
        const char* options = std::getenv("ASAN_OPTIONS");
        return {{"LD_PRELOAD", VKFV_FILE_CALLS},
                {"ASAN_OPTIONS",
                 fmt::format("{}:verify_asan_link_order=0:detect_leaks=0", options != nullptr ? options : "")},
                {"VKFV_FAULT_FOLDER", fs::canonical(folder_ / results).string()}};
    }

    // Returns what became of it, in words.
    std::string fail_once(const Arguments& arguments, const Fault& fault, const Files& before, const Files& after) {
        Environment environment = preload();
        add(environment, fault);
        const auto result = run_program(arguments, folder_, environment);
        if (!may_pass(fault) || result.exit_code != 0) {
            EXPECT_EQ(result.exit_code, run_failed) << result.standard_error;
            const fs::path subject = fault.subject;
            EXPECT_THAT(result.standard_error,
                        AnyOf(HasSubstr(final_name(subject)), HasSubstr(subject.parent_path().filename().string())));
            EXPECT_THAT(result.standard_error, AnyOf(HasSubstr("same command again"), HasSubstr("give another --out")));
            EXPECT_THAT(result.standard_error, Not(HasSubstr("unexpected failure")));
        }
        const Files found = files_below(folder_ / results);
        EXPECT_TRUE(result.exit_code != 0 || found == after);
        for (const auto& [name, bytes] : found) {
            EXPECT_TRUE(is_whole(name, bytes, before, after)) << name;
        }
        return fmt::format("{} {}: exit {}", fault.call, fault.effect, result.exit_code);
    }

    void expect_a_good_end(const Arguments& arguments, const Files& after) const {
        const auto again = run_program(arguments, folder_, preload());
        EXPECT_EQ(again.exit_code, 0) << again.standard_error;
        EXPECT_THAT(differing(files_below(folder_ / results), after), IsEmpty());
    }

    fs::path folder_;
};

TEST_F(FileFaults, OfAStack) {
    fail_every_call_of(traced("--stack", "results/out"));
}

TEST_F(FileFaults, OfAStackThatIsEvaluatedOtherwise) {
    prepare(traced("--stack", "results/out"));
    fail_every_call_of(traced("--stack", "results/out", {"--set", "topography.window_px=5"}));
}

TEST_F(FileFaults, OfAnImage) {
    prepare(traced("--image", "results/out", {"--z", "0"}));
    fail_every_call_of(traced("--image", "results/out", {"--z", "0", "--seed", "2"}));
}

TEST_F(FileFaults, OfASweep) {
    prepare(traced("--sweep", "results/out"));
    fail_every_call_of(traced("--sweep", "results/out", {"--seed", "2"}));
}

TEST_F(FileFaults, OfTheTopographyOfAStack) {
    prepare(traced("--stack", "results/out"));
    fail_every_call_of({"--topography", "results/out", "--set", "topography.window_px=5"});
}

TEST_F(FileFaults, OfTheTopographyOfImages) {
    prepare(traced("--stack", "stack"));
    const Arguments arguments = {"--topography", "stack/images", "--z_step_um", "1", "--pitch_um", "2",
                                 "--out",        "results/out"};
    prepare(arguments);
    fail_every_call_of(joined(arguments, {"--set", "topography.window_px=3"}));
}

TEST_F(FileFaults, OfASurface) {
    prepare(traced("--stack", "stack"));
    for (const char* file : {"results/out.tif", "results/out.x3p"}) {
        SCOPED_TRACE(file);
        fs::remove_all(folder() / "kept");
        const Arguments arguments = {"--surface", "stack/truth.tif", "--out", file};
        prepare(joined(arguments, {"--form", "none"}));
        fail_every_call_of(arguments);
    }
}

TEST_F(FileFaults, OfAComparison) {
    prepare(traced("--stack", "stack"));
    prepare({"--surface", "stack/truth.tif", "--out", "levelled.tif"});
    const Arguments arguments = {"--compare", "levelled.tif", "stack/truth.tif", "--out", "results/out"};
    prepare(joined(arguments, {"--form", "none"}));
    fail_every_call_of(arguments);
}

TEST_F(FileFaults, OfALayout) {
    prepare({"--layout", "c.toml", "results/layout.svg", "--set", "illumination.field_stop_radius_mm=0.3"});
    fail_every_call_of({"--layout", "c.toml", "results/layout.svg"});
}

TEST_F(FileFaults, OfAPrescription) {
    const std::string lenses = VKFV_SOURCE_DIR "/tests/data/zmx/";
    prepare({"--import", lenses + "singlet.zmx", "--out", "results/lens.toml"});
    fail_every_call_of({"--import", lenses + "doublet.zmx", "--out", "results/lens.toml"});
}

} // namespace
} // namespace vkfv::test
