#include "support/oracle_table.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace skyloop::test {
namespace {

namespace fs = std::filesystem;

const fs::path shared_root = SKYLOOP_SHARED_DATA;
const fs::path embedded_root = fs::path(SKYLOOP_SOURCE_DIR) / "tests/support/oracles";

// The cells of one line of CSV; a cell may be quoted.
std::vector<std::string> split_csv(const std::string& line) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            cells.emplace_back();
        else if (c != '\r')
            cells.back() += c;
    }
    return cells;
}

}  // namespace

std::string OracleRow::text(const std::string& column) const {
    const auto cell = cells_.find(column);
    if (cell == cells_.end()) {
        ADD_FAILURE() << "oracle row " << id_ << " has no column " << column;
        return {};
    }
    return cell->second;
}

double OracleRow::number(const std::string& column) const {
    const std::string cell = text(column);
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    EXPECT_TRUE(end != cell.c_str() && *end == '\0')
        << "oracle row " << id_ << ", column " << column << ": '" << cell << "'";
    return value;
}

std::int64_t OracleRow::integer(const std::string& column) const { return static_cast<std::int64_t>(number(column)); }

bool shared_oracles_present() { return fs::is_directory(shared_root / "oracles"); }

std::vector<OracleRow> oracle_rows(const std::string& name) {
    const fs::path whole = shared_root / "oracles" / name;
    const fs::path path = fs::exists(whole) ? whole : embedded_root / name;
    std::ifstream file(path);
    std::string line;
    std::vector<OracleRow> rows;
    if (!std::getline(file, line)) {
        ADD_FAILURE() << "no oracle table " << path;
        return rows;
    }
    const std::vector<std::string> header = split_csv(line);
    while (std::getline(file, line)) {
        const std::vector<std::string> cells = split_csv(line);
        if (cells.size() != header.size()) {
            ADD_FAILURE() << path << ": a row has " << cells.size() << " cells, expected " << header.size() << ": "
                          << line;
            continue;
        }
        std::map<std::string, std::string, std::less<>> named;
        for (std::size_t i = 0; i < cells.size(); ++i)
            named[header[i]] = cells[i];
        rows.emplace_back(cells[0], std::move(named));
    }
    EXPECT_FALSE(rows.empty()) << path << " has no rows";
    return rows;
}

std::optional<fs::path> shared_data(const std::string& relative_path) {
    const fs::path path = shared_root / relative_path;
    if (!fs::exists(path)) return std::nullopt;
    return path;
}

fs::path built_data() { return fs::path(SKYLOOP_BINARY_DIR) / "share/skyloop"; }

}  // namespace skyloop::test
