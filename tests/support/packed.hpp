/// Compressed data and archives, made by libarchive's writer.
#pragma once

#include <archive.h>
#include <archive_entry.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skyloop::test {

/// An archive that lies in memory, as it is written.
class PackedBytes {
public:
    /// @param filter "none", "gzip", "compress", "bzip2", "xz" or "zstd" @param password of a zip; empty: none
    PackedBytes(const std::string& format, const std::string& filter, const std::string& password = "")
        : writer_(archive_write_new()) {
        check(archive_write_set_format_by_name(writer_, format.c_str()));
        if (filter != "none") check(archive_write_add_filter_by_name(writer_, filter.c_str()));
        archive_write_set_bytes_in_last_block(writer_, 1);
        if (!password.empty()) {
            check(archive_write_set_passphrase(writer_, password.c_str()));
            check(archive_write_set_options(writer_, "zip:encryption=traditional"));
        }
        check(archive_write_open(writer_, this, nullptr, take, nullptr));
    }
    ~PackedBytes() { archive_write_free(writer_); }
    PackedBytes(const PackedBytes&) = delete;
    PackedBytes& operator=(const PackedBytes&) = delete;

    void add(const std::string& name, std::string_view content) {
        archive_entry* const entry = archive_entry_new();
        archive_entry_set_pathname(entry, name.c_str());
        archive_entry_set_filetype(entry, AE_IFREG);
        archive_entry_set_perm(entry, 0644);
        archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
        const int code = archive_write_header(writer_, entry);
        archive_entry_free(entry);
        check(code);
        if (archive_write_data(writer_, content.data(), content.size()) < 0) check(ARCHIVE_FATAL);
    }
    std::string bytes() {
        check(archive_write_close(writer_));
        return bytes_;
    }

private:
    static la_ssize_t take(archive* /*writer*/, void* self, const void* bytes, std::size_t size) {
        static_cast<PackedBytes*>(self)->bytes_.append(static_cast<const char*>(bytes), size);
        return static_cast<la_ssize_t>(size);
    }
    void check(int code) {
        if (code < ARCHIVE_WARN) throw std::runtime_error(archive_error_string(writer_));
    }

    archive* writer_;
    std::string bytes_;
};

inline std::string compressed(const std::string& filter, std::string_view content) {
    PackedBytes packed("raw", filter);
    packed.add("data", content);
    return packed.bytes();
}

/// @param format "zip", "ustar", "pax" or "gnutar"
inline std::string archive_of(const std::string& format, const std::vector<std::pair<std::string, std::string>>& files,
                              const std::string& password = "") {
    PackedBytes packed(format, "none", password);
    for (const auto& [name, content] : files)
        packed.add(name, content);
    return packed.bytes();
}

}  // namespace skyloop::test
