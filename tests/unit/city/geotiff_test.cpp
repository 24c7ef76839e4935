// GeoTIFFs that libtiff and libgeotiff wrote, as ground.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <geotiff.h>
#include <geovalues.h>
#include <tiffio.h>
#include <xtiffio.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/core/files.hpp"
#include "mesh_support.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

/// What a file is written as. Heights are 100 + 10 row + column.
struct TiffPlan {
    std::uint32_t columns = 5, rows = 4, tile = 0;  ///< 0: strips
    std::uint32_t strip_rows = 3;
    unsigned short format = SAMPLEFORMAT_IEEEFP, bits = 32, compression = COMPRESSION_NONE, samples = 1;
    unsigned short raster = RasterPixelIsArea, projected = 25832, geographic = 0, vertical = 0;
    std::array<double, 2> corner{691000, 5335000};  ///< of the model, at pixel 0, 0
    std::array<double, 2> pixel{10, 20};
    std::optional<std::array<double, 16>> matrix;
    std::string no_data;
    bool pixels = true;
    std::function<double(std::uint32_t, std::uint32_t)> height = [](std::uint32_t row, std::uint32_t column) {
        return 100.0 + 10 * row + column;
    };
};

template <class T>
void put(std::vector<unsigned char>& bytes, std::size_t index, double value) {
    const T sample = static_cast<T>(value);
    std::memcpy(bytes.data() + index * sizeof sample, &sample, sizeof sample);
}

void put_sample(const TiffPlan& plan, std::vector<unsigned char>& bytes, std::size_t index, double value) {
    if (plan.format == SAMPLEFORMAT_IEEEFP)
        plan.bits == 64 ? put<double>(bytes, index, value) : put<float>(bytes, index, value);
    else if (plan.format == SAMPLEFORMAT_INT)
        plan.bits == 32 ? put<std::int32_t>(bytes, index, value) : put<std::int16_t>(bytes, index, value);
    else
        put<std::uint16_t>(bytes, index, value);
}

void write_pixels(TIFF* file, const TiffPlan& plan) {
    const std::uint32_t width = plan.tile ? plan.tile : plan.columns, height = plan.tile ? plan.tile : plan.strip_rows;
    std::uint32_t number = 0;
    for (std::uint32_t top = 0; top < plan.rows; top += height)
        for (std::uint32_t left = 0; left < plan.columns; left += width, ++number) {
            const std::uint32_t rows = plan.tile ? height : std::min(height, plan.rows - top);
            std::vector<unsigned char> block(std::size_t{rows} * width * plan.samples * plan.bits / 8);
            for (std::uint32_t row = 0; row < rows; ++row)
                for (std::uint32_t column = 0; column < width; ++column)
                    put_sample(plan, block, (std::size_t{row} * width + column) * plan.samples,
                               plan.height(top + row, left + column));
            const auto size = static_cast<tmsize_t>(block.size());
            if (plan.tile)
                TIFFWriteEncodedTile(file, number, block.data(), size);
            else
                TIFFWriteEncodedStrip(file, number, block.data(), size);
        }
}

void write_place(TIFF* file, const TiffPlan& plan) {
    if (plan.matrix) {
        TIFFSetField(file, TIFFTAG_GEOTRANSMATRIX, 16, plan.matrix->data());
    } else {
        const std::array<double, 6> tie{0, 0, 0, plan.corner[0], plan.corner[1], 0};
        const std::array<double, 3> scale{plan.pixel[0], plan.pixel[1], 0};
        TIFFSetField(file, TIFFTAG_GEOTIEPOINTS, 6, tie.data());
        TIFFSetField(file, TIFFTAG_GEOPIXELSCALE, 3, scale.data());
    }
    GTIF* const keys = GTIFNew(file);
    const bool geographic = plan.geographic != 0;
    GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1, geographic ? ModelTypeGeographic : ModelTypeProjected);
    GTIFKeySet(keys, GTRasterTypeGeoKey, TYPE_SHORT, 1, static_cast<int>(plan.raster));
    if (geographic) GTIFKeySet(keys, GeographicTypeGeoKey, TYPE_SHORT, 1, static_cast<int>(plan.geographic));
    if (plan.projected && !geographic)
        GTIFKeySet(keys, ProjectedCSTypeGeoKey, TYPE_SHORT, 1, static_cast<int>(plan.projected));
    if (plan.vertical) GTIFKeySet(keys, VerticalCSTypeGeoKey, TYPE_SHORT, 1, static_cast<int>(plan.vertical));
    GTIFWriteKeys(keys);
    GTIFFree(keys);
}

