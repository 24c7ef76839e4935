/// skyloop: a GNSS receiver that is not there.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/core/words.hpp"
#include "command_line.hpp"
#include "commands.hpp"

namespace {

using skyloop::host::Action;

constexpr std::array<std::string_view, 21> commands{
    "run",    "simulate", "sky",    "check",      "compare",  "solve",     "boards",
    "decode", "scene",    "faults", "schema",     "ctl",      "replay",    "scenario-from",
    "fit",    "devices",  "power",  "trajectory", "campaign", "fetch-nav", "help-pages"};

// CLI11 does not know which words may be meant; this says it in one line.
int refuse_command(std::string_view word) {
    skyloop::say(fmt::format("skyloop: unknown command '{}'; expected one of {}{}\n", word, fmt::join(commands, " "),
                             skyloop::did_you_mean(word, commands)));
    return 2;
}

std::vector<Action> add_commands(CLI::App& app) {
    const std::array<Action (*)(CLI::App&), commands.size()> add{
        skyloop::host::add_run_command,       skyloop::host::add_simulate_command,
        skyloop::host::add_sky_command,       skyloop::host::add_check_command,
        skyloop::host::add_compare_command,   skyloop::host::add_solve_command,
        skyloop::host::add_boards_command,    skyloop::host::add_decode_command,
        skyloop::host::add_scene_command,     skyloop::host::add_faults_command,
        skyloop::host::add_schema_command,    skyloop::host::add_ctl_command,
        skyloop::host::add_replay_command,    skyloop::host::add_scenario_from_command,
        skyloop::host::add_fit_command,       skyloop::host::add_devices_command,
        skyloop::host::add_power_command,     skyloop::host::add_trajectory_command,
        skyloop::host::add_campaign_command,  skyloop::host::add_fetch_nav_command,
        skyloop::host::add_help_pages_command};
    std::vector<Action> actions;
    for (const auto add_command : add)
        actions.push_back(add_command(app));
    skyloop::host::check_numbers(app);
    skyloop::host::check_words(app);
    return actions;
}

// `skyloop help COMMAND` is `skyloop COMMAND --help`.
std::vector<std::string> words_of(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (words.front() != "help") return words;
    words.erase(words.begin());
    words.emplace_back("--help");
    return words;
}

int run_program(int argc, char** argv) {
    CLI::App app("A GNSS receiver emulator: real orbits in, NMEA out, over a pty that any client may open.", "skyloop");
    app.formatter(std::make_shared<skyloop::host::HelpText>());
    app.set_version_flag("--version", "skyloop " SKYLOOP_VERSION);
    app.require_subcommand(1);
    const std::vector<Action> actions = add_commands(app);
    if (argc < 2) {
        fmt::print("{}", app.help());
        return 2;
    }
    std::vector<std::string> words = words_of(argc, argv);
    const std::string word = words.front();
    if (!word.starts_with('-') && std::find(commands.begin(), commands.end(), word) == commands.end())
        return refuse_command(word);
    try {
        if (const auto misuse = skyloop::host::value_left_out(words)) {
            skyloop::say(fmt::format("skyloop: {}\n", *misuse));
            return 2;
        }
        std::reverse(words.begin(), words.end());  // as CLI11 takes them
        app.parse(std::move(words));
    } catch (const CLI::Success& wanted) {
        return app.exit(wanted);  // --help and --version
    } catch (const CLI::ParseError& error) {
        skyloop::say(fmt::format("skyloop: {}\n", skyloop::host::misuse_text(app, error)));
        return 2;
    }
    for (std::size_t i = 0; i < commands.size(); ++i)
        if (app.got_subcommand(std::string(commands[i]))) return actions[i]();
    return 2;
}

// A stream that the caller closed (2>&-) is a number that the next file or terminal opened would take: what is said to
// people would be in a receiver's bytes. Each is held against its use, so that reading 0 and writing 1 still fail.
void occupy_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            (void)::open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_WRONLY);  // the lowest number free
}

// What was printed may still wait in a buffer: a full disk shows only when it is written out.
int with_output_written(int code) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    skyloop::say(fmt::format("skyloop: standard output: cannot be written: {}\n", std::strerror(errno)));
    return code == 0 ? 1 : code;
}

}  // namespace

int main(int argc, char** argv) {
    occupy_closed_streams();
    try {
        return with_output_written(run_program(argc, argv));
    } catch (const std::bad_alloc&) {
        std::fputs("skyloop: out of memory\n", stderr);
    } catch (const std::system_error& refused) {
        const bool output = std::ferror(stdout) != 0;
        skyloop::say(
            fmt::format("skyloop: {}\n",
                        output ? "standard output: cannot be written: " + refused.code().message() : refused.what()));
    } catch (const std::exception& broken) {
        skyloop::say(fmt::format("skyloop: broken promise inside the program: {}\n", broken.what()));
    }
    return 1;
}
