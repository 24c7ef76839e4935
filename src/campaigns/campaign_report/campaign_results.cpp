#include "campaigns/campaign_report/campaign_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>

#include "base/core/json.hpp"
#include "base/core/number_text.hpp"
#include "detail/shown_names.hpp"
#include "detail/sqlite_reader.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr std::array<std::string_view, 3> status_words{"passed", "failed", "error"};

std::string not_found(std::string_view column, std::string_view expected) {
    return fmt::format("{} is not {}", column, expected);
}

// Which run a row belongs to, and which column of the results its name is.
class RowPlaces {
public:
    explicit RowPlaces(const std::vector<GatheredRun>& runs) {
        for (std::size_t i = 0; i < runs.size(); ++i)
            index_.emplace(runs[i].key, i);
    }

    struct Place {
        std::size_t run = 0;
        std::string_view name;
        std::string wrong;
    };

    // Columns 0 and 1 of the row: key and name, or another text, which may be empty.
    [[nodiscard]] Place of(const SqliteRow& row, bool named = true) {
        const auto key = row.text(0);
        const auto name = row.text(1);
        if (!key || key->empty()) return {0, {}, not_found("key", "a text")};
        if (!name || (named && name->empty())) return {0, {}, not_found("the second column", "a text")};
        // Rows of a run stand together: most need no look at the index.
        if (*key != last_key_) {
            const auto found = index_.find(std::string(*key));
            if (found == index_.end())
                return {0, {}, fmt::format("key '{}' is not in table 'run'", shown_text(*key, 80))};
            last_key_ = *key;
            last_run_ = found->second;
        }
        return {last_run_, *name, {}};
    }

private:
    std::unordered_map<std::string, std::size_t> index_;
    std::string last_key_;
    std::size_t last_run_ = 0;
};

// Columns by name, made when a name is first met, and kept in that order.
template <class Column>
class NamedColumns {
public:
    template <class Make>
    Column* find_or_make(std::string_view name, Make&& make) {
        auto found = places_.find(name);
        if (found == places_.end()) {
            if (columns_.size() == most_report_names) return nullptr;
            found = places_.emplace(name, columns_.size()).first;
            columns_.push_back(make(std::string(name)));
        }
        return &columns_[found->second];
    }
    [[nodiscard]] std::vector<Column>& columns() { return columns_; }

private:
    std::map<std::string, std::size_t, std::less<>> places_;
    std::vector<Column> columns_;
};

std::string too_many(std::string_view what) {
    return fmt::format("more than {} different names of {}", most_report_names, what);
}

std::string twice(const RowPlaces::Place& place, const CampaignResults& results) {
    return fmt::format("'{}' of run {} stands there twice", shown_text(place.name, 80), results.runs[place.run].number);
}

// A JSON list of texts.
std::optional<std::vector<std::string>> words_of(std::string_view text) {
    const auto json = JsonData::parse(text, nullptr, false);
    if (!json.is_array()) return std::nullopt;
    if (!std::all_of(json.begin(), json.end(), [](const auto& word) { return word.is_string(); })) return std::nullopt;
    return json.get<std::vector<std::string>>();
}

std::optional<Error> read_meta(const SqliteReader& reader, CampaignResults& results) {
    return reader.each_row("meta", "name, value", "", [&](const SqliteRow& row) -> std::string {
        const auto name = row.text(0);
        if (!name) return not_found("name", "a text");
        if (row.is_null(1)) return {};
        if (*name == "planned") {
            const auto count = row.integer(1);
            const auto text = row.text(1);
            std::uint64_t planned = count && *count >= 0 ? static_cast<std::uint64_t>(*count) : 0;
            bool good = count && *count >= 0;
            if (text) {
                const auto written = number_in<std::uint64_t>(*text);
                good = written.has_value();
                planned = written.value_or(0);
            }
            if (!good) return "planned is not a count of runs";
            results.planned = planned;
            return {};
        }
        if (*name == "options") {
            const auto text = row.text(1);
            auto words = text ? words_of(*text) : std::nullopt;
            if (!words) return not_found("options", "a JSON list of texts");
            results.options = std::move(*words);
            return {};
        }
        const std::array<std::pair<std::string_view, std::string*>, 6> texts{
            {{"name", &results.name},
             {"program_version", &results.program_version},
             {"scenario", &results.scenario},
             {"scenario_digest", &results.scenario_digest},
             {"campaign_file", &results.campaign_file},
             {"vehicle", &results.vehicle}}};
        for (const auto& [known, place] : texts)
            if (*name == known) {
                const auto text = row.text(1);
                if (!text) return fmt::format("the value of '{}' is not a text", known);
                *place = *text;
            }
        return {};  // what later versions add does not disturb
    });
}

std::optional<Error> read_runs(const SqliteReader& reader, CampaignResults& results) {
    std::unordered_map<std::string, std::int64_t> keys;
    return reader.each_row("run", "key, number, seed, status", "number, key", [&](const SqliteRow& row) -> std::string {
        const auto key = row.text(0);
        const auto number = row.integer(1);
        const auto seed = row.integer(2);
        const auto status = row.text(3);
        if (!key || key->empty()) return not_found("key", "a text");
        if (!number || *number < 0) return not_found("number", "a count");
        if (!seed) return not_found("seed", "a whole number");
        const auto word = std::find(status_words.begin(), status_words.end(), status.value_or(""));
        if (word == status_words.end())
            return fmt::format("status is '{}'; expected passed, failed or error",
                               shown_text(status.value_or("not a text"), 40));
        if (!keys.emplace(*key, *number).second)
            return fmt::format("key '{}' stands there twice", shown_text(*key, 80));
        // The seed's 64 bits have no sign; SQLite's integers have.
        results.runs.push_back({std::string(*key), *number, static_cast<std::uint64_t>(*seed),
                                static_cast<RunStatus>(word - status_words.begin()), ""});
        return {};
    });
}

