#include "detail/sqlite_reader.hpp"

#include <fmt/format.h>

#include "detail/shown_names.hpp"

namespace skyloop::inline campaigns {
namespace {

// No honest text of a campaign is longer; a damaged or hostile database must not ask for gigabytes.
constexpr int longest_value = 1 << 24;
constexpr int patience_ms = 2000;  // for another process that is writing

}  // namespace

std::optional<std::string_view> SqliteRow::text(int column) const {
    if (sqlite3_column_type(statement_, column) != SQLITE_TEXT) return std::nullopt;
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
}

std::optional<std::int64_t> SqliteRow::integer(int column) const {
    if (sqlite3_column_type(statement_, column) != SQLITE_INTEGER) return std::nullopt;
    return sqlite3_column_int64(statement_, column);
}

std::optional<double> SqliteRow::number(int column) const {
    const int type = sqlite3_column_type(statement_, column);
    if (type != SQLITE_INTEGER && type != SQLITE_FLOAT) return std::nullopt;
    return sqlite3_column_double(statement_, column);
}

bool SqliteRow::is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }

Result<SqliteReader> SqliteReader::open(const std::filesystem::path& path) {
    SqliteReader reader;
    reader.path_ = path.string();
    sqlite3* database = nullptr;
    // Absolute: a name that begins with "file:" would be read as an address.
    const int opened =
        sqlite3_open_v2(std::filesystem::absolute(path).c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
    reader.database_.reset(database);
    if (opened != SQLITE_OK)
        return fail(ErrorCode::outside, fmt::format("{}: cannot be opened: {}", reader.path_, sqlite3_errstr(opened)));
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, longest_value);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_busy_timeout(database, patience_ms);
    return reader;
}

Error SqliteReader::error(std::string_view what) const {
    const int code = sqlite3_errcode(database_.get());
    if (code == SQLITE_NOTADB) return {ErrorCode::input, path_ + ": is not an SQLite database"};
    const bool content = code == SQLITE_CORRUPT || code == SQLITE_ERROR || code == SQLITE_TOOBIG;
    return {content ? ErrorCode::input : ErrorCode::outside,
            fmt::format("{}: {}: {}", path_, what, shown_text(sqlite3_errmsg(database_.get())))};
}

Result<SqliteReader::Statement> SqliteReader::prepare(const std::string& query, std::string_view what) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &statement, nullptr) != SQLITE_OK)
        return fail(error(what));
    return Statement(statement);
}

// A view or a virtual table of that name does not count: it could run for ever.
Result<bool> SqliteReader::has_table(std::string_view table) const {
    const auto statement =
        prepare(fmt::format("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = '{}' AND rootpage > 0", table),
                "the list of tables");
    if (!statement) return fail(statement.error());
    const int step = sqlite3_step(statement->get());
    if (step != SQLITE_ROW && step != SQLITE_DONE) return fail(error("the list of tables"));
    return step == SQLITE_ROW;
}

std::optional<Error> SqliteReader::each_row(std::string_view table, std::string_view columns, std::string_view order,
                                            const std::function<std::string(const SqliteRow&)>& take) const {
    const auto there = has_table(table);
    if (!there) return there.error();
    if (!*there)
        return Error{ErrorCode::input,
                     fmt::format("{}: has no table '{}'; expected meta, run, parameter, metric and verdict, as "
                                 "'skyloop campaign gather' writes them",
                                 path_, table)};
    const std::string what = fmt::format("table '{}'", table);
    std::string query = fmt::format("SELECT {} FROM {}", columns, table);
    if (!order.empty()) query += fmt::format(" ORDER BY {}", order);
    const auto statement = prepare(query, what);
    if (!statement) return statement.error();
    for (std::size_t row = 1;; ++row) {
        const int step = sqlite3_step(statement->get());
        if (step == SQLITE_DONE) return std::nullopt;
        if (step != SQLITE_ROW) return error(what);
        if (const std::string wrong = take(SqliteRow(statement->get())); !wrong.empty())
            return Error{ErrorCode::input, fmt::format("{}: {}, row {}: {}", path_, what, row, wrong)};
    }
}

}  // namespace skyloop::inline campaigns
