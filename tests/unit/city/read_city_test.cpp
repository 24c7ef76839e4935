#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/core/archive.hpp"
#include "base/core/files.hpp"
#include "mesh_support.hpp"
#include "support/oracle_table.hpp"
#include "support/packed.hpp"

namespace skyloop::read_city_test {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using ::testing::Contains;
using ::testing::HasSubstr;

class ReadCity : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(::testing::TempDir()) / (std::string("skyloop_read_city_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path put(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    fs::path folder_;
};

constexpr const char* small_obj = "v 0 0 0\nv 20 0 0\nv 0 0 20\nf 1 2 3\n";

TEST_F(ReadCity, GoesByTheEndingInAnyCase) {
    EXPECT_EQ(read_city(put("a.obj", small_obj), {})->format, "obj");
    EXPECT_EQ(read_city(put("A.OBJ", small_obj), {})->format, "obj");
    EXPECT_EQ(read_city(put("a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 90\n1 2 3 4\n"), {})->format,
              "height grid");
    EXPECT_THAT(refusal(read_city(put("a.stl", "solid"), {})), HasSubstr("its ending is of no known city"));
    EXPECT_THAT(refusal(read_city(put("a.xml", "<?xml?><kml/>"), {})), HasSubstr("its first element is 'kml'"));
    EXPECT_THAT(refusal(read_city(put("b.obj", ""), {})), HasSubstr("is empty"));
}

TEST_F(ReadCity, SaysWhatCannotBeOpened) {
    const auto absent = read_city(folder_ / "absent.obj", {});
    ASSERT_FALSE(absent);
    EXPECT_EQ(absent.error().code, ErrorCode::outside);
    EXPECT_THAT(refusal(read_city(folder_, {})), HasSubstr("holds 0 .xml files"));
    EXPECT_THAT(refusal(read_city(put("cut.obj.gz", "\x1f\x8b\x08"), {})), HasSubstr("cut.obj.gz"));
}

TEST_F(ReadCity, NoFileMayHoldMoreThanTheSceneMayTake) {
    CityFileSettings small;
    small.memory_limit = std::size_t{1} << 20;
    EXPECT_TRUE(read_city(put("a.obj", small_obj), small));
    const auto file = put("b.obj", small_obj + std::string(std::size_t{1} << 20, ' '));
    EXPECT_TRUE(read_city(file, {}));
    EXPECT_THAT(refusal(read_city(file, small)),
                HasSubstr("b.obj: has more than 1048576 bytes of text, the most that is read (memory_limit_mb is 1)"));
    const auto zip =
        put("b.zip", test::archive_of("zip", {{"b.obj", small_obj + std::string(std::size_t{1} << 20, ' ')}}));
    EXPECT_THAT(
        refusal(read_city(zip, small)),
        HasSubstr("b.zip:b.obj: unpacks to more than 1048576 bytes, the most that is read (memory_limit_mb is 1)"));
}

TEST_F(ReadCity, ReadsPackedCities) {
    for (const char* filter : {"compress", "bzip2", "xz", "zstd"})
        EXPECT_TRUE(read_city(put("a.obj.Z", test::compressed(filter, small_obj)), {})) << filter;
    const std::string zip = test::archive_of(
        "zip", {{"__MACOSX/._a.obj", "?"}, {"town/a.obj", small_obj}, {"town/a.mtl", ""}, {"town/wood.jpg", "?"}});
    for (const char* name : {"a.zip", "a.obj", "a"}) {
        const auto file = read_city(put(name, zip), {});
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->format, "obj");
    }
    EXPECT_TRUE(
        read_city(put("a.tar.xz", test::compressed("xz", test::archive_of("pax", {{"a.obj", small_obj}}))), {}));
    const std::string inner = test::archive_of("zip", {{"a.obj.gz", test::compressed("gzip", small_obj)}});
    EXPECT_TRUE(read_city(put("b.zip", inner), {}));
}

TEST_F(ReadCity, NamesWhatIsWrongInAnArchive) {
    const auto said = [&](const std::string& bytes) { return refusal(read_city(put("a.zip", bytes), {})); };
    EXPECT_THAT(said(test::archive_of("zip", {{"a.obj", small_obj}, {"b.obj", small_obj}})),
                HasSubstr("a.zip: an archive of 2 cities: a.obj, b.obj; expected one"));
    EXPECT_THAT(said(test::archive_of("zip", {{"a.txt", "?"}})),
                HasSubstr("a.zip: an archive of 0 cities; expected one"));
    EXPECT_THAT(said(test::archive_of("zip", {{"in/a.obj", "v x\n"}})), HasSubstr("a.zip:in/a.obj:1: "));
    EXPECT_THAT(said(test::archive_of("zip", {{"in/a.obj", small_obj}}, "secret")),
                HasSubstr("a.zip:in/a.obj: is encrypted"));
    EXPECT_THAT(said("neither"), HasSubstr("a.zip: no zip or tar archive ("));
    EXPECT_EQ(read_city(folder_ / "absent.zip", {}).error().code, ErrorCode::outside);
}

TEST_F(ReadCity, TellsOfDoubtfulUnits) {
    const auto small = read_city(put("a.obj", "v 0 0 0\nv 20 0 0\nv 0 0 3\nf 1 2 3\n"), {});
    ASSERT_TRUE(small);
    EXPECT_THAT(small->warnings, Contains(HasSubstr("a.obj: the whole city is 3.00 m tall")));
    EXPECT_TRUE(read_city(put("b.obj", small_obj), {})->warnings.empty());
}

TEST_F(ReadCity, ReadsABufferBesideAGltfButNoneElsewhere) {
    const std::string text =
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"BUFFER"}]})";
    const float corners[9] = {0, 0, 0, 20, 0, 0, 0, 20, 0};
    put("the wall.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
    const auto with = [&](const std::string& uri) { return std::string(text).replace(text.find("BUFFER"), 6, uri); };
    const auto file = read_city(put("a.gltf", with("the%20wall.bin")), {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_DOUBLE_EQ(test::area_of(file->model), 200);
    EXPECT_THAT(refusal(read_city(put("b.gltf", with("../the%20wall.bin")), {})), HasSubstr("inside the folder"));
}

TEST_F(ReadCity, TellsATextSequenceFromACityJsonWhateverItsEnding) {
    const std::string head = R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)";
    const std::string house =
        R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}},)"
        R"("vertices":[[0,0,0],[20,0,0],[0,0,20]]})";
    const std::string sequence =
        head + R"("CityObjects":{},"vertices":[]})" + "\n" + R"({"type":"CityJSONFeature","id":"a",)" + house + "\n";
    for (const char* name : {"a.json", "a.city.json", "a.cityjson", "a.city.jsonl"}) {
        const auto file = read_city(put(name, sequence), {});
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->buildings, 1U) << name;
    }
    for (const char* name : {"b.json", "b.city.json"}) {
        const auto file = read_city(put(name, head + "\n" + house + "\n"), {});
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->buildings, 1U) << name;
    }
}

