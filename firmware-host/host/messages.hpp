/// What the program says to its user, on stderr.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::host {

/// How much is said, and in what form.
struct Verbosity {
    bool quiet = false;  ///< warnings and errors only
    bool verbose = false;
    bool json = false;  ///< a JSON object a line
};

/// Lines on stderr, each with its weight.
class Messages {
public:
    explicit Messages(Verbosity verbosity) : verbosity_(verbosity) {}
    void detail(const std::string& text) const;
    void info(const std::string& text) const;
    void warning(const std::string& text) const;
    void warnings(std::span<const std::string> texts) const;
    /// One line of the error's message a line; gives the exit code that belongs to it.
    int error(const Error& error) const;
    [[nodiscard]] const Verbosity& verbosity() const { return verbosity_; }

private:
    void say(std::string_view level, const std::string& text) const;
    Verbosity verbosity_;
};

/// 2 for a misuse or a bad file, 1 when the outside world refused.
int exit_code(const Error& error);

}  // namespace skyloop::host
