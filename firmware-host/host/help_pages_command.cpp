#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "option_table.hpp"

namespace skyloop::host {
namespace {

// The code point that begins at `text[i]` (RFC 3629, section 3), and how many bytes it has. The texts are the program's
// own.
std::pair<std::uint32_t, std::size_t> code_point(std::string_view text, std::size_t i) {
    const auto byte = [&](std::size_t at) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[at])); };
    const std::uint32_t first = byte(i);
    const std::size_t length = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (length == 1 || i + length > text.size()) return {first, 1};
    std::uint32_t code = first & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k)
        code = code << 6U | (byte(i + k) & 0x3FU);
    return {code, length};
}

// groff_char(7): a plain '-' would become a hyphen, '\' begins an escape, and what is not ASCII has a name by its code
// point.
std::string roff_text(std::string_view text) {
    std::string escaped;
    for (std::size_t i = 0; i < text.size();) {
        const auto [code, length] = code_point(text, i);
        i += length;
        if (code > 0x7E)
            escaped += fmt::format("\\[u{:04X}]", code);
        else if (code == '-')
            escaped += "\\-";
        else if (code == '\\')
            escaped += "\\e";
        else
            escaped += static_cast<char>(code);
    }
    return escaped;
}

// A line that begins with a dot or a quote would be read as a request.
std::string roff_line(std::string_view text) {
    const bool request = text.starts_with('.') || text.starts_with('\'');
    return (request ? "\\&" : "") + roff_text(text) + "\n";
}

std::string synopsis_of(const OptionRow& option) {
    if (option.positional()) {
        const std::string value = fmt::format("\\fI{}\\fR", roff_text(option.value));
        return option.required ? value : "[" + value + "]";
    }
    return fmt::format("\\fB{}\\fR \\fI{}\\fR", roff_text(option.names.front()), roff_text(option.value));
}

std::string synopsis(const CommandRow& command) {
    std::string line = fmt::format("\\fBskyloop {}\\fR", roff_text(command.name));
    for (const OptionRow& option : command.options)
        if (option.required && !option.positional()) line += " " + synopsis_of(option);
    for (const OptionRow& option : command.options)
        if (option.positional()) line += " " + synopsis_of(option);
    return line + " [\\fIoptions\\fR]\n";
}

std::string entry(const OptionRow& option) {
    std::string head;
    if (option.positional()) {
        head = fmt::format("\\fI{}\\fR", roff_text(option.value));
    } else {
        std::vector<std::string> names;
        for (const std::string& name : option.names)
            names.push_back(fmt::format("\\fB{}\\fR", roff_text(name)));
        head = fmt::format("{}", fmt::join(names, ", "));
        if (!option.value.empty()) head += fmt::format(" \\fI{}\\fR", roff_text(option.value));
    }
    return ".TP\n" + head + "\n" + roff_line(option_sentence(option) + ".");
}

std::string entries(const CommandRow& command, bool positional) {
    std::string text;
    for (const OptionRow& option : command.options)
        if (option.positional() == positional) text += entry(option);
    return text;
}

std::string roff_lines(std::string_view text) {
    std::string lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines += roff_line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

// A table's cell holds no bar of its own.
std::string cell(std::string_view text) {
    std::string escaped;
    for (const char c : text)
        escaped += c == '|' ? "\\|" : std::string(1, c);
    return escaped;
}

std::string markdown_row(const OptionRow& option) {
    if (option.positional()) return fmt::format("| `{}` | {} |\n", cell(option.value), cell(option_sentence(option)));
    std::string names = fmt::format("{}", fmt::join(option.names, ", "));
    if (!option.value.empty()) names += " " + option.value;
    return fmt::format("| `{}` | {} |\n", cell(names), cell(option_sentence(option)));
}

std::string subcommands(const CommandRow& command) {
    std::string text;
    for (const CommandRow& row : command.subcommands)
        text += ".SS " + synopsis(row) + roff_line(row.meaning + ".") + entries(row, true) + entries(row, false);
    return text.empty() ? text : ".SH COMMANDS\n" + text;
}

bool is_help(const OptionRow& option) { return !option.positional() && option.names.front() == "--help"; }

std::string markdown_section(const CommandRow& command) {
    std::string section = fmt::format("\n## skyloop {}\n\n{}.\n\n", command.name, command.meaning);
    if (!command.usage.empty())
        section += fmt::format("<!-- not run: a summary -->\n```text\n{}\n```\n\n", command.usage);
    std::string rows;
    for (const bool positional : {true, false})
        for (const OptionRow& option : command.options)
            if (option.positional() == positional && !is_help(option)) rows += markdown_row(option);
    section += rows.empty() ? "No options.\n" : "| option | meaning |\n|---|---|\n" + rows;
    for (const CommandRow& row : command.subcommands)
        section += markdown_section(row);
    return section;
}

}  // namespace

