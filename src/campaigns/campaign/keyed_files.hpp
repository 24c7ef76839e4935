/// The files whose content is in the keys of a campaign's runs.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// Each run reads its files anew, so a key stands for a result only while they are what they were when it was made.
/// State: what they were.
class KeyedFiles {
public:
    /// SHA-256 of a file's content; of a folder, of all files in it, by name. From now on it is looked after. Fails
    /// with `outside` when one cannot be read.
    Result<std::string> digest(const std::filesystem::path& path);

    /// Looks at all of them: at size, time and inode of each, and at the content of those alone of which one is
    /// another. Fails with `outside`, naming the file, where the content is another, or cannot be read.
    /// @return one that was written since the last look, if only with what it held; nothing where none was
    Result<std::optional<std::filesystem::path>> find_written();

private:
    struct SeenFile {
        std::string stamp, digest;
    };
    std::map<std::filesystem::path, SeenFile> seen_;
};

}  // namespace skyloop::inline campaigns
