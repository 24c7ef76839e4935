#include "satellites_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skyloop/base/text_file.hpp"
#include "table_cells.hpp"

namespace skyloop {

Result<SignalStrengthByElevation> parse_satellites_table(std::string_view text, const std::string& name) {
    SignalStrengthByElevation strengths;
    std::size_t elevation_column = 0, cn0_column = 0, columns = 0;
    const auto refusal = [&](std::size_t line, const std::string& what) {
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, line, what));
    };
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::vector<std::string_view> cells = split_cells(text.substr(0, end), ',');
        text.remove_prefix(std::min(end + 1, text.size()));
        if (columns == 0) {
            const auto elevation = std::find(cells.begin(), cells.end(), "elevation_deg");
            const auto cn0 = std::find(cells.begin(), cells.end(), "cn0_dbhz");
            if (elevation == cells.end() || cn0 == cells.end())
                return refusal(line, "no columns elevation_deg and cn0_dbhz in the header");
            elevation_column = static_cast<std::size_t>(elevation - cells.begin());
            cn0_column = static_cast<std::size_t>(cn0 - cells.begin());
            columns = cells.size();
            continue;
        }
        if (cells.size() == 1 && cells.front().empty()) continue;
        if (cells.size() != columns)
            return refusal(line, fmt::format("found {} cells, expected {}", cells.size(), columns));
        if (cells[cn0_column].empty()) continue;
        const std::optional<double> elevation = cell_value(cells[elevation_column]);
        const std::optional<double> cn0 = cell_value(cells[cn0_column]);
        if (!elevation || !cn0 || !std::isfinite(*elevation) || !std::isfinite(*cn0))
            return refusal(line, "elevation_deg or cn0_dbhz is not a number");
        strengths.add(Angle::degrees(*elevation), DbHz(*cn0));
    }
    return strengths;
}

void add_satellites_beside(const std::filesystem::path& fixes, FixSeries& series) {
    const std::string name = fixes.filename().string();
    if (name != "fixes.csv" && name != "fixes.csv.gz") return;
    for (const char* beside : {"satellites.csv", "satellites.csv.gz"}) {
        const std::filesystem::path path = fixes.parent_path() / beside;
        std::error_code unreadable;
        if (!std::filesystem::exists(path, unreadable)) continue;
        const Result<std::string> text = read_text_file(path);
        const Result<SignalStrengthByElevation> strengths =
            text ? parse_satellites_table(*text, path.string())
                 : Result<SignalStrengthByElevation>(tl::make_unexpected(text.error()));
        if (strengths)
            series.signal_strength = *strengths;
        else
            series.warnings.push_back(strengths.error().message + "; C/N0 by elevation is left out");
        return;
    }
}

}  // namespace skyloop
