// The ledger of a stack as its folder has it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::scan {

struct LedgerShare {
    std::string name; // "detected", "vignetted at imaging 3 (10x_0.28 3)"
    double power = 0; // W, the images' mean
};

struct MeanLedger {
    double emitted = 0; // W
    std::vector<LedgerShare> shares;
};

// Empty where there is no ledger.csv, or none that can be read.
MeanLedger mean_ledger(const std::filesystem::path& folder);

} // namespace vkfv::scan