constexpr std::uint32_t no_data_tag = 42113;

std::string tiff_bytes(const TiffPlan& plan) {
    const auto path = std::filesystem::temp_directory_path() / fmt::format("skyloop-{}.tif", std::random_device()());
    TIFF* const file = XTIFFOpen(path.c_str(), "w");
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, plan.columns);
    TIFFSetField(file, TIFFTAG_IMAGELENGTH, plan.rows);
    TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, plan.samples);
    TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, plan.format);
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, plan.bits);
    TIFFSetField(file, TIFFTAG_COMPRESSION, plan.compression);
    TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (plan.tile) {
        TIFFSetField(file, TIFFTAG_TILEWIDTH, plan.tile);
        TIFFSetField(file, TIFFTAG_TILELENGTH, plan.tile);
    } else {
        TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, plan.strip_rows);
    }
    if (!plan.no_data.empty()) {
        const TIFFFieldInfo info{no_data_tag, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDAL_NODATA")};
        TIFFMergeFieldInfo(file, &info, 1);
        TIFFSetField(file, no_data_tag, plan.no_data.c_str());
    }
    write_place(file, plan);
    unsigned char nothing = 0;
    if (plan.pixels)
        write_pixels(file, plan);
    else
        TIFFWriteRawStrip(file, 0, &nothing, 1);
    XTIFFClose(file);
    std::string bytes = read_text_file(path).value();
    std::filesystem::remove(path);
    return bytes;
}

Result<CityFile> read_tiff(const TiffPlan& plan, const CityFileSettings& settings = {}) {
    return parse_geotiff(tiff_bytes(plan), "hills.tif", settings);
}

/// Heights above the ellipsoid, or what stands for them: up of each cell and the origin's height.
double height_of_cell(const CityFile& file, std::size_t cell) {
    return file.model.vertices.at(cell).z() + file.model.origin.height.above_ellipsoid.value();
}

TEST(GeoTiff, ReadsEveryKindOfSampleInStripsAndTiles) {
    for (const auto& [format, bits] : {std::pair<unsigned short, unsigned short>{SAMPLEFORMAT_IEEEFP, 32},
                                       {SAMPLEFORMAT_IEEEFP, 64},
                                       {SAMPLEFORMAT_INT, 16},
                                       {SAMPLEFORMAT_INT, 32},
                                       {SAMPLEFORMAT_UINT, 16}})
        for (const std::uint32_t tile : {0U, 16U})
            for (const int compression : {COMPRESSION_NONE, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_LZW}) {
                TiffPlan plan;
                plan.columns = 40;
                plan.rows = 21;
                plan.format = format;
                plan.bits = bits;
                plan.tile = tile;
                plan.compression = static_cast<unsigned short>(compression);
                const auto file = read_tiff(plan);
                ASSERT_TRUE(file) << file.error().message;
                EXPECT_EQ(file->format, "height grid");
                ASSERT_EQ(file->model.vertices.size(), 840U);
                ASSERT_EQ(file->model.triangles.size(), 2U * 39 * 20);
                const double first = file->model.vertices[0].z();
                // Over 400 m the Earth curves away by 13 mm.
                EXPECT_NEAR(file->model.vertices[39].z() - first, 39, 0.02);
                EXPECT_NEAR(file->model.vertices[20 * 40 + 7].z() - first, 207, 0.02);
            }
}

// echo 691020 5334960 | cs2cs -f %.9f EPSG:25832 EPSG:4326: the corner, and 5 by 4 pixels of 10 by 20 m from it.
constexpr double middle_latitude = 48.139192829, middle_longitude = 11.567751857;

TEST(GeoTiff, PixelsAreAreasOrPoints) {
    TiffPlan plan;  // 5 by 4 areas: their middles span 691005 … 691045 and 5334990 … 5334930
    const auto areas = read_tiff(plan);
    ASSERT_TRUE(areas) << areas.error().message;
    plan.raster = RasterPixelIsPoint;  // 691000 … 691040 and 5335000 … 5334940
    const auto points = read_tiff(plan);
    ASSERT_TRUE(points) << points.error().message;
    CityFileSettings there;
    there.origin = areas->model.origin;
    const auto beside = read_tiff(plan, there);
    ASSERT_TRUE(beside) << beside.error().message;
    const Eigen::Vector3d way = beside->model.vertices[0] - areas->model.vertices[0];
    EXPECT_NEAR(way.head<2>().norm(), std::hypot(5, 10), 0.01);
    EXPECT_NEAR(std::atan2(way.x(), way.y()), std::atan2(-5, 10) + Angle::degrees(1.913).rad(), 1e-3);
}

