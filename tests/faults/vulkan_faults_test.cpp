// On devices that fail, each call of Vulkan that a command makes fails, once or from then on. The command opens the
// device again and goes on, or says so in words of its own, and run once more it ends in the same bytes.
#include "faults/faults.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
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

constexpr int done = 0, no_device = 3, run_failed = 4;

const std::string lost = "VK_ERROR_DEVICE_LOST", no_device_memory = "VK_ERROR_OUT_OF_DEVICE_MEMORY",
                  no_host_memory = "VK_ERROR_OUT_OF_HOST_MEMORY", other = "VK_ERROR_INITIALIZATION_FAILED";

// Whether the call is made before there is a device that might be lost or full.
bool is_of_the_loader(const Fault& call) {
    return call.call == "vkCreateInstance" || call.call == "vkEnumeratePhysicalDevices" ||
           call.call == "vkEnumerateDeviceExtensionProperties";
}

// Whether nothing is lost without the call's result: compiled kernels are kept for the next run.
bool may_pass(const Fault& call) {
    return call.call == "vkGetPipelineCacheData";
}

// A device that is lost or full is opened again.
bool may_pass_next_time(const Fault& call) {
    return call.effect == lost || call.effect == no_device_memory || call.effect == no_host_memory;
}

// All effects, or the one whose turn it is.
std::vector<std::string> effects_of(const Fault& call, std::size_t turn) {
    const auto effects = is_of_the_loader(call) ? Arguments{no_host_memory, other}
                                                : Arguments{lost, no_device_memory, no_host_memory, other};
    return every_fault() ? effects : Arguments{effects[turn % effects.size()]};
}

// The calls for a machine with little time: one of every name, or of each so many-th; the first of one name, the last
// of the next.
std::vector<Fault> one_of_each(const std::vector<Fault>& calls, std::size_t every) {
    std::map<std::string, std::vector<Fault>> by_name;
    for (const Fault& call : calls) {
        by_name[call.call].push_back(call);
    }
    std::vector<Fault> chosen;
    std::size_t names = calls.size(); // others in each test
    for (const auto& [name, of_that_name] : by_name) {
        if (names++ % every == 0) {
            chosen.push_back(chosen.size() % 2 == 0 ? of_that_name.front() : of_that_name.back());
        }
    }
    return chosen;
}

class VulkanFaults : public testing::Test {
  protected:
    VulkanFaults() : folder_(fresh_folder("work")) { write_file(folder_ / "c.toml", ideal_configuration()); }

    // Traces three small images.
    static Arguments traced(const std::string& command, const Arguments& further) {
        Arguments arguments = {
            command, "c.toml",          "--out", "out", "--rays", "500", "--quiet", "--set", "scan.z_start_um=-1",
            "--set", "scan.z_stop_um=1"};
        arguments.insert(arguments.end(), further.begin(), further.end());
        return arguments;
    }

    void prepare(const Arguments& arguments) {
        const auto result = run_program(arguments, folder_);
        ASSERT_EQ(result.exit_code, done) << result.standard_error;
        fs::rename(folder_ / "out", folder_ / "kept");
    }

    // Fails calls of every name, or of each `every`-th name.
    void fail_every_call_of(const Arguments& arguments, std::size_t every = 1) {
        restore();
        Environment counting = layer();
        const auto log = folder_ / "calls.log";
        counting["VKFV_FAULT_LOG"] = log.string();
        const auto undisturbed = run_program(arguments, folder_, counting);
        ASSERT_EQ(undisturbed.exit_code, done) << undisturbed.standard_error;
        const Files after = files_below(folder_ / "out");

        const auto calls = counted_calls(log);
        std::map<std::string, int> outcomes;
        std::set<Files> states_left;
        std::size_t turn = calls.size(); // another one in each test
        for (const Fault& call : every_fault() ? calls : one_of_each(calls, every)) {
            const auto effects =
                varies_ ? Arguments{is_of_the_loader(call) ? no_host_memory : lost} : effects_of(call, turn++);
            for (const std::string& effect : effects) {
                Fault fault = call;
                fault.effect = effect;
                // A fault that may pass must not stop the program; a fault that lasts must end it with a message.
                fault.lasts = !varies_ && may_pass_next_time(fault) && turn / 4 % 2 == 1;
                // A device that others use too gets its work in other pieces: if the run has fewer calls, its last one
                // fails.
                std::optional<std::string> outcome;
                while (!outcome && fault.number > 0) {
                    SCOPED_TRACE(text_of(fault));
                    restore();
                    outcome = fail_once(arguments, fault, after);
                }
                ++outcomes[outcome.value_or(fmt::format("{} is not made", fault.call))];
                // From the same files the same command goes on in the same way: once is enough.
                if (states_left.insert(files_below(folder_ / "out")).second || every_fault()) {
                    const auto again = run_program(arguments, folder_);
                    EXPECT_EQ(again.exit_code, done) << again.standard_error;
                    EXPECT_THAT(differing(files_below(folder_ / "out"), after), IsEmpty());
                }
            }
        }
        fmt::print("{} calls, {} states left: {}\n", calls.size(), states_left.size(), outcomes);
        EXPECT_EQ(gone_on_ > 0, arguments.front() != "--topography"); // which is begun again in no time
    }

