#include "messages.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/core/terminal_text.hpp"

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

Messages::Messages(Verbosity verbosity)
    : verbosity_(verbosity),
      logger_(std::make_shared<spdlog::logger>("skyloop", std::make_shared<spdlog::sinks::stderr_sink_st>())) {
    logger_->set_pattern("%v");
    logger_->set_level(verbosity.quiet     ? spdlog::level::warn
                       : verbosity.verbose ? spdlog::level::debug
                                           : spdlog::level::info);
}

void Messages::say(int level, const std::string& text) const {
    const auto weight = static_cast<spdlog::level::level_enum>(level);
    const auto word = spdlog::level::to_string_view(weight);
    const std::string name(word.data(), word.size());
    if (verbosity_.json) {
        // Bytes of a file name need not be UTF-8; a message must not fail over them.
        const nlohmann::json line{{"level", name}, {"message", text}};
        logger_->log(weight, "{}", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    } else if (weight >= spdlog::level::warn) {
        logger_->log(weight, "skyloop: {}{}", weight == spdlog::level::warn ? "warning: " : "",
                     lines_on_a_terminal(text));
    } else {
        logger_->log(weight, "{}", lines_on_a_terminal(text));
    }
    logger_->flush();
}

void Messages::detail(const std::string& text) const { say(spdlog::level::debug, text); }
void Messages::info(const std::string& text) const { say(spdlog::level::info, text); }
void Messages::warning(const std::string& text) const { say(spdlog::level::warn, text); }

int Messages::error(const Error& error) const {
    std::istringstream lines(error.message);
    for (std::string line; std::getline(lines, line);)
        say(spdlog::level::err, line);
    return exit_code(error);
}

int exit_code(const Error& error) { return error.code == ErrorCode::outside ? 1 : 2; }

}  // namespace skyloop::host
