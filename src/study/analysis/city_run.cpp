#include "study/analysis/city_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <span>

#include "base/core/files.hpp"
#include "detail/run_tables.hpp"

namespace skyloop::inline study {
namespace {

// A table with a header line, read line by line; its state is the place in the text.
class NamedTable {
public:
    NamedTable(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

    // Finds columns by their names.
    Result<std::vector<std::size_t>> header(std::initializer_list<std::string_view> columns) {
        next();
        width_ = cells_.size();
        std::vector<std::size_t> places;
        for (const std::string_view column : columns) {
            const auto place = column_of(column);
            if (!place) return refusal(fmt::format("no column {} in the header", column));
            places.push_back(*place);
        }
        return places;
    }

    // While the header is the present line.
    [[nodiscard]] std::optional<std::size_t> column_of(std::string_view name) const {
        const auto found = std::find(cells_.begin(), cells_.end(), name);
        if (found == cells_.end()) return std::nullopt;
        return static_cast<std::size_t>(found - cells_.begin());
    }

    // Goes to the next line that is not empty; false at the end of the text.
    bool next() {
        while (!text_.empty()) {
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            const std::string_view line = text_.substr(0, end);
            text_.remove_prefix(std::min(end + 1, text_.size()));
            ++line_;
            if (trimmed_cell(line).empty()) continue;
            cells_ = split_cells(line, ',');
            return true;
        }
        cells_.clear();
        return false;
    }

    [[nodiscard]] std::string_view cell(std::size_t column) const { return cells_[column]; }

    // Every cell must be a number, or where `may_be_empty` empty.
    Result<std::optional<double>> number(std::size_t column, bool may_be_empty) const {
        if (may_be_empty && cells_[column].empty()) return std::nullopt;
        const std::optional<double> value = cell_value(cells_[column]);
        if (!value || !std::isfinite(*value)) return refusal(fmt::format("'{}' is not a number", cells_[column]));
        return value;
    }

    [[nodiscard]] Result<void> complete() const {
        if (cells_.size() == width_) return {};
        return refusal(fmt::format("found {} cells, expected {}", cells_.size(), width_));
    }

    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const {
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", name_, std::max<std::size_t>(line_, 1), what));
    }

private:
    std::string_view text_;
    std::string name_;
    std::vector<std::string_view> cells_;
    std::size_t line_ = 0, width_ = 0;
};

using CountsByTime = std::map<std::string, decltype(CityRunEpoch::received), std::less<>>;

// Numbers of a row, or what is wrong with one of them.
Result<std::vector<std::optional<double>>> row_numbers(const NamedTable& table, std::span<const std::size_t> columns,
                                                       bool may_be_empty) {
    if (const auto complete = table.complete(); !complete) return fail(complete.error());
    std::vector<std::optional<double>> numbers;
    for (const std::size_t column : columns) {
        const auto value = table.number(column, may_be_empty);
        if (!value) return fail(value.error());
        numbers.push_back(*value);
    }
    return numbers;
}

Result<Reception> named_reception(const NamedTable& table, std::size_t column) {
    const auto name = std::find(reception_names.begin(), reception_names.end(), table.cell(column));
    if (name != reception_names.end()) return static_cast<Reception>(name - reception_names.begin());
    return table.refusal(
        fmt::format("state is '{}'; expected one of {}", table.cell(column), fmt::join(reception_names, " ")));
}

Result<CountsByTime> counted_receptions(NamedTable table, Angle lowest) {
    const auto columns = table.header({"time_utc", "elevation_deg", "line_of_sight", "paths"});
    if (!columns) return fail(columns.error());
    const auto state = table.column_of("state");
    CountsByTime counts;
    while (table.next()) {
        const auto numbers = row_numbers(table, std::span(*columns).subspan(1), false);
        if (!numbers) return fail(numbers.error());
        if (*(*numbers)[0] < lowest.deg()) continue;
        auto& count = counts[std::string(table.cell((*columns)[0]))];
        const bool sight = *(*numbers)[1] != 0, some = *(*numbers)[2] > 0;
        const auto seen = sight ? Reception::line_of_sight : some ? Reception::reflected : Reception::blocked;
        const auto reception = state ? named_reception(table, *state) : Result<Reception>(seen);
        if (!reception) return fail(reception.error());
        ++count.at(static_cast<std::size_t>(*reception));
    }
    return counts;
}

Result<GpsTime> epoch_time(const NamedTable& table, std::size_t column) {
    const auto utc = parse_utc(table.cell(column));
    if (!utc) return table.refusal(utc.error().message);
    return to_gps_time(*utc, LeapSeconds::announced());
}

Result<CityRunEpoch> run_epoch(const NamedTable& table, const std::vector<std::size_t>& columns) {
    const auto place = row_numbers(table, std::span(columns).subspan(1, 3), false);
    if (!place) return fail(place.error());
    const auto errors = row_numbers(table, std::span(columns).subspan(4, 2), true);
    if (!errors) return fail(errors.error());
    const auto truth = place_from_degrees(*(*place)[0], *(*place)[1], *(*place)[2]);
    if (!truth) return table.refusal(truth.error());
    CityRunEpoch epoch;
    epoch.truth = *truth;
    if ((*errors)[0] && (*errors)[1]) epoch.error = Metres(std::hypot(*(*errors)[0], *(*errors)[1]));
    return epoch;
}

Result<std::string> text_in(const std::filesystem::path& folder, const std::string& name) {
    std::error_code unreadable;
    const std::filesystem::path packed = folder / (name + ".gz");
    return read_text_file(std::filesystem::exists(packed, unreadable) ? packed : folder / name);
}

}  // namespace

Result<CityRun> parse_city_run(std::string_view fixes, std::string_view satellites, const std::string& name,
                               Angle lowest) {
    const auto counts = counted_receptions(NamedTable(satellites, name + "/satellites.csv"), lowest);
    if (!counts) return fail(counts.error());
    NamedTable table(fixes, name + "/fixes.csv");
    const auto columns =
        table.header({"time_utc", "true_lat_deg", "true_lon_deg", "true_height_m", "east_error_m", "north_error_m"});
    if (!columns) return fail(columns.error());
    CityRun run;
    run.lowest = lowest;
    std::optional<GpsTime> start;
    while (table.next()) {
        auto epoch = run_epoch(table, *columns);
        if (!epoch) return fail(epoch.error());
        const auto time = epoch_time(table, columns->front());
        if (!time) return fail(time.error());
        if (!start) run.start = table.cell(columns->front());
        start = start.value_or(*time);
        epoch->since_start = difference(*time, *start);
        if (const auto found = counts->find(table.cell(columns->front())); found != counts->end()) {
            epoch->received = found->second;
        }
        run.epochs.push_back(*epoch);
    }
    if (run.epochs.empty()) return table.refusal("no epoch in it");
    return run;
}

Result<CityRun> read_city_run(const std::filesystem::path& folder, Angle lowest) {
    const auto fixes = text_in(folder, "fixes.csv");
    if (!fixes) return fail(fixes.error());
    const auto satellites = text_in(folder, "satellites.csv");
    if (!satellites) return fail(satellites.error());
    return parse_city_run(*fixes, *satellites, folder.string(), lowest);
}

}  // namespace skyloop::inline study
