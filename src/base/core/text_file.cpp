#include "base/core/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

namespace skyloop {
namespace {

// With which files of Unix compress (.Z) begin, as archives keep RINEX 2; zlib does not unpack them.
constexpr std::string_view compress_magic = "\x1f\x9d";

// Owns a zlib reader; zlib passes plain files through unchanged.
class GzipReader {
public:
    explicit GzipReader(int descriptor) : file_(gzdopen(descriptor, "rb")) {
        if (!file_) close(descriptor);
    }
    ~GzipReader() {
        if (file_) gzclose(file_);
    }
    GzipReader(const GzipReader&) = delete;
    GzipReader& operator=(const GzipReader&) = delete;
    [[nodiscard]] gzFile get() const { return file_; }

private:
    gzFile file_;
};

// Of all that a reader gave, what only its end or its beginning tells.
Result<void> check_unpacked(std::string_view text, const GzipReader& reader, std::string_view name) {
    // gzread reports a stream that ends early only through its error state.
    int code = Z_OK;
    gzerror(reader.get(), &code);
    if (code == Z_BUF_ERROR)
        return fail(ErrorCode::input,
                    fmt::format("{}: gzip data ends early, after {} bytes of text", name, text.size()));
    if (text.starts_with(compress_magic))
        return fail(ErrorCode::input, fmt::format("{}: found data packed by Unix compress (.Z); expected plain text or "
                                                  "gzip; gunzip unpacks both",
                                                  name));
    return {};
}

}  // namespace

Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_size) {
    const std::string name = path.string();
    // Not blocking: a fifo or a device without a peer must not hang a run before it starts.
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return fail(ErrorCode::outside, fmt::format("{}: {}", name, std::strerror(errno)));
    struct stat status {};
    if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(descriptor);
        return fail(ErrorCode::outside, fmt::format("{}: is not a regular file", name));
    }
    const GzipReader reader(descriptor);
    if (!reader.get()) return fail(ErrorCode::outside, fmt::format("{}: cannot be read: out of memory", name));

    constexpr unsigned block = 1u << 16;
    std::string text;
    for (;;) {
        const std::size_t had = text.size();
        text.resize(had + block);
        const int got = gzread(reader.get(), text.data() + had, block);
        if (got < 0) {
            int code = Z_OK;
            const std::string reason = gzerror(reader.get(), &code);
            return code == Z_ERRNO ? fail(ErrorCode::outside, fmt::format("{}: {}", name, std::strerror(errno)))
                                   : fail(ErrorCode::input,
                                          fmt::format("{}: damaged gzip data after {} bytes: {}", name, had, reason));
        }
        text.resize(had + static_cast<std::size_t>(got));
        if (text.size() > max_size)
            return fail(ErrorCode::input,
                        fmt::format("{}: has more than {} bytes of text, the most that is read", name, max_size));
        if (got == 0) break;
    }
    if (const auto checked = check_unpacked(text, reader, name); !checked) return fail(checked.error());
    return text;
}

std::string first_line_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

}  // namespace skyloop
