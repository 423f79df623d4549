// The ledger of a stack, read from its folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::scan {

struct LedgerShare {
    std::string name; // "detected", "vignetted at imaging 3 (10x_0.28 3)"
    double power = 0; // W, mean over the images
};

struct MeanLedger {
    double emitted = 0; // W
    std::vector<LedgerShare> shares;
    std::uint64_t rays = 0; // of a forward trace beside the images; 0: the images' own paths
};

// The mean ledger of a stack; empty if ledger.csv is missing or cannot be read.
MeanLedger mean_ledger(const std::filesystem::path& folder);

} // namespace vkfv::scan