// Counts of the data's own list, munich.tar.gz and its kin.
CityModel expect_real(const fs::path& path, std::size_t triangles) {
    auto file = read_city(path, {});
    EXPECT_TRUE(file) << file.error().message;
    if (!file) return {};
    test::expect_sound(*file);
    EXPECT_EQ(file->model.triangles.size() + file->dropped, triangles);
    EXPECT_LT(file->dropped, triangles / 100);
    EXPECT_GT(test::count_of(file->model, SurfaceKind::wall), triangles / 3);
    EXPECT_GT(test::count_of(file->model, SurfaceKind::roof), triangles / 10);
    for (const std::string& doubt : doubts_about(file->model))
        ADD_FAILURE() << doubt;
    return std::move(file->model);
}

TEST(RealCities, MunichHasMaterialsAndGround) {
    SKYLOOP_REQUIRE_SHARED(path, "city/munich.tar.gz");
    const CityModel model = expect_real(path, 38938);
    EXPECT_THAT(model.materials, ::testing::UnorderedElementsAre("concrete", "marble", "metal", "brick", "wood"));
    double ground = 0;
    for (const CityTriangle& triangle : model.triangles) {
        const auto& [a, b, c] = triangle.corners;
        const auto& at = model.vertices;
        if (triangle.kind == SurfaceKind::ground) ground += 0.5 * (at[b] - at[a]).cross(at[c] - at[a]).norm();
    }
    EXPECT_GE(ground, 1475.4 * 1205.6) << "its plane";
    EXPECT_NEAR(test::highest_of(model).z(), 98.57, 0.01) << "the Frauenkirche";
}

TEST(RealCities, MunichIsTheSameInAZip) {
    SKYLOOP_REQUIRE_SHARED(path, "city/munich.tar.gz");
    const auto files = archive_files(read_uncompressed(path).value(), path.string(), max_text_file_size);
    ASSERT_TRUE(files) << files.error().message;
    const fs::path zip = fs::path(::testing::TempDir()) / "skyloop_munich.zip";
    std::ofstream(zip, std::ios::binary) << test::archive_of("zip", {files->begin(), files->end()});
    const auto packed = read_city(zip, {}), plain = read_city(path, {});
    fs::remove(zip);
    ASSERT_TRUE(packed && plain);
    EXPECT_TRUE(packed->model.vertices == plain->model.vertices);
    EXPECT_EQ(packed->model.triangles.size(), plain->model.triangles.size());
    EXPECT_EQ(packed->model.materials, plain->model.materials);
}

TEST(RealCities, EtoileHasGroundUnderItsArch) {
    SKYLOOP_REQUIRE_SHARED(path, "city/etoile.tar.gz");
    const CityModel model = expect_real(path, 13058);
    EXPECT_GE(test::count_of(model, SurfaceKind::ground), 2U);
    EXPECT_NEAR(test::highest_of(model).z(), 50, 0.01);
}

TEST(RealCities, OdaibaIsReadCompressed) {
    SKYLOOP_REQUIRE_SHARED(path, "city/tokyo_odaiba_109k.obj.gz");
    expect_real(path, 108644);
}

}  // namespace
}  // namespace skyloop::read_city_test
