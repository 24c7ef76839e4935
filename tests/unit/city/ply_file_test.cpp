#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "mesh_support.hpp"

namespace skyloop::ply_file_test {
namespace {

using test::refusal;
using ::testing::HasSubstr;

constexpr const char* ascii_wall =
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "element face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    "0 0 0 255\n10 0 0 255\n10 0 5 255\n0 0 5 255\n4 0 1 2 3 2 0.5 0.5\n0 1\n";

Result<CityFile> read_ply(std::string_view bytes, const CityFileSettings& settings = {}) {
    return parse_ply(bytes, "city.ply", settings);
}

template <class T>
void append(std::string& bytes, T value, bool big) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string header(bool big, const std::string& elements) {
    return fmt::format("ply\nformat binary_{}_endian 1.0\n{}end_header\n", big ? "big" : "little", elements);
}

// A wall of doubles, with corners numbered by shorts and a normal of other types between.
std::string binary_wall(bool big) {
    std::string bytes = header(big,
                               "element vertex 4\nproperty double x\nproperty short extra\nproperty double y\n"
                               "property double z\nelement face 1\nproperty uchar flag\n"
                               "property list uint16 uint16 vertex_index\n");
    for (const auto& [x, z] : {std::pair{0., 0.}, {10., 0.}, {10., 5.}, {0., 5.}}) {
        append(bytes, x, big);
        append(bytes, std::int16_t{-7}, big);
        append(bytes, 3.5, big);
        append(bytes, z, big);
    }
    append(bytes, std::uint8_t{1}, big);
    append(bytes, std::uint16_t{4}, big);
    for (std::uint16_t corner = 0; corner < 4; ++corner)
        append(bytes, corner, big);
    return bytes;
}

TEST(PlyFile, ReadsText) {
    const auto file = read_ply(ascii_wall);
    ASSERT_TRUE(file) << file.error().message;
    test::expect_sound(*file);
    EXPECT_EQ(file->format, "ply");
    EXPECT_EQ(file->model.triangles.size(), 2U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::wall), 2U);
    EXPECT_DOUBLE_EQ(test::area_of(file->model), 50);
}

TEST(PlyFile, AMarkOfTheEncodingMayStandBeforeIt) {
    const auto file = read_ply(std::string("\xEF\xBB\xBF") + ascii_wall);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.triangles.size(), 2U);
}

TEST(PlyFile, ReadsBothOrdersOfBytes) {
    for (const bool big : {false, true}) {
        const auto file = read_ply(binary_wall(big));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_DOUBLE_EQ(test::area_of(file->model), 50);
        for (const Eigen::Vector3d& vertex : file->model.vertices)
            EXPECT_EQ(vertex.y(), 3.5);
    }
}

TEST(PlyFile, BelievesNoCountBeforeTheBytesAreThere) {
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string corners = "property float x\nproperty float y\nproperty float z\n";
    for (const char* count : {"100000000", "4294967295", "18446744073709551615"}) {
        CityFileSettings settings;
        settings.most_triangles = 1'000'000'000;
        EXPECT_THAT(
            refusal(read_ply(header(false, fmt::format("element vertex {}\n{}{}", count, corners, faces)), settings)),
            HasSubstr("0 bytes are left"))
            << count;
        EXPECT_THAT(refusal(read_ply(fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n{}end_header\n1 2 3\n",
                                                 count, corners))),
                    HasSubstr("6 bytes are left"));
    }
    EXPECT_THAT(refusal(read_ply(header(false, "element nothing 18446744073709551615\n"))),
                HasSubstr("of at least 0 bytes"));
    std::string list =
        header(false, "element vertex 1\n" + corners + "element face 1\nproperty list uint int vertex_indices\n");
    for (int i = 0; i < 3; ++i)
        append(list, 1.0F, false);
    append(list, std::uint32_t{0xFFFFFFFF}, false);
    EXPECT_THAT(refusal(read_ply(list)), HasSubstr("a list of 4294967295 items in face 0, but 0 bytes are left"));
    EXPECT_THAT(
        refusal(read_ply("ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_indices\nend_header\n"
                         "-3 0 1 2\n")),
        HasSubstr("city.ply:6: a list of -3 items"));
}

TEST(PlyFile, NamesTheLineOrByteOfWhatIsWrong) {
    const std::string text = ascii_wall;
    const auto with = [&](const std::string& old, const std::string& put) {
        std::string changed = text;
        changed.replace(changed.find(old), old.size(), put);
        return refusal(read_ply(changed));
    };
    EXPECT_THAT(with("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("city.ply:21: face 0 names vertex 4, of 4"));
    EXPECT_THAT(with("4 0 1 2 3", "4 0 1 2 -1"), HasSubstr("names vertex -1"));
    EXPECT_THAT(with("10 0 5 255", "10 zero 5 255"),
                HasSubstr("city.ply:19: expected a number of vertex 2, found 'zero'"));
    EXPECT_THAT(with("format ascii 1.0", "format ascii 2.0"), HasSubstr("city.ply:2: expected 'format"));
    EXPECT_THAT(with("element vertex 4", "element vertex four"), HasSubstr("city.ply:5: expected a count"));
    EXPECT_THAT(with("element vertex 4", "element vertex -4"), HasSubstr("city.ply:5: expected a count"));
    EXPECT_THAT(with("property float x", "property real x"), HasSubstr("city.ply:6: expected types"));
    EXPECT_THAT(with("property float x", "property float u"), HasSubstr("no x, y and z"));
    EXPECT_THAT(with("vertex_indices", "corners"), HasSubstr("no list vertex_indices"));
    EXPECT_THAT(with("list uchar int", "list float int"), HasSubstr("whole one for the count"));
    EXPECT_THAT(with("comment", "commend"), HasSubstr("city.ply:3: 'commend' is no keyword"));
    EXPECT_THAT(with("ply\nformat", "plz\nformat"), HasSubstr("city.ply:1: is no PLY file"));
    EXPECT_THAT(with("end_header\n", "no_end\n"), HasSubstr("no keyword"));
    EXPECT_THAT(with("element edge 1", "element tristrips 1"), HasSubstr("triangle strips"));
    const std::string binary = binary_wall(false);
    EXPECT_THAT(refusal(read_ply(std::string_view(binary).substr(0, binary.size() - 1))), HasSubstr("city.ply: byte "));
}

TEST(PlyFile, EveryCutOfAFileIsReadOrRefusedWithASentence) {
    for (const std::string& whole : {std::string(ascii_wall), binary_wall(false), binary_wall(true)})
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const auto file = read_ply(std::string_view(whole).substr(0, size));
            if (file)
                test::expect_sound(*file);
            else
                EXPECT_THAT(file.error().message, HasSubstr("city.ply")) << size;
        }
}

TEST(PlyFile, DropsFacetsWithoutNumbers) {
    std::string text = ascii_wall;
    text.replace(text.find("10 0 5 255"), 10, "10 0 nan 255");
    EXPECT_THAT(refusal(read_ply(text)), HasSubstr("no triangle that can be used"));
}

TEST(PlyFile, RefusesMoreTrianglesThanAllowedBeforeItReadsThem) {
    CityFileSettings settings;
    settings.most_triangles = 0;
    EXPECT_THAT(refusal(read_ply(ascii_wall, settings)), HasSubstr("more than 0 triangles"));
    settings.most_triangles = 1;
    EXPECT_THAT(refusal(read_ply(ascii_wall, settings)), HasSubstr("more than 1 triangles"));
}

}  // namespace
}  // namespace skyloop::ply_file_test
