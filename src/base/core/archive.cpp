#include "base/core/archive.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cstdint>
#include <memory>
#include <utility>

#include "base/core/words.hpp"

namespace skyloop::inline base {
namespace {

constexpr std::size_t unpacked_block = std::size_t{1} << 16;
constexpr std::string_view gzip_magic = "\x1f\x8b";

struct ArchiveCloser {
    void operator()(archive* reader) const { archive_read_free(reader); }
};
using ArchiveReader = std::unique_ptr<archive, ArchiveCloser>;

// libarchive tells names in the characters of the thread's locale: UTF-8 as long as this lives.
class Utf8Names {
public:
    Utf8Names() : locale_(newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)), before_(uselocale(locale_)) {}
    ~Utf8Names() {
        uselocale(before_);
        if (locale_) freelocale(locale_);
    }
    Utf8Names(const Utf8Names&) = delete;
    Utf8Names& operator=(const Utf8Names&) = delete;

private:
    locale_t locale_, before_;
};

// Of what is being unpacked.
struct Packing {
    std::string name;
    std::size_t packed_size, max_size;

    [[nodiscard]] tl::unexpected<Error> refuse(const std::string& what) const {
        return fail(ErrorCode::input, fmt::format("{}: {}", name, what));
    }
    [[nodiscard]] tl::unexpected<Error> refuse_by(archive* reader, std::string_view what) const {
        const char* const why = archive_error_string(reader);
        return refuse(fmt::format("{} ({})", what, on_a_terminal(why ? why : "no reason is told")));
    }
    [[nodiscard]] Result<void> allow(std::size_t size) const {
        constexpr std::size_t any_ratio = std::size_t{16} << 20;
        if (size > max_size)
            return refuse(fmt::format("unpacks to more than {} bytes, the most that is read", max_size));
        if (size > any_ratio && size / most_unpacked_ratio > packed_size)
            return refuse(
                fmt::format("unpacks to more than {} times its {} bytes; expected a file that was not made to "
                            "fill memory",
                            most_unpacked_ratio, packed_size));
        return {};
    }
};

// libarchive passes over gzip's checksums; zlib does not.
Result<std::string> gunzipped(std::string_view bytes, const Packing& packing) {
    z_stream stream{};
    if (inflateInit2(&stream, MAX_WBITS + 16) != Z_OK) return packing.refuse("cannot be unpacked: out of memory");
    const std::unique_ptr<z_stream, decltype(&inflateEnd)> closer(&stream, inflateEnd);
    std::string text;
    for (;;) {
        const std::size_t given = std::min(bytes.size(), std::size_t{1} << 30), had = text.size();
        text.resize(had + unpacked_block);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        stream.avail_in = static_cast<uInt>(given);
        stream.next_out = reinterpret_cast<Bytef*>(text.data() + had);
        stream.avail_out = unpacked_block;
        const int code = inflate(&stream, Z_NO_FLUSH);
        bytes.remove_prefix(given - stream.avail_in);
        text.resize(text.size() - stream.avail_out);
        if (const auto allowed = packing.allow(text.size()); !allowed) return fail(allowed.error());
        if (code == Z_BUF_ERROR)
            return packing.refuse(fmt::format("gzip data ends early, after {} bytes of text", text.size()));
        if (code != Z_OK && code != Z_STREAM_END)
            return packing.refuse(fmt::format("damaged gzip data after {} bytes: {}", text.size(),
                                              stream.msg ? stream.msg : "a dictionary is wanted"));
        if (code == Z_STREAM_END && !bytes.starts_with(gzip_magic)) return text;
        if (code == Z_STREAM_END) inflateReset(&stream);
    }
}

// The content of the file at hand, which others of `before` bytes precede.
Result<std::string> content_of_file(archive* reader, const Packing& packing, std::size_t before) {
    std::string text;
    for (;;) {
        const std::size_t had = text.size();
        text.resize(had + unpacked_block);
        const la_ssize_t got = archive_read_data(reader, text.data() + had, unpacked_block);
        if (got < 0) return packing.refuse_by(reader, "cannot be unpacked; expected a whole file");
        text.resize(had + static_cast<std::size_t>(got));
        if (const auto allowed = packing.allow(before + text.size()); !allowed) return fail(allowed.error());
        if (got > 0) continue;
        text.shrink_to_fit();  // there may be many small ones
        return text;
    }
}

Result<std::string> without_filter(std::string_view bytes, const Packing& packing) {
    const ArchiveReader reader(archive_read_new());
    archive_read_support_filter_compress(reader.get());
    archive_read_support_filter_bzip2(reader.get());
    archive_read_support_filter_xz(reader.get());
    archive_read_support_filter_zstd(reader.get());
    archive_read_support_format_raw(reader.get());
    archive_read_support_format_empty(reader.get());
    archive_entry* entry = nullptr;
    const int opened = archive_read_open_memory(reader.get(), bytes.data(), bytes.size());
    const int code = opened == ARCHIVE_OK ? archive_read_next_header(reader.get(), &entry) : opened;
    if (code == ARCHIVE_EOF) return std::string();
    if (code < ARCHIVE_WARN) return packing.refuse_by(reader.get(), "damaged or cut compressed data");
    if (archive_filter_count(reader.get()) < 2) return packing.refuse("begins like compressed data, but is none");
    return content_of_file(reader.get(), packing, 0);
}

// With blanks for what would break a line.
std::string name_of(archive_entry* entry) {
    const char* const told = archive_entry_pathname(entry);
    std::string name(told ? told : "file without a legible name");
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
    return name;
}

Result<std::string> unpacked_at(int depth, std::string bytes, const std::string& name, std::size_t max_size) {
    auto plain = uncompressed(std::move(bytes), name, max_size);
    if (!plain || !is_archive(*plain)) return plain;
    if (depth > deepest_packing)
        return fail(ErrorCode::input,
                    fmt::format("{}: an archive in {} others; expected {} at most", name, depth - 1, depth - 2));
    auto files = archive_files(*plain, name, max_size);
    if (!files) return fail(files.error());
    std::erase_if(*files, [](const auto& file) { return is_hidden_file(file.first); });
    if (std::any_of(files->begin(), files->end(),
                    [](const auto& file) { return lower_case(file.first).ends_with(".kml"); }))
        return plain;
    if (files->size() != 1) {
        std::string names;
        for (const auto& [file, content] : *files) {
            names += fmt::format("{} {}", names.empty() ? ":" : ",", names.size() > 80 ? "…" : file);
            if (names.ends_with("…")) break;
        }
        return fail(ErrorCode::input,
                    fmt::format("{}: an archive of {} files{}; expected one file in it", name, files->size(), names));
    }
    const std::string inner = fmt::format("{}:{}", name, files->begin()->first);
    return unpacked_at(depth + 1, std::move(files->begin()->second), inner, max_size);
}

}  // namespace