TEST(GeoTiff, LiesWhereProjPutsIt) {
    TiffPlan plan;
    plan.raster = RasterPixelIsPoint;
    plan.rows = 5;  // points: the middle one is 691020, 5334960
    const auto file = read_tiff(plan);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.latitude.deg(), middle_latitude, 1e-8);
    EXPECT_NEAR(file->model.origin.longitude.deg(), middle_longitude, 1e-8);
    EXPECT_LT(file->model.vertices.at(12).head<2>().norm(), 1e-3);
    for (const CityTriangle& triangle : file->model.triangles) {
        const auto& v = file->model.vertices;
        const auto& [a, b, c] = triangle.corners;
        EXPECT_GT((v[b] - v[a]).cross(v[c] - v[a]).z(), 0) << "seen from above";
    }
}

TEST(GeoTiff, TakesDegreesAndHeightsOfAVerticalSystem) {
    TiffPlan plan;
    plan.geographic = 4326;
    plan.vertical = 5773;  // EGM96
    plan.raster = RasterPixelIsPoint;
    plan.columns = plan.rows = 3;
    plan.corner = {4.359, 52.011};
    plan.pixel = {0.001, 0.001};
    plan.height = [](auto, auto) { return 10; };
    const auto sea = read_tiff(plan);
    ASSERT_TRUE(sea) << sea.error().message;
    EXPECT_NEAR(sea->model.origin.latitude.deg(), 52.01, 1e-9);
    EXPECT_NEAR(sea->model.origin.longitude.deg(), 4.36, 1e-9);
    EXPECT_NEAR(height_of_cell(*sea, 4), 53.4667, 1e-3) << "echo 52.01 4.36 10 | cs2cs EPSG:4326+5773 EPSG:4979";
    plan.vertical = 0;
    const auto ellipsoid = read_tiff(plan);
    ASSERT_TRUE(ellipsoid) << ellipsoid.error().message;
    EXPECT_NEAR(height_of_cell(*ellipsoid, 4), 10, 1e-6);
}

TEST(GeoTiff, TakesAMatrixThatTurnsAndRowsThatRunNorth) {
    TiffPlan plan;
    plan.raster = RasterPixelIsPoint;
    plan.rows = 5;
    plan.matrix = {0, 10, 0, 691000, 10, 0, 0, 5334940, 0, 0, 0, 0, 0, 0, 0, 1};  // columns north, rows east
    const auto file = read_tiff(plan);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.latitude.deg(), middle_latitude, 1e-8);
    EXPECT_NEAR(file->model.origin.longitude.deg(), middle_longitude, 1e-8);
    const Eigen::Vector3d column = file->model.vertices[1] - file->model.vertices[0];
    EXPECT_GT(column.y(), 9.9);
    for (const CityTriangle& triangle : file->model.triangles) {
        const auto& v = file->model.vertices;
        const auto& [a, b, c] = triangle.corners;
        EXPECT_GT((v[b] - v[a]).cross(v[c] - v[a]).z(), 0) << "seen from above";
    }
}

TEST(GeoTiff, LeavesNoDataOut) {
    for (const auto& [no_data, hole] : {std::pair("-9999", -9999.0), std::pair("nan", std::nan("")),
                                        std::pair("-3.4028234663852886e+38", -3.4028234663852886e+38)}) {
        TiffPlan plan;
        plan.no_data = no_data;
        plan.height = [hole = hole](auto row, auto column) { return row == 1 && column == 2 ? hole : 7.0; };
        const auto file = read_tiff(plan);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->model.vertices.size(), 19U) << no_data;
        EXPECT_EQ(file->dropped, 0U) << no_data;
        EXPECT_EQ(file->model.triangles.size(), 24U - 4) << "four cells have one triangle less";
    }
    TiffPlan plan;
    plan.height = [](auto row, auto) { return row == 1 ? 1e30 : 7.0; };
    const auto file = read_tiff(plan);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->dropped, 5U);
    EXPECT_THAT(file->warnings, Contains(HasSubstr("5 heights are no numbers")));
}