std::string manual_page(const CommandRow& command, std::string_view version) {
    std::string page =
        fmt::format(".\\\" Written by skyloop help-pages.\n.TH SKYLOOP\\-{} 1 \"\" \"skyloop {}\" \"User Commands\"\n",
                    roff_text(upper_case(command.name)), version);
    page += ".SH NAME\n" + fmt::format("skyloop\\-{} \\- {}\n", roff_text(command.name), roff_text(command.meaning));
    page += ".SH SYNOPSIS\n" + synopsis(command);
    for (const CommandRow& row : command.subcommands)
        page += ".br\n" + synopsis(row);
    if (!command.usage.empty()) page += ".SH USAGE\n.nf\n" + roff_lines(command.usage) + ".fi\n";
    if (const std::string words = entries(command, true); !words.empty()) page += ".SH ARGUMENTS\n" + words;
    page += ".SH OPTIONS\n" + entries(command, false) + subcommands(command);
    page +=
        ".SH EXIT STATUS\n0 success; 1 the outside world refused; 2 a misuse or a bad file; 3 something that a "
        "scenario\nexpects was not met; 75 a campaign was stopped by a signal before its end.\n";
    page += ".SH SEE ALSO\n.BR skyloop (1)\n";
    return page;
}

std::string commands_markdown(std::span<const CommandRow> commands) {
    std::string page =
        "# Every command and option\n\nWritten by `skyloop help-pages --format markdown`, from what the commands "
        "declare. "
        "`--help` stands with each, and what options do together in the manual page `skyloop(1)`.\n";
    for (const CommandRow& command : commands)
        if (!command.hidden) page += markdown_section(command);
    return page;
}

namespace {

struct HelpPagesOptions {
    std::string format = "markdown";
    std::string out;
};

int write_page(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (file) return 0;
    return Messages({}).error(
        {ErrorCode::outside, fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))});
}

int write_manual_pages(std::span<const CommandRow> commands, const std::filesystem::path& folder) {
    if (const auto made = make_folder(folder); !made) return Messages({}).error(made.error());
    for (const CommandRow& command : commands) {
        const auto path = folder / fmt::format("skyloop-{}.1", command.name);
        if (const int code = write_page(path, manual_page(command, SKYLOOP_VERSION)); code != 0) return code;
    }
    return 0;
}

int help_pages(const CLI::App& program, const HelpPagesOptions& options) {
    const std::vector<CommandRow> commands = option_table(program);
    if (options.format == "man") {
        if (options.out.empty())
            return Messages({}).error(
                {ErrorCode::usage, "help-pages --format man: expected --out DIR, a folder for them"});
        return write_manual_pages(commands, options.out);
    }
    const std::string page = options.format == "bash"  ? bash_completion(commands)
                             : options.format == "zsh" ? zsh_completion(commands)
                                                       : commands_markdown(commands);
    if (!options.out.empty()) return write_page(options.out, page);
    fmt::print("{}", page);
    return 0;
}

}  // namespace

Action add_help_pages_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("help-pages", "Manual pages, completions and the page of all options, for packages");
    auto options = std::make_shared<HelpPagesOptions>();
    command
        ->add_option("--format", options->format,
                     "man (a page for each command), bash or zsh (completions) or markdown (default)")
        ->check(CLI::IsMember({"man", "bash", "zsh", "markdown"}));
    command->add_option("--out", options->out,
                        "Folder of the manual pages, or file of the rest; default: standard output");
    command->group("");  // for whoever makes packages: not in the help
    return [&app, options] { return help_pages(app, *options); };
}

}  // namespace skyloop::host
