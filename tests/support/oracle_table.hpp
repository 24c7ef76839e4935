/// Reference values made by others, read row by row.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace skyloop::test {

/// One row of an oracle table: cells by column name.
class OracleRow {
public:
    OracleRow(std::string id, std::map<std::string, std::string, std::less<>> cells)
        : id_(std::move(id)), cells_(std::move(cells)) {}
    /// The first column, for messages.
    [[nodiscard]] const std::string& id() const { return id_; }
    /// The cell of a column; a missing column fails the test.
    [[nodiscard]] std::string text(const std::string& column) const;
    [[nodiscard]] double number(const std::string& column) const;
    [[nodiscard]] std::int64_t integer(const std::string& column) const;
    [[nodiscard]] bool empty(const std::string& column) const { return text(column).empty(); }

private:
    std::string id_;
    std::map<std::string, std::string, std::less<>> cells_;
};

/// The rows of `oracles/<name>` in the shared data, or, where that table is absent, of the small embedded subset in
/// tests/support/oracles. An empty table, and one that is in neither place, fails the test.
std::vector<OracleRow> oracle_rows(const std::string& name);

/// True when the whole table is at hand, not only the embedded subset.
bool shared_oracles_present();

/// A file or folder of the shared data, or nothing where it is absent: then the test must GTEST_SKIP and name it.
std::optional<std::filesystem::path> shared_data(const std::string& relative_path);

/// The folder of the data that the build has made or copied: geoids, boards, navigation.
std::filesystem::path built_data();

}  // namespace skyloop::test

/// Skips the test by name where a file of the shared data is absent; otherwise defines `variable` as its path.
#define SKYLOOP_REQUIRE_SHARED(variable, relative_path)                               \
    const auto variable##_found = ::skyloop::test::shared_data(relative_path);        \
    if (!variable##_found) GTEST_SKIP() << "shared data absent: " << (relative_path); \
    const std::filesystem::path variable = *variable##_found
