#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "mesh_support.hpp"

namespace skyloop::mitsuba_scene_test {
namespace {

using test::refusal;
using ::testing::HasSubstr;

constexpr const char* wall_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n10 0 0\n10 0 5\n0 0 5\n4 0 1 2 3\n";
constexpr const char* plane_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n-9 -9 0\n9 -9 0\n9 9 0\n-9 9 0\n4 0 1 2 3\n";

// A member of a tar archive: header with its sum, content, padding.
std::string member(const std::string& name, const std::string& content, char kind = '0') {
    std::string header(512, '\0');
    header.replace(0, name.size(), name);
    const std::string size = fmt::format("{:011o}", content.size());
    header.replace(124, size.size(), size);
    header[156] = kind;
    header.replace(257, 8, std::string("ustar\00000", 8));
    header.replace(148, 8, "        ");
    unsigned sum = 0;
    for (const char c : header)
        sum += static_cast<unsigned char>(c);
    header.replace(148, 8, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
    return header + content + std::string((512 - content.size() % 512) % 512, '\0');
}

std::string scene(const std::string& shapes) {
    return "<?xml version=\"1.0\"?>\n<!-- a scene -->\n<scene version=\"2.1.0\">\n"
           "<bsdf type=\"itu-radio-material\" id=\"front\"><string name=\"type\" value=\"marble\"/></bsdf>\n"
           "<bsdf type=\"twosided\" id=\"mat-itu_brick\"/>\n" +
           shapes + "</scene>\n";
}

std::string shape(const std::string& id, const std::string& file, const std::string& bsdf,
                  const std::string& more = "") {
    return fmt::format(
        "<shape type=\"ply\" id=\"{}\"><string name=\"filename\" value=\"{}\"/><ref id=\"{}\" name=\"bsdf\"/>{}"
        "</shape>\n",
        id, file, bsdf, more);
}

std::string archive(const std::string& xml) {
    return member("town/", "", '5') + member("town/town.xml", xml) + member("town/meshes/wall.ply", wall_ply) +
           member("town/meshes/plane.ply", plane_ply) + std::string(1024, '\0');
}

Result<CityFile> read_archive(std::string_view bytes, const CityFileSettings& settings = {}) {
    return parse_city_archive(bytes, "town.tar", settings);
}

TEST(MitsubaScene, ReadsShapesMaterialsAndGround) {
    const auto file = read_archive(archive(scene(shape("mesh-a", "meshes/wall.ply", "front") +
                                                 shape("mesh-b", "meshes/wall.ply", "mat-itu_brick") +
                                                 shape("mesh-Plane", "meshes/plane.ply", "elsewhere"))));
    ASSERT_TRUE(file) << file.error().message;
    test::expect_sound(*file);
    EXPECT_EQ(file->format, "mitsuba");
    EXPECT_EQ(file->model.materials, (std::vector<std::string>{"concrete", "marble", "brick"}));
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::wall), 4U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::ground), 2U);
    EXPECT_EQ(file->model.triangles[0].material, 1);
    EXPECT_EQ(file->model.triangles[2].material, 2);
    EXPECT_EQ(file->model.triangles[4].material, 0);
}

TEST(MitsubaScene, PlacesShapes) {
    const std::string moved =
        "<transform name=\"to_world\"><scale value=\"2\"/><rotate z=\"1\" angle=\"90\"/><translate x=\"100\" y=\"50\"/>"
        "</transform>";
    const auto file = read_archive(archive(scene(shape("a", "meshes/wall.ply", "front", moved))));
    ASSERT_TRUE(file) << file.error().message;
    for (const Eigen::Vector3d& vertex : file->model.vertices)
        EXPECT_NEAR(vertex.x(), 100, 1e-12);
    EXPECT_NEAR(test::highest_of(file->model).z(), 10, 1e-12);
    EXPECT_NEAR(test::area_of(file->model), 200, 1e-9);
    const std::string matrix =
        "<transform name=\"to_world\"><matrix value=\"0 -2 0 100 2 0 0 50 0 0 2 0 0 0 0 1\"/></transform>";
    const auto same = read_archive(archive(scene(shape("a", "meshes/wall.ply", "front", matrix))));
    ASSERT_TRUE(same) << same.error().message;
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT((same->model.vertices[i] - file->model.vertices[i]).norm(), 1e-12);
}

TEST(MitsubaScene, DropsShapesOfOtherKindsWithAWarning) {
    const auto file = read_archive(
        archive(scene(shape("a", "meshes/wall.ply", "front") + "<shape type=\"sphere\"/><shape type=\"disk\"/>")));
    ASSERT_TRUE(file);
    EXPECT_EQ(file->dropped, 2U);
    ASSERT_EQ(file->warnings.size(), 1U);
    EXPECT_THAT(file->warnings[0], HasSubstr("dropped 2 shapes"));
    EXPECT_THAT(file->warnings[0], HasSubstr("'sphere'"));
}

