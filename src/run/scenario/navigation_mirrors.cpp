#include "run/scenario/navigation_mirrors.hpp"

#include <fmt/format.h>

#include "base/core/files.hpp"
#include "detail/table_reader.hpp"

namespace skyloop::inline run {
namespace {

void read_mirror(TableReader& table, NavigationMirror& mirror) {
    table.text("name", mirror.name);
    table.texts("addresses", mirror.addresses);
    if (mirror.name.empty() || !table.has("addresses")) table.mistake_here("expected name and addresses");
    for (const std::string& address : mirror.addresses)
        if (const auto checked = check_address_pattern(address); !checked) table.mistake("addresses", checked.error());
}

}  // namespace

Result<std::vector<NavigationMirror>> read_navigation_mirrors(std::string_view toml_text, std::string_view name) {
    std::vector<NavigationMirror> mirrors;
    const auto read = read_toml(toml_text, std::string(name), [&](TableReader& top) {
        top.tables("mirror", {}, [&](TableReader& table) { read_mirror(table, mirrors.emplace_back()); });
        if (mirrors.empty()) top.mistake_here("has no mirror; expected tables headed [[mirror]]");
    });
    if (!read) return fail(read.error());
    return mirrors;
}

Result<std::vector<NavigationMirror>> find_navigation_mirrors(std::span<const std::filesystem::path> folders) {
    for (const std::filesystem::path& folder : folders) {
        const std::filesystem::path file = folder / "navigation_mirrors.toml";
        std::error_code absent;
        if (std::filesystem::exists(file, absent)) return read_text_with(file, read_navigation_mirrors);
    }
    return fail(ErrorCode::outside,
                fmt::format("no navigation_mirrors.toml in {}; SKYLOOP_DATA_DIR may name the folder that holds it",
                            folders.empty() ? "any folder" : folders.front().string()));
}

}  // namespace skyloop::inline run
