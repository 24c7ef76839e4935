/// A file that is written in large pieces and remembers its first failure.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"

namespace skyloop {

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

}  // namespace skyloop