TEST(MitsubaScene, NamesWhatIsWrong) {
    const auto said = [](const std::string& shapes) { return refusal(read_archive(archive(scene(shapes)))); };
    EXPECT_THAT(said(shape("a", "meshes/none.ply", "front")),
                HasSubstr("town/town.xml:6: names the file 'meshes/none.ply'"));
    for (const char* outside : {"../../etc/passwd", "/etc/passwd", "meshes/../../x.ply", "..\\x.ply", "", "c:/x.ply"})
        EXPECT_THAT(said(shape("a", outside, "front")), HasSubstr("inside the scene's folder")) << outside;
    EXPECT_THAT(said(shape("a", "meshes/wall.ply", "front", "<transform><lookat/></transform>")),
                HasSubstr("'lookat'"));
    EXPECT_THAT(said("<include filename=\"other.xml\"/>"), HasSubstr("town.xml:6: includes another scene"));
    EXPECT_THAT(said(""), HasSubstr("holds no triangle"));
    EXPECT_THAT(said("<shape"), HasSubstr("town/town.xml:"));
    EXPECT_THAT(refusal(read_archive(archive("<city/>"))), HasSubstr("town/town.xml: its first element is 'city'"));
    std::string broken = archive(scene(shape("a", "meshes/wall.ply", "front")));
    broken.replace(broken.find("4 0 1 2 3"), 9, "4 0 1 2 9");
    EXPECT_THAT(refusal(read_archive(broken)), HasSubstr("meshes/wall.ply:14: face 0 names vertex 9"));
}

TEST(MitsubaScene, RefusesDamagedArchives) {
    const std::string whole = archive(scene(shape("a", "meshes/wall.ply", "front")));
    ASSERT_TRUE(read_archive(whole));
    std::string sum = whole;
    sum[3] = 'x';
    EXPECT_THAT(refusal(read_archive(sum)), HasSubstr("town.tar: no whole tar archive ("));
    EXPECT_THAT(refusal(read_archive("")), HasSubstr("town.tar: "));
    EXPECT_THAT(refusal(read_archive(member("a.xml", "") + member("b.xml", ""))),
                HasSubstr("town.tar: an archive of 2 cities: a.xml, b.xml; expected one"));
    EXPECT_THAT(refusal(read_archive(member("../a.xml", "<scene/>"))),
                HasSubstr("town.tar:../a.xml: leads out of the archive"));
    EXPECT_THAT(refusal(read_archive(member("a.xml", "<scene/>", '2'))),
                HasSubstr("an archive of 0 cities; expected one"))
        << "a link";
    EXPECT_THAT(refusal(read_archive(std::string_view(whole).substr(0, 700))),
                HasSubstr("town.tar: no whole tar archive ("));
    EXPECT_THAT(refusal(read_archive(std::string_view(whole).substr(0, 1100))),
                HasSubstr("town.tar:town/town.xml: cannot be unpacked; expected a whole file ("));
    for (std::size_t size = 0; size < whole.size(); size += 13) {
        const auto file = read_archive(std::string_view(whole).substr(0, size));
        if (file) test::expect_sound(*file);
    }
}

TEST(MitsubaScene, PassesOverWhatMacOsPutsIntoArchives) {
    const auto file =
        read_archive(member("town/._town.xml", "not XML") + archive(scene(shape("a", "meshes/wall.ply", "front"))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.triangles.size(), 2U);
}

TEST(MitsubaScene, ReadsLongNames) {
    const std::string folder(150, 'd');
    const std::string xml = scene(shape("a", "wall.ply", "front"));
    const std::string path = " path=" + folder + "/wall.ply\n";
    const auto file =
        read_archive(member("././@LongLink", folder + "/town.xml" + std::string(1, '\0'), 'L') + member("cut", xml) +
                     member("pax", fmt::format("{}{}", path.size() + 3, path), 'x') + member("cut", wall_ply));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.triangles.size(), 2U);
}

TEST(MitsubaScene, IsReadFromAFolderAndByItsName) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(::testing::TempDir()) / "skyloop_mitsuba_scene";
    fs::remove_all(folder);
    fs::create_directories(folder / "meshes");
    std::ofstream(folder / "town.xml") << scene(shape("a", "meshes/wall.ply", "front"));
    EXPECT_THAT(refusal(read_city(folder, {}).map_error([](Error error) {
                    error.code = ErrorCode::input;  // the file beside it is absent: of the outside world
                    return error;
                })),
                HasSubstr("wall.ply"));
    std::ofstream(folder / "meshes/wall.ply") << wall_ply;
    std::ofstream(folder / "._town.xml") << "not XML";
    for (const fs::path& path : {folder, folder / "town.xml"}) {
        const auto file = read_city(path, {});
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->model.triangles.size(), 2U);
    }
    std::ofstream(folder / "secret") << wall_ply;
    fs::create_directories(folder / "inner");
    fs::create_symlink(folder / "secret", folder / "inner" / "wall.ply");
    std::ofstream(folder / "inner/town.xml") << scene(shape("a", "wall.ply", "front"));
    EXPECT_THAT(refusal(read_city(folder / "inner", {})), HasSubstr("leads out of its folder"));
    fs::remove_all(folder);
}

}  // namespace
}  // namespace skyloop::mitsuba_scene_test