std::optional<Error> read_parameters(const SqliteReader& reader, CampaignResults& results, RowPlaces& places) {
    NamedColumns<ReportedParameter> columns;
    auto wrong = reader.each_row("parameter", "key, name, value", "", [&](const SqliteRow& row) -> std::string {
        const RowPlaces::Place place = places.of(row);
        if (!place.wrong.empty()) return place.wrong;
        const auto value = row.text(2);
        if (!value) return not_found("value", "a text");
        auto* column = columns.find_or_make(place.name, [&](std::string name) {
            return ReportedParameter{std::move(name), std::vector<std::optional<std::string>>(results.runs.size())};
        });
        if (!column) return too_many("parameters");
        if (column->values[place.run]) return twice(place, results);
        column->values[place.run] = std::string(*value);
        return {};
    });
    results.parameters = std::move(columns.columns());
    return wrong;
}

std::optional<Error> read_metrics(const SqliteReader& reader, CampaignResults& results, RowPlaces& places) {
    struct Column {
        ReportedMetric metric;
        std::vector<bool> seen;
    };
    NamedColumns<Column> columns;
    auto wrong = reader.each_row("metric", "key, name, value", "", [&](const SqliteRow& row) -> std::string {
        const RowPlaces::Place place = places.of(row);
        if (!place.wrong.empty()) return place.wrong;
        const auto value = row.number(2);
        if (!value && !row.is_null(2)) return not_found("value", "a number");
        auto* column = columns.find_or_make(place.name, [&](std::string name) {
            constexpr double none = std::numeric_limits<double>::quiet_NaN();
            return Column{{std::move(name), std::vector<double>(results.runs.size(), none)},
                          std::vector<bool>(results.runs.size())};
        });
        if (!column) return too_many("metrics");
        if (column->seen[place.run]) return twice(place, results);
        column->seen[place.run] = true;
        if (value) column->metric.values[place.run] = *value;
        return {};
    });
    for (Column& column : columns.columns())
        results.metrics.push_back(std::move(column.metric));
    return wrong;
}

std::optional<Error> read_verdicts(const SqliteReader& reader, CampaignResults& results, RowPlaces& places) {
    NamedColumns<ReportedVerdict> columns;
    auto wrong = reader.each_row("verdict", "key, name, passed, detail", "", [&](const SqliteRow& row) -> std::string {
        const RowPlaces::Place place = places.of(row);
        if (!place.wrong.empty()) return place.wrong;
        const auto passed = row.integer(2);
        if (!row.is_null(2) && (!passed || (*passed != 0 && *passed != 1))) return not_found("passed", "0, 1 or null");
        const auto detail = row.text(3);
        if (!detail && !row.is_null(3)) return not_found("detail", "a text");
        auto* column = columns.find_or_make(place.name, [&](std::string name) {
            return ReportedVerdict{std::move(name), std::vector<std::optional<bool>>(results.runs.size()),
                                   std::vector<std::string>(results.runs.size())};
        });
        if (!column) return too_many("verdicts");
        if (column->passed[place.run]) return twice(place, results);
        if (passed) column->passed[place.run] = *passed == 1;
        column->details[place.run] = detail.value_or("");
        return {};
    });
    results.verdicts = std::move(columns.columns());
    return wrong;
}

// Older databases have no such table.
std::optional<Error> read_errors(const SqliteReader& reader, CampaignResults& results, RowPlaces& places) {
    const auto there = reader.has_table("error");
    if (!there) return there.error();
    if (!*there) return std::nullopt;
    return reader.each_row("error", "key, message", "", [&](const SqliteRow& row) -> std::string {
        const RowPlaces::Place place = places.of(row, false);
        if (!place.wrong.empty()) return place.wrong;
        results.runs[place.run].error = place.name;
        return {};
    });
}

}  // namespace

std::string_view run_status_word(RunStatus status) { return status_words[static_cast<std::size_t>(status)]; }

Result<CampaignResults> read_campaign_results(const std::filesystem::path& database) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(database, ignored))
        return fail(ErrorCode::outside,
                    fmt::format("{}: no such file; 'skyloop campaign gather' makes it", database.string()));
    const auto reader = SqliteReader::open(database);
    if (!reader) return fail(reader.error());
    CampaignResults results;
    if (auto error = read_meta(*reader, results)) return fail(*error);
    if (auto error = read_runs(*reader, results)) return fail(*error);
    RowPlaces places(results.runs);
    if (auto error = read_parameters(*reader, results, places)) return fail(*error);
    if (auto error = read_metrics(*reader, results, places)) return fail(*error);
    if (auto error = read_verdicts(*reader, results, places)) return fail(*error);
    if (auto error = read_errors(*reader, results, places)) return fail(*error);
    return results;
}

}  // namespace skyloop::inline campaigns