    // Whether the number of calls changes from run to run, so that one that is to fail may not come: each is then lost
    // once.
    bool varies_ = false;

  private:
    // Mesa's own layer asks for extensions too and reads a count that a failed call has not written: it stays out.
    static Environment layer() {
        return {{"VK_ADD_LAYER_PATH", VKFV_BINARY_DIR "/faults"},
                {"VK_INSTANCE_LAYERS", "VK_LAYER_VKFV_faults"},
                {"NODEVICE_SELECT", "1"}};
    }

    void restore() const {
        fs::remove_all(folder_ / "out");
        fs::create_directories(folder_ / "out");
        if (fs::exists(folder_ / "kept")) {
            fs::copy(folder_ / "kept", folder_ / "out", fs::copy_options::recursive);
        }
    }

    // Returns in words, for a summary, how the command ended. Without a value the run did not come to this call, and
    // did all it had to; then the fault becomes that of the last call of the name.
    std::optional<std::string> fail_once(const Arguments& arguments, Fault& fault, const Files& after) {
        Environment environment = layer();
        add(environment, fault);
        const auto log = folder_ / "made.log";
        fs::remove(log);
        environment["VKFV_FAULT_LOG"] = log.string();
        const auto result = run_program(arguments, folder_, environment);
        const std::string& said = result.standard_error;
        const int made = static_cast<int>(std::ranges::count(counted_calls(log), fault.call, &Fault::call));
        if (made < fault.number) {
            EXPECT_EQ(result.exit_code, done) << said;
            EXPECT_THAT(differing(files_below(folder_ / "out"), after), IsEmpty());
            fault.number = made;
            return std::nullopt;
        }
        const bool went_on = result.exit_code == done && may_pass_next_time(fault) && !fault.lasts &&
                             said.find("It is opened again, with half the batch") != std::string::npos;
        if (went_on) {
            EXPECT_THAT(differing(files_below(folder_ / "out"), after), IsEmpty());
        } else if (varies_ && result.exit_code == done) {
            EXPECT_THAT(differing(files_below(folder_ / "out"), after), IsEmpty());
        } else if (!may_pass(fault) || result.exit_code != done) {
            EXPECT_THAT(result.exit_code, AnyOf(no_device, run_failed)) << said;
            EXPECT_THAT(said, HasSubstr("vkfv: "));
            EXPECT_THAT(said, Not(HasSubstr("unexpected failure")));
            EXPECT_THAT(said, Not(HasSubstr("Sanitizer")));
        }
        if (result.exit_code != done && fault.effect == lost) {
            EXPECT_EQ(result.exit_code, run_failed);
            EXPECT_THAT(said, HasSubstr("was lost"));
        }
        if (result.exit_code != done && fault.effect == no_device_memory) {
            EXPECT_EQ(result.exit_code, run_failed);
            EXPECT_THAT(said, HasSubstr("trace.batch"));
        }
        if (went_on) {
            ++gone_on_;
        }
        return fmt::format("{} {}{}: exit {}", fault.call, fault.effect, fault.lasts ? " for good" : "",
                           result.exit_code);
    }

    fs::path folder_;
    int gone_on_ = 0; // commands that did all the same
};

TEST_F(VulkanFaults, OfAStack) {
    fail_every_call_of(traced("--stack", {"--set", "topography.evaluate_on=device"}));
}

TEST_F(VulkanFaults, OfDevicesAtATime) {
    varies_ = true;
    fail_every_call_of(traced("--stack", {"--device", "0,0"}), 8);
}

TEST_F(VulkanFaults, OfAnImageTracedBackward) {
    fail_every_call_of(traced("--image", {"--z", "0", "--estimator", "backward"}), 2);
}

TEST_F(VulkanFaults, OfATopographyOnTheDevice) {
    prepare(traced("--stack", {"--device", "host"}));
    fail_every_call_of({"--topography", "out", "--set", "topography.evaluate_on=device"}, 2);
}

} // namespace
} // namespace vkfv::test
