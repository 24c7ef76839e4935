#include "campaigns/engines/engine_task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace skyloop {
namespace {

constexpr std::size_t runs_worth_a_shard = 10;
constexpr std::size_t shards_of_a_default_array = 1000;
constexpr std::size_t longest_name = 40;

bool has_control_character(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte == 0x7f;
    });
}

Result<void> check_text(std::string_view what, const std::string& text) {
    if (has_control_character(text))
        return fail(ErrorCode::usage,
                    fmt::format("{} '{}' holds a control character, which no engine's script can bear; "
                                "expected printable text",
                                what, text));
    return {};
}

Result<void> check_path(std::string_view what, const std::filesystem::path& path) {
    if (!path.is_absolute())
        return fail(ErrorCode::usage, fmt::format("{} '{}': expected an absolute path, which holds on every machine",
                                                  what, path.string()));
    return check_text(what, path.string());
}

}  // namespace

std::size_t default_shards(std::size_t runs) {
    const std::size_t wanted = runs / runs_worth_a_shard + (runs % runs_worth_a_shard != 0 ? 1 : 0);
    return std::clamp<std::size_t>(wanted, 1, shards_of_a_default_array);
}

Result<void> check_task(const EngineTask& task) {
    if (task.shards < 1 || task.shards > max_shards)
        return fail(ErrorCode::usage, fmt::format("--shards: {}; expected 1 to {}", task.shards, max_shards));
    if (auto good = check_path("program", task.program); !good) return good;
    if (auto good = check_path("scenario", task.scenario); !good) return good;
    if (auto good = check_path("--out", task.out); !good) return good;
    for (const std::string& option : task.options)
        if (auto good = check_text("option", option); !good) return good;
    return {};
}

std::vector<std::string> shard_command(const EngineTask& task) {
    std::vector<std::string> command{task.program.string(), "campaign", task.scenario.string()};
    command.insert(command.end(), task.options.begin(), task.options.end());
    command.insert(command.end(), {"--out", task.out.string()});
    return command;
}

std::vector<std::string> gather_command(const EngineTask& task) {
    return {task.program.string(), "campaign", "gather", task.out.string()};
}

std::string plain_name(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'), digit = c >= '0' && c <= '9';
        if (letter || digit)
            out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!out.empty() && out.back() != '-')
            out += '-';
        if (out.size() == longest_name) break;
    }
    while (!out.empty() && out.back() == '-')
        out.pop_back();
    return out.empty() ? "campaign" : out;
}

}  // namespace skyloop
