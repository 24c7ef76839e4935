/// The receiver's bytes into a file or to standard output.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// A wire in one direction that ends in a file, a pipe or a terminal. It has no speed, and nothing ever comes in.
///
/// The first write that fails (a full disk, a closed pipe) ends the file there: nobody is connected any more and later
/// bytes are not taken, so that the file has no gap. failure() then says so.
class FileTransport : public Transport {
public:
    /// Creates the file, or opens the one that is there, which keeps what it holds until begin() or the first bytes.
    /// One that was created and never begun is taken away again. Fails with `outside`.
    static Result<std::unique_ptr<FileTransport>> open(const std::filesystem::path& path);
    /// Writes to the program's standard output.
    static std::unique_ptr<FileTransport> standard_output();
    ~FileTransport() override;
    FileTransport(const FileTransport&) = delete;
    FileTransport& operator=(const FileTransport&) = delete;

    void begin() override;
    std::size_t write(ByteSpan bytes) override;
    Bytes read() override { return {}; }
    void allow_waiting() override { patience_ms_ = -1; }
    LineState line() override { return {failure_.empty(), std::nullopt}; }
    [[nodiscard]] std::string failure() const override { return failure_; }
    [[nodiscard]] std::string description() const override { return name_; }

private:
    FileTransport(FileDescriptor owned, int descriptor, std::string name)
        : owned_(std::move(owned)), descriptor_(descriptor), name_(std::move(name)) {}

    FileDescriptor owned_;  // none for standard output
    int descriptor_;
    std::string name_;
    std::filesystem::path made_;  // here, and nothing has begun to fill it
    bool begun_ = false;
    std::string failure_;
    int patience_ms_ = 0;  // as poll() takes it: 0 asks and goes on, −1 waits for as long as it takes
};

}  // namespace skyloop::inline wire
