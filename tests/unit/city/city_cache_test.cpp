// Cities that were read are kept, and what is kept is believed only when it is whole and of the same source.
#include "world/city/city_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

namespace skyloop {
namespace {

namespace fs = std::filesystem;

class CityCacheTest : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(::testing::TempDir()) / (std::string("skyloop_city_cache_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        put("a.obj", "v 0 0 0\nv 20 0 0\nv 0 0 20\nf 1 2 3\n");
    }
    void TearDown() override { fs::remove_all(folder_); }
    void put(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
    }
    CityReading read(const CityFileSettings& settings = {}, const std::string& name = "a.obj") const {
        auto reading = read_city(folder_ / name, settings, cache());
        EXPECT_TRUE(reading) << reading.error().message;
        return reading ? std::move(*reading) : CityReading{};
    }
    [[nodiscard]] CityCache cache() const { return {folder_ / "cache", 0}; }
    [[nodiscard]] fs::path kept() const { return cached_city_path(folder_ / "a.obj", cache()); }
    fs::path folder_;
};

TEST_F(CityCacheTest, TheSecondReadingComesFromTheCacheAndIsTheSame) {
    const CityReading first = read();
    EXPECT_FALSE(first.from_cache);
    const CityReading second = read();
    EXPECT_TRUE(second.from_cache);
    EXPECT_EQ(second.digest, first.digest);
    EXPECT_EQ(encode_city(second.file, 1), encode_city(first.file, 1));
}

TEST_F(CityCacheTest, AnotherSourceOrOtherSettingsAreReadAgain) {
    const CityReading first = read();
    CityFileSettings centimetres;
    centimetres.metres_per_unit = 0.5;
    EXPECT_FALSE(read(centimetres).from_cache);
    EXPECT_FALSE(read().from_cache) << "the other settings took the place";
    CityFileSettings elsewhere;
    elsewhere.file_origin = {10, 0, 0};
    EXPECT_FALSE(read(elsewhere).from_cache);
    put("a.obj", "v 0 0 0\nv 20 0 0\nv 0 0 21\nf 1 2 3\n");
    const CityReading changed = read();
    EXPECT_FALSE(changed.from_cache);
    EXPECT_NE(changed.digest, first.digest);
}

TEST_F(CityCacheTest, DamagedCutAndForeignFilesAreIgnoredAndReplaced) {
    read();
    std::ifstream stream(kept(), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_GT(whole.size(), 100U);
    std::string damaged = whole;
    damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 1);
    for (const std::string& content :
         {damaged, whole.substr(0, whole.size() - 1), whole.substr(0, 20), std::string("hello"), std::string()}) {
        std::ofstream(kept(), std::ios::binary) << content;
        EXPECT_FALSE(read().from_cache) << content.size();
        EXPECT_TRUE(read().from_cache) << content.size();
    }
}

constexpr const char* wall_of_20_m =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n20 0 0\n0 0 20\n3 0 1 2\n";

TEST_F(CityCacheTest, AChangeOfAFileThatIsNamedIsSeenAndNoOther) {
    fs::create_directories(folder_ / "town/meshes/deep");
    std::string wall = wall_of_20_m;
    put("town/meshes/deep/x.PLY", wall);
    put("town/scene.xml",
        R"(<scene version="3.0.0"><shape type="ply"><string name="filename" value="meshes/deep/x.PLY"/></shape></scene>)");
    for (const std::string name : {"town/scene.xml", "town"}) {
        put("town/meshes/deep/x.PLY", wall_of_20_m);
        const CityReading first = read({}, name);
        EXPECT_FALSE(first.from_cache) << name;
        put("town/other.bin", "not of this city");
        put("town/meshes/other.ply", "ply");
        const CityReading second = read({}, name);
        EXPECT_TRUE(second.from_cache) << name;
        EXPECT_EQ(second.digest, first.digest);
        put("town/meshes/deep/x.PLY", wall.replace(wall.find("0 0 20"), 6, "0 0 70"));
        const CityReading third = read({}, name);
        EXPECT_FALSE(third.from_cache) << name;
        EXPECT_NE(third.digest, first.digest);
        EXPECT_EQ(third.file.model.vertices.back().z(), 70);
        wall = wall_of_20_m;
    }
}

TEST_F(CityCacheTest, AFolderThatCannotBeWrittenIsNoError) {
    put("cache", "a file where the folder should be");
    EXPECT_FALSE(read().from_cache);
    EXPECT_FALSE(read().from_cache);
}

TEST_F(CityCacheTest, AMissingSourceIsToldByItsNameThoughItWasKept) {
    read();
    fs::remove(folder_ / "a.obj");
    const auto missing = read_city(folder_ / "a.obj", {}, cache());
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::outside);
    EXPECT_THAT(missing.error().message, ::testing::HasSubstr("a.obj"));
}

TEST_F(CityCacheTest, WhatIsNoFileIsNotWaitedFor) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    fs::create_symlink("/dev/zero", folder_ / "zero.obj");
    for (const char* name : {"pipe.obj", "zero.obj"}) {
        const auto reading = read_city(folder_ / name, {}, cache());
        ASSERT_FALSE(reading) << name;
        EXPECT_EQ(reading.error().code, ErrorCode::outside);
        EXPECT_THAT(reading.error().message, testing::EndsWith(std::string(name) + ": is not a regular file"));
    }
}

TEST(CityEncoding, NoByteCanBeChangedOrLeftOut) {
    CityFile file;
    file.format = "obj";
    file.warnings = {"one"};
    file.companions = {{"meshes/a.ply", 7}};
    file.anchor = MapAnchor{"EPSG:28992", true, 1, 2, 3};
    file.model.add_triangle({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1)},
                            SurfaceKind::roof, file.model.material_index("glass"));
    file.model.foliage.push_back({{{0, 0}, {1, 0}, {0, 1}}, 0, 9, -2});
    file.model.grounded.push_back({0, 3, 1.5});
    const std::string bytes = encode_city(file, 7);
    const auto decoded = decode_city(bytes, 7);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->model.foliage.at(0).ground, -2);
    EXPECT_EQ(decoded->model.grounded.at(0).ground, 1.5);
    EXPECT_EQ(encode_city(*decoded, 7), bytes);
    EXPECT_FALSE(decode_city(bytes, 8)) << "another key";
    EXPECT_FALSE(decode_city(bytes + "x", 7));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string changed = bytes;
        changed[i] = static_cast<char>(changed[i] ^ 0x10);
        EXPECT_FALSE(decode_city(changed, 7)) << i;
        EXPECT_FALSE(decode_city(std::string_view(bytes).substr(0, i), 7)) << i;
    }
}

}  // namespace
}  // namespace skyloop
