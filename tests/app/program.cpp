#include "app/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace vkfv::test {

namespace {

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char character : text) {
        result += character == '\'' ? std::string("'\\''") : std::string(1, character);
    }
    return result + "'";
}

} // namespace

const std::string small_configuration = R"(# a small step
[source]
radius_mm = 0.96
flux_W = 1.0
wavelength_um = 0.5876

[illumination]
prescription = "koehler"
field_stop_radius_mm = 0.2

[beam_splitter]
reflectance = 0.5

[objective]
prescription = "10x_0.28"

[tube_lens]
prescription = "200mm"

[detector]
size_mm = 0.16
pixels = 8

[specimen]
kind = "step"
size_mm = 0.2
height_um = 2.0
[specimen.material]
g = 0.8
[specimen.roughness]
noise_um = 0.1
kernel_um = 1.0
pitch_um = 1.0
seed = 7

[scan]
z_start_um = -2.0
z_stop_um = 2.0
z_step_um = 1.0

[trace]
rays = 2000
seed = 1
estimator = "forward"
[topography]
window_px = 3

[output]
directory = "out"
)";

std::string ideal_configuration() {
    const auto text = replaced(small_configuration, "prescription = \"10x_0.28\"",
                               "kind = \"ideal\"\nfocal_length_mm = 20.0\nnumerical_aperture = 0.28");
    return replaced(text, "prescription = \"200mm\"", "kind = \"ideal\"\nfocal_length_mm = 200.0");
}

std::string program() {
    const char* const chosen = std::getenv("VKFV_PROGRAM");
    return chosen != nullptr ? chosen : VKFV_BINARY_DIR "/vkfv";
}

ProgramResult run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          const std::map<std::string, std::string>& environment) {
    const auto output = folder / ".stdout";
    const auto error = folder / ".stderr";
    std::string command = "cd " + quoted(folder.string()) + " && env";
    for (const auto& [name, value] : environment) {
        command += " " + quoted(name + "=" + value);
    }
    command += " " + quoted(program());
    for (const auto& argument : arguments) {
        command += " " + quoted(argument);
    }
    command += " >" + quoted(output.string()) + " 2>" + quoted(error.string());
    const int status = std::system(command.c_str());
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.standard_output = read_file(output);
    result.standard_error = read_file(error);
    return result;
}

std::filesystem::path fresh_folder(const std::string& name) {
    // Tests run side by side: each has folders of its own.
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string owner = fmt::format("{}.{}", test->test_suite_name(), test->name());
    std::ranges::replace(owner, '/', '_');
    const auto folder = std::filesystem::path(testing::TempDir()) / "vkfv_app_test" / owner / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

void write_file(const std::filesystem::path& path, const std::string& content) {
    std::ofstream stream(path, std::ios::binary);
    stream << content << std::flush;
    if (!stream) {
        throw std::runtime_error("cannot write " + path.string());
    }
}

std::string read_file(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto position = text.find(from);
    if (position == std::string::npos) {
        throw std::logic_error("the text does not hold " + from);
    }
    return text.replace(position, from.size(), to);
}

} // namespace vkfv::test
