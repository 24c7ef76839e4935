/// Bytes that come from a file, a pipe or a tty as they come.
/// Files that a command writes at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"

namespace skyloop::host {

/// An open input. A tty that does not control this program is put into raw mode and put back at the end; its speed
/// stays as it is.
class InputStream {
public:
    /// @param path "-" is standard input
    static Result<InputStream> open(const std::string& path);
    InputStream(InputStream&& other) noexcept;
    InputStream(const InputStream&) = delete;
    InputStream& operator=(const InputStream&) = delete;
    InputStream& operator=(InputStream&&) = delete;
    ~InputStream();

    /// What has come, or nothing after a fifth of a second or a signal. The end has at_end() set.
    Result<Bytes> read();
    [[nodiscard]] bool at_end() const { return at_end_; }
    [[nodiscard]] bool is_tty() const { return tty_; }
    /// A file, whose bytes do not come one after the other.
    [[nodiscard]] bool is_file() const { return file_; }
    /// As messages name it.
    [[nodiscard]] const std::string& name() const { return name_; }

private:
    InputStream() = default;
    Result<void> prepare();

    int fd_ = -1;
    bool close_ = false, tty_ = false, file_ = false, at_end_ = false;
    std::string name_;
    std::string saved_modes_;  // the bytes of a termios to restore; empty for none
};

/// Writes a file that is made anew. @return why not all of it is there, with its name
Result<void> write_whole_file(const std::filesystem::path& path, std::string_view text);

/// Files that a command makes again are not to replace what somebody has written by hand: fails with `usage` where one
/// of them is there, unless the first begins with "# Made by skyloop COMMAND", so that the command made them before.
Result<void> check_made_by(std::string_view command, const std::vector<std::filesystem::path>& files);

}  // namespace skyloop::host
