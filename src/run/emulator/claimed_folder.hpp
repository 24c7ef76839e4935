/// A folder that one run at a time writes into.
#pragma once

#include <filesystem>

#include "base/core/result.hpp"
#include "wire/transport/file_descriptor.hpp"

namespace skyloop {

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

}  // namespace skyloop
