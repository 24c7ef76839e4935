#include "campaigns/engines/engine_task.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "base/core/embedded_file.hpp"
#include "base/core/files.hpp"
#include "base/core/words.hpp"

namespace skyloop::inline campaigns {
namespace {

// The text with `with` before each of some characters.
std::string escaped(std::string_view text, std::string_view some, char with) {
    std::string out;
    for (const char c : text) {
        if (some.find(c) != std::string_view::npos) out += with;
        out += c;
    }
    return out;
}

}  // namespace

std::string sbatch_quoted(std::string_view word) { return '"' + escaped(word, "\"\\", '\\') + '"'; }

std::string sbatch_pattern(std::string_view path) { return escaped(path, "%", '%'); }

std::string kubernetes_literal(std::string_view text) { return escaped(text, "$", '$'); }

std::string yaml_quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : escaped(text, "\"\\", '\\')) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f)
            out += fmt::format("\\x{:02x}", byte);
        else
            out += c;
    }
    return out + '"';
}

std::span<const EmbeddedFile> embedded_engine_templates();  // those of the folder `templates`

namespace {

std::string_view embedded_template(std::string_view name) {
    for (const EmbeddedFile& file : embedded_engine_templates())
        if (file.name == name) return file.content;
    return {};
}

// Between the @ that `text` begins with and the next; empty where it begins with no placeholder.
std::string_view placeholder_at(std::string_view text) {
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", 1);
    return text[0] == '@' && end != std::string_view::npos && text[end] == '@' ? text.substr(1, end - 1) : "";
}

// Each line of a value behind what stands before all of it.
std::string lines_of_value(std::string_view before, std::string_view value) {
    std::string lines;
    while (!value.empty()) {
        const std::size_t end = std::min(value.find('\n'), value.size());
        lines += fmt::format("{}{}\n", before, value.substr(0, end));
        value.remove_prefix(std::min(end + 1, value.size()));
    }
    return lines;
}

class TemplateFilling {
public:
    TemplateFilling(const EngineTemplate& text, const std::vector<TemplateValue>& values)
        : template_(text), values_(values) {}

    Result<std::string> fill() {
        std::string out;
        for (std::string_view rest = template_.text; !rest.empty();) {
            ++number_;
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            const auto filled = line(rest.substr(0, end));
            if (!filled) return filled;
            out += *filled;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        if (values_.empty() || asked_for_first_) return out;
        return fail(ErrorCode::input,
                    fmt::format("{}: nowhere asks for @{}@; expected it, for without it nothing is done",
                                template_.file, values_.front().name));
    }

private:
    Result<std::string> value_of(std::string_view name) {
        if (name == "run_child") return std::string(embedded_template("run_child.sh"));
        std::vector<std::string_view> names{"run_child"};
        for (const TemplateValue& value : values_) {
            if (value.name != name) {
                names.push_back(value.name);
                continue;
            }
            asked_for_first_ = asked_for_first_ || name == values_.front().name;
            return value.text;
        }
        std::sort(names.begin(), names.end());
        return fail(ErrorCode::input, fmt::format("{}:{}: found @{}@; expected one of @{}@{}", template_.file, number_,
                                                  name, fmt::join(names, "@ @"), did_you_mean(name, names)));
    }

    Result<std::string> line(std::string_view text) {
        std::string out;
        for (std::size_t at = 0; at < text.size();) {
            const std::string_view name = placeholder_at(text.substr(at));
            if (name.empty()) {
                out += text[at++];
                continue;
            }
            const auto value = value_of(name);
            if (!value) return value;
            const std::size_t end = at + name.size() + 2;
            const bool alone = text.find_first_not_of(" \t") == at && end == text.size();
            if (alone) return lines_of_value(text.substr(0, at), *value);
            out += *value;
            at = end;
        }
        return out + '\n';
    }

    const EngineTemplate& template_;
    const std::vector<TemplateValue>& values_;
    int number_ = 0;
    bool asked_for_first_ = false;
};

}  // namespace

std::vector<std::string_view> template_names(std::string_view engine) {
    std::vector<std::string_view> names;
    for (const EmbeddedFile& file : embedded_engine_templates())
        if (file.name.starts_with(engine)) names.push_back(file.name);
    return names;
}

Result<void> add_engine_template(EngineTemplates& templates, std::string_view engine,
                                 const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    const std::vector<std::string_view> names = template_names(engine);
    if (std::find(names.begin(), names.end(), name) == names.end())
        return fail(
            ErrorCode::usage,
            fmt::format("--engine-template {}: found the name '{}'; expected that of a template of --engine {}: {}{}",
                        file.string(), name, engine, fmt::join(names, ", "), did_you_mean(name, names)));
    auto text = read_text_file(file);
    if (!text) return fail(text.error());
    templates[name] = {file.string(), std::move(*text)};
    return {};
}

Result<std::string> fill_template(const EngineTemplate& text, const std::vector<TemplateValue>& values) {
    return TemplateFilling(text, values).fill();
}

Result<std::string> fill_engine_template(const EngineTemplates& templates, std::string_view name,
                                         const std::vector<TemplateValue>& values) {
    const auto site = templates.find(name);
    if (site != templates.end()) return fill_template(site->second, values);
    return fill_template({std::string(name), std::string(embedded_template(name))}, values);
}

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

}  // namespace skyloop::inline campaigns
