#include <fmt/format.h>
#include <geo_normalize.h>
#include <geotiff.h>
#include <geovalues.h>
#include <tiffio.h>
#include <xtiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "detail/city_text.hpp"
#include "detail/height_grid.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {
namespace {

constexpr tmsize_t most_block_bytes = tmsize_t{1} << 28;  ///< of a strip, a tile or a tag
constexpr std::size_t most_cells = 1'000'000'000;         ///< each way
constexpr std::uint32_t gdal_no_data_tag = 42113;         ///< GDAL, GeoTIFF driver: ASCII text
constexpr unsigned short user_defined = 32767;

struct TiffDelete {
    void operator()(TIFF* file) const { XTIFFClose(file); }
    void operator()(GTIF* keys) const { GTIFFree(keys); }
    void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

/// Bytes in memory as libtiff reads a file.
struct TiffBytes {
    std::string_view bytes;
    std::size_t at = 0;

    static tmsize_t read(thandle_t self, void* to, tmsize_t count) {
        auto& file = *static_cast<TiffBytes*>(self);
        const std::size_t left = file.bytes.size() - std::min(file.at, file.bytes.size());
        const std::size_t taken = std::min(left, static_cast<std::size_t>(count));
        if (taken > 0) std::memcpy(to, file.bytes.data() + file.at, taken);
        file.at += taken;
        return static_cast<tmsize_t>(taken);
    }
    static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
    static toff_t seek(thandle_t self, toff_t offset, int from) {
        auto& file = *static_cast<TiffBytes*>(self);
        file.at = static_cast<std::size_t>(offset) + (from == SEEK_CUR   ? file.at
                                                      : from == SEEK_END ? file.bytes.size()
                                                                         : 0);
        return file.at;
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t self) { return static_cast<TiffBytes*>(self)->bytes.size(); }
};

// The first thing that libtiff complains of is the cause of the others.
int keep_first(TIFF*, void* first, const char*, const char* format, va_list values) {
    auto& message = *static_cast<std::string*>(first);
    std::array<char, 200> text{};
    std::vsnprintf(text.data(), text.size(), format, values);
    if (message.empty()) message = text.data();
    return 1;
}
int ignore_message(TIFF*, void*, const char*, const char*, va_list) { return 1; }
void ignore_key(GTIF*, int, const char*, ...) {}

using SampleReader = double (*)(const void*);

/// Of SampleFormat and BitsPerSample; null for what is no height.
SampleReader sample_reader(unsigned format, unsigned bits) {
    struct Known {
        unsigned format, bits;
        SampleReader read;
    };
    constexpr std::array known{
        Known{SAMPLEFORMAT_IEEEFP, 32, number_at<float>},       Known{SAMPLEFORMAT_IEEEFP, 64, number_at<double>},
        Known{SAMPLEFORMAT_INT, 8, number_at<std::int8_t>},     Known{SAMPLEFORMAT_INT, 16, number_at<std::int16_t>},
        Known{SAMPLEFORMAT_INT, 32, number_at<std::int32_t>},   Known{SAMPLEFORMAT_UINT, 8, number_at<std::uint8_t>},
        Known{SAMPLEFORMAT_UINT, 16, number_at<std::uint16_t>}, Known{SAMPLEFORMAT_UINT, 32, number_at<std::uint32_t>}};
    for (const Known& one : known)
        if (one.format == format && one.bits == bits) return one.read;
    return nullptr;
}

/// Reads the first image of a GeoTIFF (OGC 19-008) that has one sample a pixel.
class GeoTiffReader {
public:
    GeoTiffReader(std::string_view bytes, std::string_view name, const CityFileSettings& settings)
        : bytes_{bytes}, name_(name), settings_(settings) {}

