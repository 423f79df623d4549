#include "measurement/evaluation/evaluation_figures.hpp"

#include "report/declared_figures.hpp"
#include "surface/areal_parameters.hpp"

#include <future>
#include <optional>

namespace vkfv::measurement {

namespace {

std::vector<report::ParameterRow> parameters_of(const surface::HeightMap& map) {
    return report::parameter_rows(surface::areal_parameters(map));
}

// pair: the measured and the true heights in this band; the true ones only if there is a truth.
Figures figures_in(const topography::Band& band, const Evaluation& evaluation, const topography::LevelledPair& pair,
                   const std::optional<topography::Deviation>& deviation) {
    const auto& measured = evaluation.topography.height;
    Figures figures{.band = band,
                    .measured_share = surface::height_parameters(measured).measured_share,
                    .deviation = deviation,
                    .measured = {},
                    .truth = {}};
    if (!(figures.measured_share > 0)) {
        return figures;
    }
    if (!evaluation.truth) {
        figures.measured = parameters_of(surface::scale_limited(measured, band));
    } else if (deviation && deviation->measured_share > 0) {
        auto truth = std::async(std::launch::async, [&] { return parameters_of(pair.truth); });
        figures.measured = parameters_of(pair.measured);
        figures.truth = truth.get();
    }
    return figures;
}

} // namespace

std::vector<Figures> figures_of(const Evaluation& evaluation) {
    std::vector<Figures> figures{
        figures_in({.form = evaluation.band.form}, evaluation, evaluation.levelled.pair, evaluation.deviation)};
    if (const auto& filtered = evaluation.filtered) {
        figures.push_back(figures_in(evaluation.band, evaluation, filtered->pair, filtered->deviation));
    }
    return figures;
}

nlohmann::ordered_json json_of(const Figures& figures) {
    auto json = nlohmann::ordered_json::object();
    if (const auto& deviation = figures.deviation) {
        json = {{"sq_measured", deviation->sq_measured},
                {"sq_true", deviation->sq_true},
                {"sq_ratio", topography::ratio_to_truth(deviation->sq_measured, deviation->sq_true)},
                {"rms_deviation", deviation->rms},
                {"correlation", deviation->correlation},
                {"measured_share", deviation->measured_share}};
    } else {
        json["measured_share"] = figures.measured_share;
    }
    if (figures.band.limited()) {
        json["s_filter"] = figures.band.s_filter;
        json["l_filter"] = figures.band.l_filter;
    }
    json = report::as_declared(figures.band.limited() ? "results.filtered" : "results", json);
    json["parameters"] = nlohmann::ordered_json::object();
    for (std::size_t k = 0; k < figures.measured.size(); ++k) {
        auto& parameter = json["parameters"][figures.measured[k].key()];
        parameter["measured"] = figures.measured[k].value;
        if (!figures.truth.empty()) {
            parameter["true"] = figures.truth[k].value;
        }
    }
    return json;
}

} // namespace vkfv::measurement
