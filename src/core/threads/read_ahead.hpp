// Items that are read while those before them are used.
#pragma once

#include <future>
#include <utility>

namespace vkfv {

// Calls use(k, read(k)) for k = 0 .. count - 1 in this order. The item after the one in use is read by another thread
// meanwhile, so that at most two are in memory. An exception of either ends the series and is rethrown.
template <class Read, class Use>
void read_ahead(int count, const Read& read, const Use& use) {
    const auto begin = [&](int k) { return std::async(std::launch::async, [&read, k] { return read(k); }); };
    auto next = count > 0 ? begin(0) : decltype(begin(0))();
    for (int k = 0; k < count; ++k) {
        auto item = next.get();
        if (k + 1 < count) {
            next = begin(k + 1);
        }
        use(k, std::move(item));
    }
}

} // namespace vkfv
