/// make_geoid GRID OUT.pgm: turns the worldwide geoid grid of 15 minutes that PROJ reads into the PGM that
/// GeographicLib::Geoid reads. The build runs it on EGM96 as Debian's package proj-data brings it. The same input gives
/// the same bytes.
#include <proj.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

namespace {

namespace fs = std::filesystem;

// What a pixel means, as in the grids that GeographicLib publishes (GeographicLib documentation, "The format of the
// geoid files"): height = offset + scale · pixel, metres.
constexpr double offset = -108, scale = 0.003, largest_pixel = 65535;
constexpr int columns = 1440, rows = 721;
constexpr double step = 0.25;  // degrees

// The errors of interpolation are those that GeographicLib's documentation gives for EGM96 on 15 minutes; the date is
// that of the model's publication (NASA/TP-1998-206861), so that the file does not depend on the day of the build. The
// scale has no decimal point: GeographicLib reads it by the locale of the program around it, which may want a comma.
constexpr const char* pgm_header =
    "P5\n"
    "# Geoid file in PGM format for the GeographicLib::Geoid class\n"
    "# Description WGS84 EGM96, 15-minute grid\n"
    "# DateTime 1998-07-01 00:00:00\n"
    "# MaxBilinearError 1.152\n"
    "# RMSBilinearError 0.040\n"
    "# MaxCubicError 0.169\n"
    "# RMSCubicError 0.007\n"
    "# Offset -108\n"
    "# Scale 3e-3\n"
    "# Origin 90N 0E\n"
    "# AREA_OR_POINT Point\n"
    "# Vertical_Datum WGS84\n"
    "1440 721\n65535\n";

/// Reads a grid at its nodes, by PROJ.
class GeoidGrid {
public:
    explicit GeoidGrid(const fs::path& path) : path_(path.string()) {
        if (!fs::is_regular_file(path)) throw std::runtime_error(path_ + ": no such file");
        proj_log_level(context_.get(), PJ_LOG_NONE);
        proj_context_set_enable_network(context_.get(), 0);
        const std::string shift = "+proj=vgridshift +multiplier=1 +grids=\"" + fs::absolute(path).string() + '"';
        grid_.reset(proj_create(context_.get(), shift.c_str()));
        if (!grid_) throw std::runtime_error(path_ + ": no grid that PROJ reads");
    }
    [[nodiscard]] float height(int row, int column) const {
        constexpr double radians = std::numbers::pi / 180;
        const double latitude = 90 - step * row, longitude = std::remainder(step * column, 360);
        const PJ_COORD node = proj_coord(longitude * radians, latitude * radians, 0, HUGE_VAL);
        const double height = proj_trans(grid_.get(), PJ_FWD, node).xyz.z;
        if (!std::isfinite(height))
            throw std::runtime_error(path_ + ": no height at " + std::to_string(latitude) + ", " +
                                     std::to_string(longitude));
        return static_cast<float>(height);  // as it stands in the grid, without the noise of interpolation
    }

private:
    struct Destroy {
        void operator()(PJ* object) const { proj_destroy(object); }
        void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
    };
    std::string path_;
    std::unique_ptr<PJ_CONTEXT, Destroy> context_{proj_context_create()};
    std::unique_ptr<PJ, Destroy> grid_;
};

std::uint16_t pixel(float height) {
    const double value = std::round((height - offset) / scale);
    if (!(value >= 0 && value <= largest_pixel))
        throw std::runtime_error("a height of " + std::to_string(height) + " m does not fit the format");
    return static_cast<std::uint16_t>(value);
}

void write_pgm(const GeoidGrid& grid, const fs::path& path) {
    std::string text = pgm_header;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const std::uint16_t value = pixel(grid.height(row, column));
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
        std::cerr << "usage: make_geoid GRID OUT.pgm\n";
        return 2;
    }
    try {
        write_pgm(GeoidGrid(arguments[1]), arguments[2]);
    } catch (const std::exception& reason) {
        std::cerr << "make_geoid: " << reason.what() << '\n';
        return 1;
    }
    return 0;
}
