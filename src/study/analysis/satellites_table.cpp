#include "detail/satellites_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/core/text_file.hpp"
#include "base/time/utc_time.hpp"
#include "detail/table_cells.hpp"

namespace skyloop {
namespace {

struct SatelliteColumns {
    std::size_t time = 0, elevation = 0, cn0 = 0, count = 0;
    std::optional<std::size_t> pseudorange{};

    // C/N0 stands in the table for all that arrives.
    [[nodiscard]] bool tracked(const LineCells& cells) const {
        return !cells[cn0].empty() && !(pseudorange && cells[*pseudorange].empty());
    }
};

std::optional<SatelliteColumns> satellite_columns(const LineCells& names) {
    SatelliteColumns columns{.count = names.size()};
    for (const auto& [name, column] :
         {std::pair("time_utc", &columns.time), std::pair("elevation_deg", &columns.elevation),
          std::pair("cn0_dbhz", &columns.cn0)}) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) return std::nullopt;
        *column = static_cast<std::size_t>(found - names.begin());
    }
    const auto pseudorange = std::find(names.begin(), names.end(), "pseudorange_m");
    if (pseudorange != names.end()) columns.pseudorange = static_cast<std::size_t>(pseudorange - names.begin());
    return columns;
}

// Each report goes to the last sample that is not younger than it.
void share_among_samples(const std::vector<DatedSignal>& signals, FixSeries& series) {
    std::vector<std::pair<GpsTime, std::size_t>> samples;
    for (std::size_t i = 0; i < series.samples.size(); ++i)
        if (series.samples[i].time) samples.emplace_back(*series.samples[i].time, i);
    if (samples.empty()) return;
    std::sort(samples.begin(), samples.end());
    for (const DatedSignal& signal : signals) {
        auto at = std::upper_bound(samples.begin(), samples.end(), signal.time,
                                   [](GpsTime time, const auto& sample) { return time < sample.first; });
        if (at != samples.begin()) --at;
        series.samples[at->second].signals.push_back(signal.report);
    }
}

}  // namespace

Result<std::vector<DatedSignal>> parse_satellites_table(std::string_view text, const std::string& name) {
    std::vector<DatedSignal> signals;
    std::optional<SatelliteColumns> columns;
    std::string_view time_cell;
    GpsTime time;
    const auto refusal = [&](std::size_t line, const std::string& what) {
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, line, what));
    };
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const LineCells cells = split_cells(text.substr(0, end), ',');
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!columns) {
            columns = satellite_columns(cells);
            if (!columns) return refusal(line, "no columns time_utc, elevation_deg and cn0_dbhz in the header");
            continue;
        }
        if (cells.size() == 1 && cells.front().empty()) continue;
        if (cells.size() != columns->count)
            return refusal(line, fmt::format("found {} cells, expected {}", cells.size(), columns->count));
        if (!columns->tracked(cells)) continue;
        const std::optional<double> elevation = cell_value(cells[columns->elevation]);
        const std::optional<double> cn0 = cell_value(cells[columns->cn0]);
        if (!elevation || !cn0 || !std::isfinite(*elevation) || !std::isfinite(*cn0))
            return refusal(line, "elevation_deg or cn0_dbhz is not a number");
        if (cells[columns->time] != time_cell || signals.empty()) {
            time_cell = cells[columns->time];
            const Result<UtcTime> utc = parse_utc(time_cell);
            if (!utc) return refusal(line, utc.error().message);
            time = to_gps_time(*utc, LeapSeconds::announced());
        }
        signals.push_back({time, {Angle::degrees(*elevation), DbHz(*cn0)}});
    }
    return signals;
}

void add_satellites_beside(const std::filesystem::path& fixes, FixSeries& series) {
    const std::string name = fixes.filename().string();
    if (name != "fixes.csv" && name != "fixes.csv.gz") return;
    for (const char* beside : {"satellites.csv", "satellites.csv.gz"}) {
        const std::filesystem::path path = fixes.parent_path() / beside;
        std::error_code unreadable;
        if (!std::filesystem::exists(path, unreadable)) continue;
        const Result<std::string> text = read_text_file(path);
        const Result<std::vector<DatedSignal>> signals =
            text ? parse_satellites_table(*text, path.string())
                 : Result<std::vector<DatedSignal>>(tl::make_unexpected(text.error()));
        if (!signals)
            series.warnings.push_back(signals.error().message + "; C/N0 by elevation is left out");
        else if (!series.dated)
            series.warnings.push_back(
                fmt::format("{}: its rows have no dates to find those of {} by; C/N0 by elevation is left out",
                            fixes.string(), path.string()));
        else
            share_among_samples(*signals, series);
        return;
    }
}

}  // namespace skyloop
