/// A campaign's database in a folder of its own, made with the statements that a test gives.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop::test {

inline constexpr const char* campaign_schema =
    "CREATE TABLE meta(name TEXT PRIMARY KEY, value TEXT);"
    "CREATE TABLE run(key TEXT PRIMARY KEY, number INTEGER, seed INTEGER, status TEXT);"
    "CREATE TABLE parameter(key TEXT, name TEXT, value TEXT);"
    "CREATE TABLE metric(key TEXT, name TEXT, value REAL);"
    "CREATE TABLE verdict(key TEXT, name TEXT, passed INTEGER, detail TEXT);";

/// Two runs that passed and one that failed, with one parameter, metric and verdict.
inline constexpr const char* three_runs =
    "INSERT INTO meta VALUES ('name', 'three'), ('scenario', 'a b.toml'), ('planned', '4');"
    "INSERT INTO run VALUES ('k0', 0, 10, 'passed'), ('k2', 2, 12, 'failed'), ('k1', 1, 11, 'passed');"
    "INSERT INTO parameter VALUES ('k0', 'noise', '0.5'), ('k1', 'noise', '1'), ('k2', 'noise', '1.5');"
    "INSERT INTO metric VALUES ('k0', 'error_m', 1.0), ('k1', 'error_m', 2.0), ('k2', 'error_m', 9.0);"
    "INSERT INTO verdict VALUES ('k0', 'near', 1, ''), ('k1', 'near', 1, NULL), ('k2', 'near', 0, 'it was 9 m');";

class SmallDatabase {
public:
    explicit SmallDatabase(const std::string& statements) {
        sqlite3* database = nullptr;
        sqlite3_open(path().c_str(), &database);
        char* wrong = nullptr;
        // One transaction: a disk is not waited for at each statement.
        sqlite3_exec(database, ("BEGIN;" + statements + "COMMIT;").c_str(), nullptr, nullptr, &wrong);
        EXPECT_EQ(wrong, nullptr) << wrong;
        sqlite3_free(wrong);
        sqlite3_close(database);
    }
    SmallDatabase(const SmallDatabase&) = delete;
    SmallDatabase& operator=(const SmallDatabase&) = delete;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
    [[nodiscard]] std::filesystem::path path() const { return folder_ / "campaign.sqlite"; }

private:
    TemporaryFolder folder_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace skyloop::test
