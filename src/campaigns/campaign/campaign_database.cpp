#include "campaigns/campaign/campaign_database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <unordered_map>

#include "base/core/json.hpp"
#include "campaigns/campaign/campaign_folder.hpp"
#include "campaigns/campaign/shard_results.hpp"

namespace skyloop::inline campaigns {
namespace {

// The layout that readers rely on.
constexpr const char* database_schema =
    "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA page_size = 4096;"
    "CREATE TABLE meta(name TEXT PRIMARY KEY, value TEXT);"
    "CREATE TABLE run(key TEXT PRIMARY KEY, number INTEGER, seed INTEGER, status TEXT);"
    "CREATE TABLE parameter(key TEXT, name TEXT, value TEXT);"
    "CREATE TABLE metric(key TEXT, name TEXT, value REAL);"
    "CREATE TABLE verdict(key TEXT, name TEXT, passed INTEGER, detail TEXT);"
    "CREATE TABLE error(key TEXT, message TEXT);"
    "BEGIN;";

// A result with the columns of its file.
struct FoundResult {
    RunResult result;
    std::size_t columns = 0;  // place in the list of all
    std::string place;        // FILE:LINE
};

// Everything in the tables, one result a run of the plan.
struct FoundResults {
    std::vector<ResultColumns> columns;
    std::vector<std::optional<FoundResult>> by_number;
};

class Database {
public:
    static Result<std::unique_ptr<Database>> create(const std::filesystem::path& path) {
        std::error_code none;
        std::filesystem::remove(path, none);
        std::unique_ptr<Database> database(new Database(path));
        // A relative name may begin with "file:", which SQLite takes for an address.
        const std::filesystem::path whole = std::filesystem::absolute(path, none);
        const bool opened = sqlite3_open(whole.c_str(), &database->handle_) == SQLITE_OK;
        if (!opened || !database->execute(database_schema)) return database->failure();
        return database;
    }
    ~Database() {
        sqlite3_finalize(statement_);
        sqlite3_close(handle_);
    }
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    bool execute(const char* text) { return sqlite3_exec(handle_, text, nullptr, nullptr, nullptr) == SQLITE_OK; }
    void begin(const char* text) {
        sqlite3_finalize(statement_);
        statement_ = nullptr;
        good_ = good_ && sqlite3_prepare_v2(handle_, text, -1, &statement_, nullptr) == SQLITE_OK;
        next_ = 1;
    }
    Database& put(std::string_view text) {
        return bound(
            sqlite3_bind_text(statement_, next_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
    }
    Database& put(std::uint64_t number) {
        return bound(sqlite3_bind_int64(statement_, next_, static_cast<sqlite3_int64>(number)));
    }
    Database& put(double number) { return bound(sqlite3_bind_double(statement_, next_, number)); }
    Database& put_nothing() { return bound(sqlite3_bind_null(statement_, next_)); }
    void add_row() {
        good_ = good_ && sqlite3_step(statement_) == SQLITE_DONE && sqlite3_reset(statement_) == SQLITE_OK;
        next_ = 1;
    }
    Result<void> finish() {
        sqlite3_finalize(statement_);
        statement_ = nullptr;
        good_ = good_ && execute("COMMIT; VACUUM;");
        if (!good_) return failure();
        return {};
    }
    [[nodiscard]] tl::unexpected<Error> failure() const {
        return fail(ErrorCode::outside, fmt::format("{}: cannot be written: {}", path_.string(),
                                                    handle_ != nullptr ? sqlite3_errmsg(handle_) : "out of memory"));
    }

private:
    explicit Database(std::filesystem::path path) : path_(std::move(path)) {}
    Database& bound(int code) {
        good_ = good_ && code == SQLITE_OK;
        ++next_;
        return *this;
    }

    std::filesystem::path path_;
    sqlite3* handle_ = nullptr;
    sqlite3_stmt* statement_ = nullptr;
    int next_ = 1;
    bool good_ = true;
};

// The number is the plan's, which may have changed since.
bool same_result(const RunResult& a, RunResult b) {
    b.number = a.number;
    return a == b;
}

Result<FoundResults> find_results(const std::filesystem::path& folder, const KeptCampaign& kept,
                                  GatheredCounts& counts) {
    std::unordered_map<std::string_view, std::size_t> numbers;
    for (const PlannedRun& run : kept.runs)
        if (!numbers.emplace(run.key, run.number).second)
            return fail(ErrorCode::input, fmt::format("{}: the plan has the key {} twice", folder.string(), run.key));
    FoundResults found;
    found.by_number.resize(kept.runs.size());
    const auto read = for_each_result(folder, [&](const StoredResult& stored) -> Result<void> {
        const auto number = numbers.find(stored.result.key);
        if (number == numbers.end()) return ++counts.foreign, Result<void>();
        if (found.columns.empty() || found.columns.back() != stored.columns) found.columns.push_back(stored.columns);
        const std::string place = fmt::format("{}:{}", stored.file.string(), stored.line);
        auto& slot = found.by_number[number->second];
        if (!slot) {
            slot = FoundResult{stored.result, found.columns.size() - 1, place};
        } else if (!kept.vehicle.empty() ||
                   (stored.columns == found.columns[slot->columns] && same_result(slot->result, stored.result))) {
            // What a vehicle does depends on the machine, so that two of its results differ: the first one counts.
            ++counts.duplicates;
        } else {
            return fail(ErrorCode::input, fmt::format("{} and {}: two results of the run {} that differ; expected the "
                                                      "same from the same run",
                                                      slot->place, place, stored.result.key));
        }
        return {};
    });
    if (!read) return fail(read.error());
    return found;
}

void put_meta(Database& database, const KeptCampaign& kept) {
    database.begin("INSERT INTO meta VALUES(?, ?)");
    std::vector<std::pair<std::string_view, std::string>> rows{{"name", kept.name},
                                                               {"program_version", kept.version},
                                                               {"scenario", kept.scenario},
                                                               {"scenario_digest", kept.base},
                                                               {"planned", fmt::format("{}", kept.runs.size())},
                                                               {"campaign_file", "campaign.json"},
                                                               {"options", JsonData(kept.options).dump()}};
    if (!kept.vehicle.empty()) rows.emplace_back("vehicle", kept.vehicle);
    for (const auto& [name, value] : rows)
        database.put(name).put(std::string_view(value)).add_row();
}

template <class Use>
void for_each_found(const FoundResults& found, Use use) {
    for (const auto& one : found.by_number)
        if (one) use(one->result, found.columns[one->columns]);
}

void put_runs(Database& database, const FoundResults& found) {
    database.begin("INSERT INTO run VALUES(?, ?, ?, ?)");
    for (std::size_t number = 0; number < found.by_number.size(); ++number)
        if (const auto& one = found.by_number[number])
            database.put(std::string_view(one->result.key))
                .put(static_cast<std::uint64_t>(number))
                .put(one->result.seed)
                .put(std::string_view(one->result.status))
                .add_row();
    database.begin("INSERT INTO error VALUES(?, ?)");
    for_each_found(found, [&](const RunResult& result, const ResultColumns&) {
        if (result.status != "error") return;
        database.put(std::string_view(result.key)).put(std::string_view(result.error)).add_row();
    });
}

void put_values(Database& database, const FoundResults& found) {
    database.begin("INSERT INTO parameter VALUES(?, ?, ?)");
    for_each_found(found, [&](const RunResult& result, const ResultColumns& columns) {
        for (std::size_t i = 0; i < columns.parameters.size(); ++i)
            database.put(std::string_view(result.key))
                .put(std::string_view(columns.parameters[i]))
                .put(std::string_view(result.parameters[i]))
                .add_row();
    });
    database.begin("INSERT INTO metric VALUES(?, ?, ?)");
    for_each_found(found, [&](const RunResult& result, const ResultColumns& columns) {
        for (std::size_t i = 0; i < columns.metrics.size(); ++i) {
            if (!result.metrics[i]) continue;
            database.put(std::string_view(result.key))
                .put(std::string_view(columns.metrics[i]))
                .put(*result.metrics[i])
                .add_row();
        }
    });
}

void put_verdicts(Database& database, const FoundResults& found) {
    database.begin("INSERT INTO verdict VALUES(?, ?, ?, ?)");
    for_each_found(found, [&](const RunResult& result, const ResultColumns& columns) {
        for (std::size_t i = 0; i < columns.verdicts.size(); ++i) {
            const auto& [outcome, detail] = result.verdicts[i];
            if (outcome.empty()) continue;
            database.put(std::string_view(result.key)).put(std::string_view(columns.verdicts[i]));
            if (outcome == "not run")
                database.put_nothing();
            else
                database.put(static_cast<std::uint64_t>(outcome == "passed" ? 1 : 0));
            database.put(std::string_view(detail)).add_row();
        }
    });
}

void count_results(const FoundResults& found, GatheredCounts& counts) {
    for (std::size_t number = 0; number < found.by_number.size(); ++number)
        if (!found.by_number[number]) counts.missing.push_back(number);
    for_each_found(found, [&](const RunResult& result, const ResultColumns& columns) {
        ++(result.status == "passed" ? counts.passed : result.status == "failed" ? counts.failed : counts.errors);
        for (std::size_t i = 0; i < columns.verdicts.size(); ++i)
            if (result.verdicts[i].outcome == "failed" || result.verdicts[i].outcome == "undecided")
                ++counts.failed_verdicts[columns.verdicts[i]];
    });
}

Result<void> write_database(const std::filesystem::path& path, const KeptCampaign& kept, const FoundResults& found) {
    const auto database = Database::create(path);
    if (!database) return fail(database.error());
    put_meta(**database, kept);
    put_runs(**database, found);
    put_values(**database, found);
    put_verdicts(**database, found);
    return (*database)->finish();
}

}  // namespace

Result<GatheredCounts> gather_campaign(const std::filesystem::path& folder) {
    const auto kept = kept_campaign(folder);
    if (!kept) return fail(kept.error());
    GatheredCounts counts;
    counts.planned = kept->runs.size();
    const auto found = find_results(folder, *kept, counts);
    if (!found) return fail(found.error());
    count_results(*found, counts);
    const std::filesystem::path whole = folder / fmt::format(".campaign.sqlite.{}", ::getpid());
    const auto written = write_database(whole, *kept, *found);
    std::error_code none, ignored;
    if (written) std::filesystem::rename(whole, folder / "campaign.sqlite", none);
    if (!written || none) std::filesystem::remove(whole, ignored);
    if (!written) return fail(written.error());
    if (none)
        return fail(ErrorCode::outside,
                    fmt::format("{}: cannot be written: {}", (folder / "campaign.sqlite").string(), none.message()));
    return counts;
}

}  // namespace skyloop::inline campaigns
