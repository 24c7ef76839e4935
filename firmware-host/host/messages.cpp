#include "messages.hpp"

#include <cstdio>
#include <sstream>

#include "base/core/json.hpp"
#include "base/core/words.hpp"

namespace skyloop::host {
namespace {

// What files say is in messages, too; their own lines stay lines.
std::string lines_on_a_terminal(std::string_view text) {
    std::string lines;
    for (;;) {
        const std::size_t end = text.find('\n');
        lines += on_a_terminal(text.substr(0, end));
        if (end == std::string_view::npos) return lines;
        lines += '\n';
        text.remove_prefix(end + 1);
    }
}

}  // namespace

void Messages::say(std::string_view level, const std::string& text) const {
    std::string line;
    if (verbosity_.json)
        // Bytes of a file name need not be UTF-8; a message must not fail over them.
        line = json_text(JsonData{{"level", level}, {"message", text}});
    else
        line = (level == "error"     ? "skyloop: "
                : level == "warning" ? "skyloop: warning: "
                                     : "") +
               lines_on_a_terminal(text);
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
}

void Messages::detail(const std::string& text) const {
    if (verbosity_.verbose && !verbosity_.quiet) say("debug", text);
}
void Messages::info(const std::string& text) const {
    if (!verbosity_.quiet) say("info", text);
}
void Messages::warning(const std::string& text) const { say("warning", text); }
void Messages::warnings(std::span<const std::string> texts) const {
    for (const std::string& text : texts)
        warning(text);
}

int Messages::error(const Error& error) const {
    std::istringstream lines(error.message);
    for (std::string line; std::getline(lines, line);)
        say("error", line);
    return exit_code(error);
}

int exit_code(const Error& error) { return error.code == ErrorCode::outside ? 1 : 2; }

}  // namespace skyloop::host