bool is_compressed(std::string_view bytes) {
    constexpr std::array<std::string_view, 4> magics{gzip_magic, "\x1f\x9d", "\xfd\x37zXZ", "\x28\xb5\x2f\xfd"};
    const std::string_view first = bytes.substr(0, 10);
    // bzip2 goes on with the digits of pi, or those of its root where it holds nothing.
    return std::any_of(magics.begin(), magics.end(),
                       [&](std::string_view magic) { return bytes.starts_with(magic); }) ||
           (first.starts_with("BZh") && (first.ends_with("1AY&SY") || first.ends_with("\x17rE8P\x90")));
}

bool is_archive(std::string_view bytes) {
    constexpr std::size_t tar_magic_at = 257;
    return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06") ||
           (bytes.size() > tar_magic_at && bytes.substr(tar_magic_at).starts_with("ustar"));
}

bool is_hidden_file(std::string_view name) {
    return name.starts_with("__MACOSX/") || name.substr(name.rfind('/') + 1).starts_with('.');
}

std::optional<std::string> name_inside(std::string_view name) {
    std::string plain(name);
    std::replace(plain.begin(), plain.end(), '\\', '/');
    if (plain.empty() || plain.front() == '/' || plain.find(':') != std::string::npos ||
        std::any_of(plain.begin(), plain.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }))
        return std::nullopt;
    std::string inside;
    for (std::size_t at = 0; at <= plain.size();) {
        const std::size_t slash = std::min(plain.find('/', at), plain.size());
        const std::string part = plain.substr(at, slash - at);
        if (part == "..") return std::nullopt;
        if (!part.empty() && part != ".") inside += (inside.empty() ? "" : "/") + part;
        at = slash + 1;
    }
    if (inside.empty()) return std::nullopt;
    return inside;
}

Result<std::string> uncompressed(std::string bytes, const std::string& name, std::size_t max_size) {
    for (int depth = 0; is_compressed(bytes); ++depth) {
        const Packing packing{name, bytes.size(), max_size};
        if (depth == deepest_packing)
            return packing.refuse(fmt::format("is compressed more than {} times over; expected once", depth));
        auto inner = bytes.starts_with(gzip_magic) ? gunzipped(bytes, packing) : without_filter(bytes, packing);
        if (!inner) return inner;
        bytes = std::move(*inner);
    }
    return bytes;
}

Result<ArchiveFiles> archive_files(std::string_view bytes, const std::string& name, std::size_t max_size,
                                   const std::function<bool(std::string_view)>& wanted) {
    const Packing whole{name, bytes.size(), max_size};
    const Utf8Names names;
    const ArchiveReader reader(archive_read_new());
    archive_read_support_format_zip_seekable(reader.get());
    archive_read_support_format_tar(reader.get());
    ArchiveFiles files;
    std::size_t total = 0;
    const char* const no_archive = bytes.starts_with("PK") ? "no whole zip archive"
                                   : is_archive(bytes)     ? "no whole tar archive"
                                                           : "no zip or tar archive";
    if (archive_read_open_memory(reader.get(), bytes.data(), bytes.size()) != ARCHIVE_OK)
        return whole.refuse_by(reader.get(), no_archive);
    for (std::size_t count = 0;; ++count) {
        archive_entry* entry = nullptr;
        const int code = archive_read_next_header(reader.get(), &entry);
        if (code == ARCHIVE_EOF) return files;
        if (code < ARCHIVE_WARN) return whole.refuse_by(reader.get(), no_archive);
        if (count == most_archive_files)
            return whole.refuse(fmt::format("holds more than {} files, the most that is read", count));
        if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_hardlink(entry)) continue;
        const std::string told = name_of(entry);
        const Packing file{fmt::format("{}:{}", name, told.substr(0, 200)), bytes.size(), max_size};
        const auto inside = name_inside(told);
        if (!inside) return file.refuse("leads out of the archive; expected a name inside it");
        if (!wanted(*inside)) continue;
        if (archive_entry_is_encrypted(entry)) return file.refuse("is encrypted; expected a file without a password");
        auto content = content_of_file(reader.get(), file, total);
        if (!content) return fail(content.error());
        total += content->size();
        files[*inside] = std::move(*content);
    }
}

Result<std::string> unpacked(std::string bytes, const std::string& name, std::size_t max_size) {
    return unpacked_at(1, std::move(bytes), name, max_size);
}

}  // namespace skyloop::inline base
