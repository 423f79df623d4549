#include "measurement/instrument/instrument_report.hpp"

#include "core/files/assets.hpp"
#include "core/files/digest.hpp"
#include "core/files/files_read.hpp"
#include "core/files/installation.hpp"
#include "core/files/user_cache.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/log.hpp"
#include "measurement/instrument/instrument_figures.hpp"
#include "measurement/scene/warning_json.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kept_names = "figures-";
constexpr std::size_t most_kept = 200; // reports, of a few thousand bytes each

struct KeptReport {
    std::vector<FileStamp> files;
    std::vector<MessagesHeard::Message> messages;
    InstrumentReport report;
};

// The name of a kept report: a digest of the program, the configuration with its identity, and the folders of assets.
// The files that were read are checked apart from it. An empty name means that nothing may be kept.
std::string name_of(const Configuration& configuration, const std::filesystem::path& file) {
    const std::string program = build_id();
    if (program.empty()) {
        return "";
    }
    Json all = {program, file.string(), configuration.canonical, configuration.identity};
    for (const auto& folder : asset_folders(configuration.file.parent_path())) {
        all.push_back(folder.string());
    }
    return std::string(kept_names) + Digest().add(json_text(all, JsonLayout::one_line)).sha256();
}

std::string written(const KeptReport& kept) {
    Json json = {{"files", Json::array()}, {"messages", Json::array()}};
    for (const auto& [path, device, number, bytes, changed] : kept.files) {
        json["files"].push_back({path, device, number, bytes, changed});
    }
    for (const auto& [level, text] : kept.messages) {
        json["messages"].push_back({level, text});
    }
    json["figures_that_matter"] = kept.report.figures_that_matter;
    json["all_figures"] = kept.report.all_figures;
    json["json"] = kept.report.json;
    return json_text(json, JsonLayout::one_line);
}

std::optional<KeptReport> read_kept(const std::string& name) {
    const auto bytes = read_cached(name);
    if (bytes.empty()) {
        return std::nullopt;
    }
    KeptReport kept;
    try {
        const Json json = Json::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
        kept.report.figures_that_matter = json.at("figures_that_matter");
        kept.report.all_figures = json.at("all_figures");
        kept.report.json = json.at("json");
        kept.report.verdict = verdict_of_json(kept.report.json.at("verdict"));
        kept.report.warnings = warnings_of_json(kept.report.json.at("warnings"));
        for (const Json& file : json.at("files")) {
            kept.files.push_back({.path = file.at(0),
                                  .device = file.at(1),
                                  .number = file.at(2),
                                  .bytes = file.at(3),
                                  .changed = file.at(4)});
        }
        for (const Json& message : json.at("messages")) {
            kept.messages.push_back({.level = message.at(0), .text = message.at(1)});
        }
    } catch (const Json::exception&) { // another program wrote the file: the report is made anew
        return std::nullopt;
    }
    return kept;
}

void keep(const std::string& name, const KeptReport& kept) {
    try {
        const std::string text = written(kept);
        write_cached(name, std::as_bytes(std::span(text)));
        thin_out_cached(kept_names, most_kept);
    } catch (const Json::type_error&) { // a path is no UTF-8
    }
}

} // namespace

InstrumentReport instrument_report(const Configuration& configuration, const std::filesystem::path& file) {
    const std::string name = name_of(configuration, file);
    if (!name.empty()) {
        if (auto kept = read_kept(name); kept && std::ranges::all_of(kept->files, is_unchanged)) {
            for (const auto& [level, text] : kept->messages) {
                spdlog::log(static_cast<spdlog::level::level_enum>(level), "{}", text);
            }
            return std::move(kept->report);
        }
    }
    const FilesRead read;
    const MessagesHeard heard;
    const auto figures = instrument_figures(configuration);
    KeptReport made{.files = {},
                    .messages = {},
                    .report = {.verdict = figures.verdict,
                               .warnings = figures.warnings,
                               .figures_that_matter = instrument_text(figures, false),
                               .all_figures = instrument_text(figures, true),
                               .json = instrument_json(figures, file)}};
    made.files = read.stamps();
    made.messages = heard.messages();
    // A log that leaves some messages out has not heard all that a later run must repeat.
    if (!name.empty() && spdlog::should_log(spdlog::level::info)) {
        keep(name, made);
    }
    return std::move(made.report);
}

} // namespace vkfv::measurement