TEST(GeoTiff, TakesTheKeyWhereTheFileNamesNoSystem) {
    TiffPlan plan;
    plan.projected = 0;
    EXPECT_THAT(refusal(read_tiff(plan)), AllOf(HasSubstr("names no reference system"), HasSubstr("scene.file_crs")));
    CityFileSettings settings;
    settings.file_crs = "EPSG:25832";
    const auto file = read_tiff(plan, settings);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.latitude.deg(), middle_latitude, 1e-4);
}

TEST(GeoTiff, RefusesWhatIsDamagedInOneLine) {
    EXPECT_THAT(refusal(parse_geotiff("", "hills.tif", {})), HasSubstr("hills.tif: is no TIFF"));
    EXPECT_THAT(refusal(parse_geotiff("ncols 3", "hills.tif", {})), HasSubstr("hills.tif: is no TIFF"));
    TiffPlan plan;
    plan.geographic = 4326;
    plan.corner = {11, 48};
    plan.pixel = {0.001, 0.001};
    plan.columns = plan.rows = 64;
    plan.strip_rows = 8;
    const std::string whole = tiff_bytes(plan);
    ASSERT_TRUE(parse_geotiff(whole, "hills.tif", {}));
    for (std::size_t size = 0; size < whole.size(); size += 97)
        EXPECT_FALSE(parse_geotiff(std::string_view(whole).substr(0, size), "hills.tif", {})) << size;
    plan.compression = COMPRESSION_ADOBE_DEFLATE;
    std::string noise = tiff_bytes(plan);
    for (std::size_t i = 0; i < noise.size(); i += 13) {
        std::string damaged = noise;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
        if (const auto read = parse_geotiff(damaged, "hills.tif", {}); read)
            expect_sound(*read);
        else
            EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    }
}

TEST(GeoTiff, RefusesWhatIsNoGridOfHeights) {
    TiffPlan colours;
    colours.samples = 3;
    EXPECT_THAT(refusal(read_tiff(colours)), HasSubstr("3 samples of 32 bits a pixel"));
    TiffPlan thin;
    thin.columns = 1;
    EXPECT_THAT(refusal(read_tiff(thin)), HasSubstr("1 by 4 cells"));
    TiffPlan flat;
    flat.pixel = {0, 0};
    EXPECT_THAT(refusal(read_tiff(flat)), HasSubstr("no size"));
    TiffPlan wide;
    wide.columns = wide.rows = 64;
    CityFileSettings small;
    small.most_triangles = 7000;
    EXPECT_THAT(refusal(read_tiff(wide, small)), HasSubstr("holds 7938 triangles, 7000 are the most"));
}

// Headers alone that tell of 4 billion by 4 billion pixels, and of a strip of 560 MB.
TEST(GeoTiff, BelievesNoCountOfAHeader) {
    std::string bytes = tiff_bytes({});
    const auto directory = [&] {
        std::uint32_t at = 0;
        std::memcpy(&at, bytes.data() + 4, 4);
        return at;
    }();
    for (std::size_t entry = 0; entry < 2; ++entry) {  // ImageWidth and ImageLength, of type SHORT, come first
        const std::uint16_t type_long = 4;
        const std::uint32_t huge = 0xffffffff;
        std::memcpy(bytes.data() + directory + 2 + 12 * entry + 2, &type_long, 2);
        std::memcpy(bytes.data() + directory + 2 + 12 * entry + 8, &huge, 4);
    }
    EXPECT_THAT(refusal(parse_geotiff(bytes, "hills.tif", {})), HasSubstr("hills.tif: "));
    TiffPlan wide;
    wide.columns = 70'000;
    wide.rows = 2000;
    wide.strip_rows = 2000;
    wide.pixels = false;
    wide.compression = COMPRESSION_ADOBE_DEFLATE;  // else libtiff cuts the strip into small ones
    CityFileSettings many;
    many.most_triangles = 1'000'000'000;
    EXPECT_THAT(refusal(read_tiff(wide, many)), HasSubstr("strips are no good"));
    EXPECT_THAT(refusal(read_tiff(wide)), HasSubstr("GB of memory"));
}

}  // namespace
}  // namespace skyloop::test
