/// make_geoid IN.gtx OUT.pgm: turns a worldwide geoid grid in NOAA's GTX format into the PGM that GeographicLib::Geoid
/// reads. The build runs it on EGM96 as Debian's package proj-data brings it. The same input gives the same bytes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

// What a pixel means, as in the grids that GeographicLib publishes (GeographicLib documentation, "The format of the
// geoid files"): height = offset + scale · pixel, metres.
constexpr double offset = -108;
constexpr double scale = 0.003;
constexpr double largest_pixel = 65535;

// NOAA VDatum GTX: four doubles, two 32-bit integers, then floats; all big-endian, rows from the south.
constexpr std::size_t header_size = 40;
constexpr std::size_t largest_file = std::size_t{1} << 30;

/// A whole unsigned big-endian number of up to eight bytes.
std::uint64_t big_endian(std::span<const unsigned char> bytes) {
    std::uint64_t value = 0;
    for (const unsigned char byte : bytes)
        value = value << 8 | byte;
    return value;
}

/// Geoid heights on a grid that covers the Earth.
struct Grid {
    double west = 0;  ///< longitude of the first column, degrees
    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<float> heights;  ///< metres, row by row from the south pole
};

Bytes read_bytes(const fs::path& path) {
    if (!fs::is_regular_file(path)) throw std::runtime_error(path.string() + ": no such file");
    if (fs::file_size(path) > largest_file) throw std::runtime_error(path.string() + ": too large for a geoid grid");
    std::ifstream file(path, std::ios::binary);
    Bytes bytes{std::istreambuf_iterator<char>(file), {}};
    if (file.bad()) throw std::runtime_error(path.string() + ": cannot be read");
    return bytes;
}

Grid read_gtx(const fs::path& path) {
    const Bytes bytes = read_bytes(path);
    const auto refuse = [&](const std::string& why) -> std::runtime_error {
        return std::runtime_error(path.string() + ": not a worldwide GTX grid: " + why);
    };
    if (bytes.size() < header_size) throw refuse("shorter than its header");
    const std::span<const unsigned char> all(bytes);
    const auto number = [&](std::size_t at) { return std::bit_cast<double>(big_endian(all.subspan(at, 8))); };
    const double south = number(0);
    const double row_step = number(16);
    const double column_step = number(24);
    Grid grid;
    grid.west = number(8);
    grid.rows = big_endian(all.subspan(32, 4));
    grid.columns = big_endian(all.subspan(36, 4));
    // The bound keeps the product inside 64 bits.
    if (std::max(grid.rows, grid.columns) > largest_file || bytes.size() != header_size + grid.rows * grid.columns * 4)
        throw refuse("its size does not fit its header");
    if (south != -90 || grid.rows < 3 || std::abs(row_step * static_cast<double>(grid.rows - 1) - 180) > 1e-6)
        throw refuse("its rows do not reach from pole to pole");
    if (grid.columns < 2 || std::abs(column_step * static_cast<double>(grid.columns) - 360) > 1e-6)
        throw refuse("its columns do not go once around");
    if (grid.rows % 2 == 0 || grid.columns % 2 != 0)
        throw refuse("expected an odd number of rows and an even one of columns");
    for (std::size_t at = header_size; at < bytes.size(); at += 4)
        grid.heights.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(big_endian(all.subspan(at, 4)))));
    return grid;
}

/// The column that stands for longitude 0.
std::size_t greenwich_column(const Grid& grid) {
    const double columns = static_cast<double>(grid.columns);
    const double column = std::fmod(-grid.west / 360 * columns + columns, columns);
    if (!(std::abs(column - std::round(column)) < 1e-6))
        throw std::runtime_error("no column of the grid stands at longitude 0");
    return static_cast<std::size_t>(std::llround(column)) % grid.columns;
}

std::uint16_t pixel(float height) {
    const double value = std::round((height - offset) / scale);
    if (!(value >= 0 && value <= largest_pixel))
        throw std::runtime_error("a height of " + std::to_string(height) + " m does not fit the format");
    return static_cast<std::uint16_t>(value);
}

// The errors of interpolation are those that GeographicLib's documentation gives for EGM96 on 15 minutes; the date is
// that of the model's publication (NASA/TP-1998-206861), so that the file does not depend on the day of the build. The
// scale has no decimal point: GeographicLib reads it by the locale of the program around it, which may want a comma.
std::string pgm_header(const Grid& grid) {
    return "P5\n"
           "# Geoid file in PGM format for the GeographicLib::Geoid class\n"
           "# Description WGS84 EGM96, " +
           std::to_string(180 * 60 / (grid.rows - 1)) +
           "-minute grid\n"
           "# DateTime 1998-07-01 00:00:00\n"
           "# MaxBilinearError 1.152\n"
           "# RMSBilinearError 0.040\n"
           "# MaxCubicError 0.169\n"
           "# RMSCubicError 0.007\n"
           "# Offset -108\n"
           "# Scale 3e-3\n"
           "# Origin 90N 0E\n"
           "# AREA_OR_POINT Point\n"
           "# Vertical_Datum WGS84\n" +
           std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n65535\n";
}

void write_pgm(const Grid& grid, const fs::path& path) {
    std::string text = pgm_header(grid);
    const std::size_t first = greenwich_column(grid);
    for (std::size_t row = grid.rows; row-- > 0;)
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const std::uint16_t value = pixel(grid.heights[row * grid.columns + (first + column) % grid.columns]);
            text += static_cast<char>(value >> 8);
            text += static_cast<char>(value & 0xff);
        }
    // Beside and then renamed: an interrupted build leaves no half grid.
    const fs::path beside = path.string() + ".part";
    std::ofstream file(beside, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error(beside.string() + ": cannot be written");
    fs::rename(beside, path);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::cerr << "usage: make_geoid IN.gtx OUT.pgm\n";
        return 2;
    }
    try {
        write_pgm(read_gtx(arguments[1]), arguments[2]);
    } catch (const std::exception& reason) {
        std::cerr << "make_geoid: " << reason.what() << '\n';
        return 1;
    }
    return 0;
}
