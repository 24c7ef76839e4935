/// A folder that one run at a time writes into.
/// A file that is written in large pieces and remembers its first failure.
/// What a receiver keeps over the end of the program: battery-backed memory and flash.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/core/bytes.hpp"
#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline run {

/// Makes a folder and holds it against other runs, in this program and in others, until its owner goes. It changes
/// nothing in the folder. One that was made here and is still empty then is taken away again.
class ClaimedFolder {
public:
    ClaimedFolder() = default;
    /// Fails with `outside` where the folder cannot be made, or while another run holds it.
    static Result<ClaimedFolder> claim(const std::filesystem::path& path);
    ClaimedFolder(ClaimedFolder&& other) noexcept { *this = std::move(other); }
    ClaimedFolder& operator=(ClaimedFolder&& other) noexcept;
    ~ClaimedFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    FileDescriptor lock_;  // none where a file system has no locks
    bool made_ = false;
};

/// Buffered output; nothing is lost but by a failing write, which is kept as a sentence.
class OutputFile {
public:
    OutputFile() = default;
    static Result<OutputFile> create(const std::filesystem::path& path);
    /// The program's standard output, behind what already went there; nothing of it is emptied. Fails when it is
    /// closed.
    static Result<OutputFile> standard_output();
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;
    ~OutputFile();

    void write(std::string_view text);
    void write(ByteSpan bytes);
    /// Hands the buffer to the operating system.
    void flush();
    [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::string buffer_;
    std::optional<Error> failure_;
};

/// Creates these files in a folder, as far as it can. Fails as OutputFile::create().
Result<void> create_files(const std::filesystem::path& folder,
                          std::initializer_list<std::pair<OutputFile*, std::string>> files);

/// A file that is replaced in one step, so that one who reads it never finds half of it. The text is the receiver's
/// own; this class does not look into it.
///
/// State: the text that the file holds, and when it was written.
class StateFile {
public:
    /// A file that does not exist yet is an empty one. Fails with `outside` when it cannot be read.
    static Result<StateFile> open(const std::filesystem::path& path);

    /// What the file held, or holds now.
    [[nodiscard]] const std::string& text() const { return text_; }
    /// True when a second has passed since the last look: the text need not be made more often.
    [[nodiscard]] bool due(GpsTime now) const;
    /// Writes the text if it has changed. An empty one is no state, and is not written.
    void keep(const std::string& text, GpsTime now);
    /// The last failure to write, a sentence that names the file.
    [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    explicit StateFile(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path path_;
    std::string text_;
    std::optional<GpsTime> looked_;
    std::optional<Error> failure_;
};

}  // namespace skyloop::inline run
