// The documents of an uncertainty budget.
#pragma once

#include "measurement/budget/budget.hpp"

#include <string>
#include <vector>

namespace vkfv::measurement {

struct BudgetOrigin {
    std::string program;
    std::string title; // name of the configuration
    std::vector<std::string> devices;
    std::uint32_t seed = 0;
};

nlohmann::ordered_json budget_json(const Budget& budget, const BudgetOrigin& origin);

// budget.html: the table of contributions, their chart, and the histogram of the trials with both intervals.
std::string budget_page(const Budget& budget, const BudgetOrigin& origin, const std::string& configuration);

// Sentences on what the numbers do not show.
std::vector<std::string> remarks_of(const Budget& budget);

} // namespace vkfv::measurement
