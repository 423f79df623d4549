#include "optics/prescriptions/zmx_glasses.hpp"

#include "optics/media/medium_table.hpp"

#include <fmt/format.h>

namespace vkfv::optics::zmx {

Medium Glasses::medium_of(const Place& place, const Line& line) {
    if (line.words.empty()) {
        refuse(place, line, "", "the name of a glass", "Name it, or remove the line for air.");
    }
    const std::string& name = line.words.front();
    if (name == "MIRROR") {
        refuse(place, line, line.rest, "a refracting surface", "Mirrors are not imported: unfold the lens in Zemax.");
    }
    if (name == "AIR") {
        return Medium::air();
    }
    if (name == "___BLANK") {
        const double nd = number_at(place, line, 3, index_range);
        const double vd = number_at(place, line, 4);
        if (vd != 0 && !abbe_range.contains(vd)) {
            refuse(place, line, line.rest,
                   fmt::format("as value 5 an Abbe number {}, or 0 for no dispersion", abbe_range.to_string()),
                   "Correct the number; decimals take a point.");
        }
        if (line.words.size() > 5 && number_at(place, line, 5) != 0) {
            refuse(place, line, line.rest, "a model glass without a deviation of its partial dispersion",
                   "Set the deviation to 0, or name a glass of a catalogue.");
        }
        return model(nd, vd);
    }
    if (auto found = catalog_.find(name)) {
        return *std::move(found);
    }
    const auto meant = nearest_word(name, catalog_.names());
    refuse(place, line, name, "a glass of the catalogues",
           fmt::format("{}Add its catalogue with --glass-catalog, or make it a model glass in Zemax.",
                       meant ? fmt::format("Did you mean \"{}\"? ", *meant) : ""));
}

Medium Glasses::model(double nd, double vd) {
    const std::string code = fmt::format("{:03.0f}{:03.0f}", 1000 * (nd - 1), 10 * vd);
    for (int count = 1;; ++count) {
        const std::string name = count == 1 ? code : fmt::format("{}-{}", code, count);
        const auto [place, added] = models_.try_emplace(name, nd, vd);
        if (added || place->second == std::pair(nd, vd)) {
            return vd == 0 ? Medium::constant(name, nd, source_) : Medium::model(name, nd, vd, source_);
        }
    }
}

} // namespace vkfv::optics::zmx
