#include "run/emulator/claimed_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "base/core/make_folder.hpp"

namespace skyloop {

Result<ClaimedFolder> ClaimedFolder::claim(const std::filesystem::path& path) {
    ClaimedFolder folder;
    const auto made = make_folder(path);
    if (!made) return fail(made.error());
    folder.made_ = *made;
    folder.path_ = path;
    folder.lock_ = FileDescriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // The system takes the lock back however a program ends. Network file systems may have none; there nothing is held.
    if (folder.lock_.open() && ::flock(folder.lock_.value(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return fail(ErrorCode::outside,
                    fmt::format("{}: another run is recording there; expected another folder", path.string()));
    return folder;
}

ClaimedFolder& ClaimedFolder::operator=(ClaimedFolder&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(lock_, other.lock_);
    std::swap(made_, other.made_);
    return *this;
}

ClaimedFolder::~ClaimedFolder() {
    std::error_code not_empty;
    if (made_) std::filesystem::remove(path_, not_empty);
}

}  // namespace skyloop
