#include <fmt/format.h>

#include <string>
#include <string_view>

#include "base/core/archive.hpp"
#include "base/core/letter_case.hpp"
#include "detail/text_track.hpp"

namespace skyloop {

Result<Track> read_kmz(const TrackFile& file) {
    constexpr std::size_t largest = std::size_t{64} << 20;
    // doc.kml, or the first that ends in .kml (OGC 07-147r2, annex C).
    std::string chosen;
    const auto is_kml = [&](std::string_view name) {
        const std::string lower = lower_case(name);
        if (lower == "doc.kml" || (chosen.empty() && lower.ends_with(".kml"))) chosen = name;
        return lower.ends_with(".kml");
    };
    const auto files = archive_files(file.text, file.name, largest, is_kml);
    if (!files) return fail(files.error());
    if (files->empty())
        return fail(ErrorCode::input, fmt::format("{}: a zip archive without a .kml in it; expected a KMZ", file.name));
    const std::string& text = files->at(chosen);
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    auto track = read_kml({bytes, text, fmt::format("{}/{:.80}", file.name, chosen), file.reading});
    if (!track) return track;
    track->name = file.name;
    track->format = "KMZ";
    return track;
}

}  // namespace skyloop
