#include <fmt/format.h>
#include <zip.h>

#include <memory>

#include "base/core/lowered_text.hpp"
#include "detail/text_track.hpp"

namespace skyloop {
namespace {

struct ZipCloser {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};
using ZipArchive = std::unique_ptr<zip_t, ZipCloser>;

tl::unexpected<Error> kmz_refusal(const TrackFile& file, const std::string& what) {
    return fail(ErrorCode::input, fmt::format("{}: {}", file.name, what));
}

Result<ZipArchive> open_kmz(const TrackFile& file) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(file.bytes.data(), file.bytes.size(), 0, &error);
    zip_t* archive = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr;
    const std::string why = archive ? "" : zip_error_strerror(&error);
    zip_error_fini(&error);
    if (archive) return ZipArchive(archive);
    if (source) zip_source_free(source);
    return kmz_refusal(file, fmt::format("no whole zip archive ({}); expected a KMZ", why));
}

// doc.kml, or the first entry that ends in .kml (OGC 07-147r2, annex C).
std::optional<zip_uint64_t> kml_entry(zip_t* archive) {
    if (const zip_int64_t doc = zip_name_locate(archive, "doc.kml", ZIP_FL_NOCASE); doc >= 0)
        return static_cast<zip_uint64_t>(doc);
    const zip_int64_t count = zip_get_num_entries(archive, 0);
    for (zip_int64_t i = 0; i < count; ++i) {
        const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
        if (name && lowered_text(name).ends_with(".kml")) return static_cast<zip_uint64_t>(i);
    }
    return std::nullopt;
}

// Reads on only as far as is allowed, whatever size the archive claims.
Result<std::string> unpacked(const TrackFile& file, zip_t* archive, zip_uint64_t index) {
    constexpr std::size_t largest = std::size_t{64} << 20, chunk = 65536;
    const std::unique_ptr<zip_file_t, ZipCloser> entry(zip_fopen_index(archive, index, 0));
    if (!entry) return kmz_refusal(file, fmt::format("its KML cannot be unpacked: {}", zip_strerror(archive)));
    std::string text;
    for (;;) {
        const std::size_t had = text.size();
        text.resize(had + chunk);
        const zip_int64_t got = zip_fread(entry.get(), text.data() + had, chunk);
        if (got < 0)
            return kmz_refusal(file, fmt::format("its KML cannot be unpacked: {}", zip_file_strerror(entry.get())));
        text.resize(had + static_cast<std::size_t>(got));
        if (got == 0) return text;
        if (text.size() > largest)
            return kmz_refusal(file, fmt::format("its KML unpacks to more than {} bytes", largest));
    }
}

}  // namespace

Result<Track> read_kmz(const TrackFile& file) {
    const auto archive = open_kmz(file);
    if (!archive) return fail(archive.error());
    const auto index = kml_entry(archive->get());
    if (!index) return kmz_refusal(file, "a zip archive without a .kml in it; expected a KMZ");
    const auto text = unpacked(file, archive->get(), *index);
    if (!text) return fail(text.error());
    const char* const entry = zip_get_name(archive->get(), *index, ZIP_FL_ENC_RAW);
    const std::string name = file.name + "/" + one_line_of(fmt::format("{:.80}", entry ? entry : ""));
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
    auto track = read_kml({bytes, *text, name, file.reading});
    if (!track) return track;
    track->name = file.name;
    track->format = "KMZ";
    return track;
}

}  // namespace skyloop
