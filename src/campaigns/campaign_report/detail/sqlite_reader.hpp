/// An SQLite database that is only read and not trusted.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// One row of an answer. Columns count from 0.
class SqliteRow {
public:
    explicit SqliteRow(sqlite3_stmt* statement) : statement_(statement) {}
    /// The text of a column, nothing when it holds something else.
    [[nodiscard]] std::optional<std::string_view> text(int column) const;
    [[nodiscard]] std::optional<std::int64_t> integer(int column) const;
    /// A number of any kind.
    [[nodiscard]] std::optional<double> number(int column) const;
    [[nodiscard]] bool is_null(int column) const;

private:
    sqlite3_stmt* statement_;
};

class SqliteReader {
public:
    static Result<SqliteReader> open(const std::filesystem::path& path);

    [[nodiscard]] Result<bool> has_table(std::string_view table) const;

    /// Gives every row of a table to `take`, which returns what is wrong with it, "" when nothing is.
    /// @param columns their names, comma-separated
    /// @param order what follows ORDER BY, "" for the order of the table
    [[nodiscard]] std::optional<Error> each_row(std::string_view table, std::string_view columns,
                                                std::string_view order,
                                                const std::function<std::string(const SqliteRow&)>& take) const;

private:
    struct Closer {
        void operator()(sqlite3* database) const { sqlite3_close(database); }
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Closer>;

    [[nodiscard]] Result<Statement> prepare(const std::string& query, std::string_view what) const;
    [[nodiscard]] Error error(std::string_view what) const;

    std::string path_;
    std::unique_ptr<sqlite3, Closer> database_;
};

}  // namespace skyloop::inline campaigns
