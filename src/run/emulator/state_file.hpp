/// What a receiver keeps over the end of the program: battery-backed memory and flash.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop {

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

}  // namespace skyloop
