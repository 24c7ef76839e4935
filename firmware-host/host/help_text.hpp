/// What `--help` prints.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace skyloop::host {

/// Options with the names of their values, as on the manual pages, in lines that fit the terminal.
class HelpText : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    std::string make_option(const CLI::Option* option, bool is_positional) const override;
    std::string make_option_usage(const CLI::Option* option) const override;
    std::string make_subcommand(const CLI::App* command) const override;

private:
    mutable std::string command_;  // whose help it is, with that of its command: what values mean depends on it
};

}  // namespace skyloop::host