    Result<HeightGrid> read() {
        open();
        if (!file_) return refused("is no TIFF");
        if (auto done = read_layout(); !done) return fail(std::move(done.error()));
        if (auto done = read_place(); !done) return fail(std::move(done.error()));
        if (auto done = read_blocks(); !done) return fail(std::move(done.error()));
        for (double& height : grid_.heights) {
            const bool absent = no_data_ && (height == *no_data_ || (std::isnan(height) && std::isnan(*no_data_)));
            height = grid_.usable(height, absent, settings_);
        }
        return std::move(grid_);
    }

private:
    [[nodiscard]] tl::unexpected<Error> refused(std::string_view what) const {
        return fail(ErrorCode::input, message_.empty() ? fmt::format("{}: {}", name_, what)
                                                       : fmt::format("{}: {}: {}", name_, what, shown(message_)));
    }

    void open() {
        static const bool tags_known = (XTIFFInitialize(), true);  // those of GeoTIFF, to libtiff
        static_cast<void>(tags_known);
        const std::unique_ptr<TIFFOpenOptions, TiffDelete> options(TIFFOpenOptionsAlloc());
        TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), most_block_bytes);
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_first, &message_);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_message, nullptr);
        // No mapping of memory: "m".
        file_.reset(TIFFClientOpenExt("", "rm", &bytes_, TiffBytes::read, TiffBytes::write, TiffBytes::seek,
                                      TiffBytes::close, TiffBytes::size, nullptr, nullptr, options.get()));
    }

    template <class T>
    [[nodiscard]] T field(std::uint32_t tag, T otherwise) const {
        T value = otherwise;
        return TIFFGetFieldDefaulted(file_.get(), tag, &value) == 1 ? value : otherwise;
    }

    Result<void> read_layout() {
        grid_.columns = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
        grid_.rows = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
        if (std::min(grid_.columns, grid_.rows) < 2 || std::max(grid_.columns, grid_.rows) > most_cells)
            return refused(fmt::format("a grid of {} by {} cells; expected 2 or more each way, and {} at most",
                                       grid_.columns, grid_.rows, most_cells));
        if (auto done = check_grid_size(grid_, name_, settings_); !done) return done;
        const unsigned samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
        const unsigned format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        const unsigned bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
        sample_ = sample_reader(format, bits);
        sample_bytes_ = bits / 8;
        if (samples != 1 || sample_ == nullptr)
            return refused(
                fmt::format("{} samples of {} bits a pixel (format {}); expected heights: one number of 8 to 64 "
                            "bits a pixel",
                            samples, bits, format));
        read_no_data(format == SAMPLEFORMAT_IEEEFP && bits == 32);
        return {};
    }

    void read_no_data(bool single) {
        std::uint32_t count = 0;
        const char* text = nullptr;
        if (TIFFGetField(file_.get(), gdal_no_data_tag, &count, &text) != 1 || text == nullptr) return;
        const std::string_view all(text, strnlen(text, count));
        const char* at = all.data() + std::min(all.find_first_not_of(' '), all.size());
        no_data_ = take_number(at, all.data() + all.size());
        if (no_data_ && single) no_data_ = static_cast<double>(static_cast<float>(*no_data_));
    }

    // Requirements 5.1 and 5.2 of OGC 19-008: from raster to model coordinates.
    Result<void> read_place() {
        const std::unique_ptr<GTIF, TiffDelete> keys(GTIFNewEx(file_.get(), ignore_key, nullptr));
        unsigned short raster_type = RasterPixelIsArea;
        if (keys) GTIFKeyGetSHORT(keys.get(), GTRasterTypeGeoKey, &raster_type, 0, 1);
        const double middle = raster_type == RasterPixelIsPoint ? 0 : 0.5;
        const auto model = [&](double column, double row) {
            Eigen::Vector2d place(column, row);
            const bool told = keys && GTIFImageToPCS(keys.get(), &place.x(), &place.y());
            return told ? place : Eigen::Vector2d::Constant(std::nan(""));
        };
        grid_.first = model(middle, middle);
        if (!grid_.first.allFinite())
            return refused("tells no place; expected a GeoTIFF with a tie point and a pixel scale, or a matrix");
        grid_.next_column = model(middle + 1, middle) - grid_.first;
        grid_.next_row = model(middle, middle + 1) - grid_.first;
        const double area = grid_.next_column.x() * grid_.next_row.y() - grid_.next_column.y() * grid_.next_row.x();
        if (!std::isfinite(area) || area == 0) return refused("its pixels have no size, or lie nowhere");
        if (keys) grid_.system = reference_system(system_name(*keys));
        if (!settings_.file_crs.empty() && (!grid_.system || grid_.system->unknown))
            grid_.system = reference_system_of_file("", settings_);
        if (!grid_.system) return refused("names no reference system; set scene.file_crs to it");
        return {};
    }

    // "EPSG:25832+7837", or what libgeotiff makes of a system that is defined in the file.
    static std::string system_name(GTIF& keys) {
        unsigned short model = 0, code = 0, heights = 0;
        GTIFKeyGetSHORT(&keys, GTModelTypeGeoKey, &model, 0, 1);
        GTIFKeyGetSHORT(&keys, model == ModelTypeGeographic ? GeographicTypeGeoKey : ProjectedCSTypeGeoKey, &code, 0,
                        1);
        GTIFKeyGetSHORT(&keys, VerticalCSTypeGeoKey, &heights, 0, 1);
        if (code != 0 && code != user_defined)
            return heights != 0 && heights != user_defined ? fmt::format("EPSG:{}+{}", code, heights)
                                                           : fmt::format("EPSG:{}", code);
        GTIFDefn definition;
        if (code != user_defined || !GTIFGetDefn(&keys, &definition)) return {};
        const std::unique_ptr<char, void (*)(char*)> text(GTIFGetProj4Defn(&definition), GTIFFreeMemory);
        return text ? fmt::format("{} +type=crs", text.get()) : std::string();
    }

    // Strips are tiles as wide as the image.
    Result<void> read_blocks() {
        const bool tiled = TIFFIsTiled(file_.get()) != 0;
        const std::size_t width = tiled ? field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : grid_.columns;
        const std::size_t strip_rows = field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0);
        const std::size_t height =
            tiled ? field<std::uint32_t>(TIFFTAG_TILELENGTH, 0) : std::min(strip_rows, grid_.rows);
        const tmsize_t size = tiled ? TIFFTileSize(file_.get()) : TIFFStripSize(file_.get());
        if (width == 0 || height == 0 || size <= 0 || size > most_block_bytes)
            return refused(
                fmt::format("its {} are no good: {} by {} pixels", tiled ? "tiles" : "strips", width, height));
        grid_.heights.resize(grid_.columns * grid_.rows);
        std::vector<unsigned char> block(static_cast<std::size_t>(size));
        std::uint32_t number = 0;
        for (std::size_t top = 0; top < grid_.rows; top += height)
            for (std::size_t left = 0; left < grid_.columns; left += width, ++number) {
                const tmsize_t count = tiled ? TIFFReadEncodedTile(file_.get(), number, block.data(), size)
                                             : TIFFReadEncodedStrip(file_.get(), number, block.data(), size);
                const std::size_t rows = std::min(height, grid_.rows - top);
                const std::size_t needed = (tiled ? height : rows) * width * sample_bytes_;
                if (count < 0 || static_cast<std::size_t>(count) < needed)
                    return refused(fmt::format("{} {} is damaged or cut", tiled ? "tile" : "strip", number));
                for (std::size_t row = 0; row < rows; ++row)
                    for (std::size_t column = 0; column < std::min(width, grid_.columns - left); ++column)
                        grid_.heights[(top + row) * grid_.columns + left + column] =
                            sample_(block.data() + (row * width + column) * sample_bytes_);
            }
        return {};
    }

    TiffBytes bytes_;
    std::string_view name_;
    const CityFileSettings& settings_;
    std::string message_;
    std::unique_ptr<TIFF, TiffDelete> file_;
    SampleReader sample_ = nullptr;
    std::size_t sample_bytes_ = 0;
    std::optional<double> no_data_;
    HeightGrid grid_;
};

}  // namespace

Result<CityFile> parse_geotiff(std::string_view bytes, std::string_view name, const CityFileSettings& settings) {
    auto grid = GeoTiffReader(bytes, name, settings).read();
    if (!grid) return fail(grid.error());
    return city_of_grid(std::move(*grid), name, settings);
}

}  // namespace skyloop::inline world
