#include "optics/prescriptions/zmx_glasses.hpp"

#include "optics/media/medium_table.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <string>

namespace vkfv::optics::zmx {

namespace {

// The number in a word of a line GLAS, into which some programs write decimal commas.
std::optional<double> number_in_glass(std::string word) {
    std::ranges::replace(word, ',', '.');
    return as_number(word);
}

// The nd and vd stated behind the name of a glass. Zemax writes 1.5 and 40 where it knows neither.
std::optional<ModelGlass> stated_in(const Line& line) {
    if (line.words.size() < 5) {
        return std::nullopt;
    }
    const auto nd = number_in_glass(line.words[3]), vd = number_in_glass(line.words[4]);
    if (!nd || !vd || !index_range.contains(*nd) || *nd == 1 || !abbe_range.contains(*vd) ||
        (*nd == 1.5 && *vd == 40)) {
        return std::nullopt;
    }
    return ModelGlass{.nd = *nd, .vd = *vd};
}

} // namespace

Medium Glasses::medium_of(const Place& place, const Line& line, const GlassSearch& search) {
    if (line.words.empty()) {
        refuse(place, line, "", "the name of a glass", "Name it, or remove the line for air.");
    }
    const std::string& name = line.words.front();
    if (name == "AIR") {
        return Medium::air();
    }
    if (name == "___BLANK") {
        Line numbers = line;
        for (std::string& word : numbers.words) {
            std::ranges::replace(word, ',', '.');
        }
        const double nd = number_at(place, numbers, 3, index_range);
        const double vd = number_at(place, numbers, 4);
        if (vd != 0 && !abbe_range.contains(vd)) {
            refuse(place, line, line.rest,
                   fmt::format("as value 5 an Abbe number {}, or 0 for no dispersion", abbe_range.to_string()),
                   "Correct the number; decimals take a point.");
        }
        if (numbers.words.size() > 5 && number_at(place, numbers, 5) != 0) {
            refuse(place, line, line.rest, "a model glass without a deviation of its partial dispersion",
                   "Set the deviation to 0, or name a glass of a catalogue.");
        }
        return model(nd, vd);
    }
    try {
        if (auto found = catalog_.find(name, search)) {
            return *std::move(found);
        }
    } catch (const InputError& error) { // catalogues disagree or the record is faulty
        refuse(place, line, name, error.problem().expected, error.problem().remedy);
    }
    auto stated = glass_of_code(name);
    if (!stated) {
        stated = stated_in(line);
    }
    if (!stated) {
        refuse(place, line, name, "a glass of the catalogues",
               "Add its catalogue with --glass-catalog, or make it a model glass in Zemax.");
    }
    spdlog::warn("{}:{}: no catalogue has the glass {}: it is a model glass of nd = {} and vd = {}, whose index away "
                 "from the d line is an estimate",
                 place.file.string(), line.number, name, stated->nd, stated->vd);
    return model(stated->nd, stated->vd);
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
