// The only main(). It reports every failure as a message on standard error and an exit code.
#include "app/commands.hpp"
#include "app/version.hpp"
#include "command_line/command_line.hpp"

#include "core/files/result_folder.hpp"
#include "core/messages/error.hpp"
#include "core/messages/interruption.hpp"
#include "core/messages/log.hpp"
#include "core/messages/stages.hpp"
#include "vulkan/device.hpp"
#include "vulkan/failure.hpp"

#include <CLI/Error.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

namespace {

enum ExitCode { done = 0, wrong_input = 2, no_device = 3, run_failed = 4, in_use = 5 };

int report(const std::string& message, ExitCode code) {
    vkfv::log_failure(message, code);
    return code;
}

int report_lost_output() {
    return report("standard output cannot be written to. Free space where it leads, and run the same command again",
                  run_failed);
}

// Tells whether all output was written. A command that loses output has failed, since its output is part of the
// request.
bool standard_output_is_whole() {
    std::cout.flush();
    return std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

// Opens closed standard descriptors. A file that is opened while one of the three is closed would take its number, and
// receive what is printed there.
void hold_standard_descriptors_open() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
            (void)::open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY); // takes the lowest free number
        }
    }
}

int report_lack_of_memory() {
    return report(
        "the host has not enough memory. Choose fewer pixels, fewer positions or a coarser specimen, or allow "
        "the program more (ulimit -v)",
        run_failed);
}

} // namespace

int main(int argument_count, char** argument_values) {
    hold_standard_descriptors_open();
    vkfv::enter_stage("command line, configuration");
    vkfv::explain_interruptions();
    const vkfv::vulkan::DriverScope drivers;
    try {
        vkfv::open_log();
        vkfv::command_line::declare_commands(vkfv::app::commands(), vkfv::app::version_text);
        if (!vkfv::command_line::run_command_line(argument_count, argument_values)) {
            return wrong_input;
        }
        return standard_output_is_whole() ? done : report_lost_output();
    } catch (const CLI::ParseError& error) {
        return report(fmt::format("command line: {}. vkfv --help lists all options.", error.what()), wrong_input);
    } catch (const vkfv::InputError& error) {
        return report(error.what(), wrong_input);
    } catch (const vkfv::DeviceError& error) {
        return report(error.what(), no_device);
    } catch (const vkfv::FolderInUse& error) {
        return report(error.what(), in_use);
    } catch (const vkfv::RunError& error) {
        return report(error.what(), run_failed);
    } catch (const vk::SystemError& failure) {
        return report(vkfv::vulkan::run_error_of(failure).what(), run_failed);
    } catch (const std::filesystem::filesystem_error& error) {
        return report(fmt::format("{}. Check the path, its permissions and the free space, and run the same command "
                                  "again.",
                                  error.what()),
                      run_failed);
    } catch (const std::bad_alloc&) {
        return report_lack_of_memory();
    } catch (const std::length_error&) { // more elements than a container can hold
        return report_lack_of_memory();
    } catch (const std::system_error& error) {
        if (std::ferror(stdout) != 0) { // fmt throws this where output fails
            return report_lost_output();
        }
        return report(
            fmt::format("the system refused what the program needs: {}. Allow it more threads and memory (ulimit "
                        "-u, -v), and run the same command again",
                        error.what()),
            run_failed);
    } catch (const std::exception& error) {
        return report(fmt::format("unexpected failure: {}. Please report it with the command line and the "
                                  "configuration.",
                                  error.what()),
                      run_failed);
    } catch (...) { // what a library throws that is no std::exception
        return report("unexpected failure without words. Please report it with the command line and the configuration.",
                      run_failed);
    }
}
