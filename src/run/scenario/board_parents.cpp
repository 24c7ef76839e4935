#include "detail/board_parents.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "detail/toml_values.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop::inline run {
namespace {

namespace fs = std::filesystem;

// Files by which a board came to be, its own first.
class Ancestry {
public:
    explicit Ancestry(fs::path file) : files_{std::move(file)} {}
    [[nodiscard]] bool has(const fs::path& file) const {
        std::error_code absent;
        return std::ranges::any_of(files_, [&](const fs::path& known) { return fs::equivalent(known, file, absent); });
    }
    [[nodiscard]] const fs::path& last() const { return files_.back(); }
    void add(fs::path file) { files_.push_back(std::move(file)); }
    [[nodiscard]] std::vector<fs::path> parents() const { return {files_.begin() + 1, files_.end()}; }

private:
    std::vector<fs::path> files_;
};

// The file that a board names as its parent. A board of a user's that has the name of one here may extend it.
Result<fs::path> parent_file(const std::string& name, const Ancestry& ancestry, std::span<const fs::path> directories) {
    const fs::path beside = ancestry.last().parent_path();
    std::vector<fs::path> places{beside / (is_board_path(name) ? name : name + ".toml")};
    if (!is_board_path(name))
        for (const fs::path& directory : directories)
            places.push_back(directory / "receivers" / (name + ".toml"));
    bool is_loop = false;
    std::error_code absent;
    for (const fs::path& place : places) {
        if (!fs::exists(place, absent)) continue;
        if (!ancestry.has(place)) return place;
        is_loop = true;
    }
    if (is_loop) return fail(ErrorCode::input, fmt::format("is '{}', which extends this board in turn", name));
    const std::vector<std::string> boards = list_boards(directories);
    const std::vector<std::string_view> known(boards.begin(), boards.end());
    return fail(ErrorCode::input, fmt::format("is '{}', which no board is called{}", name, did_you_mean(name, known)));
}

void lay_under(toml::table& board, toml::table& parent) {
    for (auto&& [key, value] : parent) {
        toml::node* const own = board.get(key);
        if (own == nullptr)
            value.visit([&board, &name = key](auto& node) { board.insert(name, std::move(node)); });
        else if (own->is_table() && value.is_table())
            lay_under(*own->as_table(), *value.as_table());
    }
}

}  // namespace

std::vector<fs::path> lay_parents_under(toml::table& board, const fs::path& file, std::span<const fs::path> directories,
                                        MistakeList& mistakes) {
    Ancestry ancestry(file);
    while (const toml::node* extends = board.get("extends")) {
        const auto* const name = extends->as_string();
        if (name == nullptr) break;  // whoever reads the key says so
        const auto parent = parent_file(name->get(), ancestry, directories);
        const auto text = parent ? read_text_file(*parent) : Result<std::string>(fail(parent.error()));
        if (!text) {
            mistakes.add(extends->source(), "extends: " + text.error().message, text.error().code);
            break;
        }
        toml::table below = parsed_toml(*text, parent->string());
        below.erase("aliases");
        board.erase("extends");
        lay_under(board, below);
        ancestry.add(*parent);
    }
    return ancestry.parents();
}

}  // namespace skyloop::inline run
