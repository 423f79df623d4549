// Prints the heights (um) of a configuration's stack, by row from the highest y, as `vkfv stack` measures them:
//   heights assets/stacks/demo.toml [KEY=VALUE...]
#include <vkfv/vkfv.hpp>

#include <cstdio>
#include <string>

int main(int count, char** arguments) {
    if (count < 2) {
        std::fputs("heights C.toml [KEY=VALUE...]\n", stderr);
        return 2;
    }
    try {
        vkfv::Scene scene(arguments[1]);
        for (int k = 2; k < count; ++k) {
            const std::string text = arguments[k];
            const auto equals = text.find('=');
            scene.set(text.substr(0, equals), equals == text.npos ? "" : text.substr(equals + 1));
        }
        const vkfv::Topography topography = scene.evaluate(scene.stack());
        for (int row = topography.rows - 1; row >= 0; --row) {
            for (int column = 0; column < topography.columns; ++column) {
                std::printf("%.17g ", topography.heights_um[std::size_t(row * topography.columns + column)]);
            }
            std::puts("");
        }
    } catch (const vkfv::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
