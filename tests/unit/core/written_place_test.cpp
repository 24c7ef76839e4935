#include "base/core/written_place.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using enum Coordinate;

TEST(WrittenPlace, HasALetterBeforeOrBehindTheDegrees) {
    for (const char* text : {"33.9S", "33.9 s", "S33.9", "S 33.9", "-33.9", "-33.9S", "33.9 South", "33.9\xC2\xB0 S"})
        EXPECT_EQ(written_degrees(text, latitude), -33.9) << text;
    for (const char* text : {"18.4E", "e 18.4", "+18.4", "18.4 East"})
        EXPECT_EQ(written_degrees(text, longitude), 18.4) << text;
    EXPECT_EQ(written_degrees("18.4W", longitude), -18.4);
}

TEST(WrittenPlace, HasMinutesAndSeconds) {
    for (const char* text : {"33 54.0 S", "S 33 54.0",
                             "33\xC2\xB0"
                             "54'S",
                             "33\xB0"
                             "54' S",
                             "33:54:00S", "-33 54 0", "33\xC2\xB0 54\xE2\x80\xB2 00.0\xE2\x80\xB3 S",
                             "33\xC2\xBA"
                             "54'00''S",
                             "33*54'0\"S"})
        EXPECT_NEAR(written_degrees(text, latitude).value_or(0), -33.9, 1e-12) << text;
    EXPECT_NEAR(written_degrees("0 30 36", latitude).value_or(0), 0.51, 1e-12);
    EXPECT_NEAR(written_degrees("-0 30", latitude).value_or(0), -0.5, 1e-12);
}

TEST(WrittenPlace, IsNothingWhereItIsNotClear) {
    for (const char* text : {"", "S", "33.9E", "S33.9S", "-33.9N", "--33.9", "33,9S", "33.9 54", "33 60", "1 2 3 4",
                             "33.9x", "1e2", "33'54*", "nan", "NS 33", "33 -54"})
        EXPECT_EQ(written_degrees(text, latitude), std::nullopt) << text;
}

// A table of names, and what becomes of rows whose third and fifth cells are numbers.
class Hemispheres : public testing::Test {
protected:
    void names(const std::vector<std::string_view>& all) {
        const auto at = [&](std::string_view name) {
            return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
        };
        places_ = {at("lat"), at("lon")};
        columns_ = HemisphereColumns({all.begin(), all.end()}, places_);
        line_ = 1;
    }
    tl::expected<std::array<double, 2>, std::string> row(const LineCells& cells) {
        return columns_.place(
            cells, {std::stod(std::string(cells.at(places_[0]))), std::stod(std::string(cells.at(places_[1])))},
            ++line_);
    }

    std::array<std::size_t, 2> places_{};
    HemisphereColumns columns_;
    std::size_t line_ = 1;
};

TEST_F(Hemispheres, ActUnderTheirNamesWhereverTheyStand) {
    for (const auto& [ns, ew] : {std::pair("N/S", "E/W"),
                                 {"NS", "EW"},
                                 {"n_s", "e_w"},
                                 {"N/S Indicator", "E/W Indicator"},
                                 {"lat_dir", "lon_dir"},
                                 {"Latitude Direction", "Longitude Direction"},
                                 {"Latitude Hemisphere", "Longitude Hemisphere"},
                                 {"lat_ns", "lng_ew"},
                                 {"GPSLatitudeRef", "GPSLongitudeRef"},
                                 {"North/South", "East/West"}}) {
        names({ns, "x", "lat", "y", "lon", "z", ew});
        EXPECT_THAT(row({"S", "1", "33.9", "1", "18.4", "1", "W"}).value(), ElementsAre(-33.9, -18.4)) << ns;
        EXPECT_THAT(row({"N", "1", "33.9", "1", "18.4", "1", "E"}).value(), ElementsAre(33.9, 18.4)) << ns;
        EXPECT_THAT(columns_.notes({ns, "x", ew}), ElementsAre(std::string(ns) + " is taken as the hemisphere of lat",
                                                               std::string(ew) + " is taken as the hemisphere of lon",
                                                               "columns without a meaning here: x"));
        EXPECT_FALSE(columns_.not_understood());
    }
}

TEST_F(Hemispheres, ActUnderAnyNameBesideTheirNumber) {
    names({"lat", "side", "lon", "side"});
    EXPECT_THAT(row({"33.9", "S", "18.4", "W"}).value(), ElementsAre(-33.9, -18.4));
    EXPECT_THAT(row({"-33.9", "s", "-18.4", "west"}).value(), ElementsAre(-33.9, -18.4)) << "sign and letter agree";
}

TEST_F(Hemispheres, AreFoundInTheFirstRowThatHasAPlace) {
    names({"lat", "N/S", "lon", "E/W"});
    EXPECT_THAT(row({"0", "", "0", "V"}).value(), ElementsAre(0, 0));
    EXPECT_THAT(row({"33.9", "S", "18.4", "W"}).value(), ElementsAre(-33.9, -18.4));
    EXPECT_THAT(row({"33.9", "", "18.4", "W"}).error(), "N/S is ''; expected N or S");
    EXPECT_THAT(row({"33.9", "S", "18.4", "O"}).error(), "E/W is 'O'; expected E or W");
    EXPECT_THAT(row({"-33.9", "N", "18.4", "W"}).error(),
                "lat is '-33.9', and N/S is 'N'; expected a sign and a letter that agree");
}

TEST_F(Hemispheres, ThatAreNotUnderstoodAreTold) {
    names({"lat", "lon", "t", "side"});
    EXPECT_THAT(row({"33.9", "18.4", "0", "N"}).value(), ElementsAre(33.9, 18.4));
    EXPECT_FALSE(columns_.not_understood()) << "it would turn no sign";
    EXPECT_TRUE(row({"33.9", "18.4", "1", "S"}));
    EXPECT_THAT(columns_.not_understood().value_or(""), HasSubstr("the column 'side' has 'S' (first in line 3)"));
    names({"lat", "lon", "t", "hemisphere"});
    EXPECT_TRUE(row({"33.9", "18.4", "0", "SW"}));
    EXPECT_THAT(columns_.not_understood().value_or(""), HasSubstr("the column 'hemisphere' has 'SW'"));
}

TEST_F(Hemispheres, AreNoOtherLettersAndNumbers) {
    names({"lat", "lon", "ns", "wind", "valid", "mode"});
    EXPECT_TRUE(row({"33.9", "18.4", "8", "S", "N", "s"}));
    EXPECT_TRUE(row({"33.9", "18.4", "9", "W", "N", "s"}));
    EXPECT_FALSE(columns_.not_understood()) << *columns_.not_understood();
    EXPECT_THAT(columns_.notes({}), IsEmpty());
    names({"lat", "lon", "state"});
    EXPECT_TRUE(row({"-33.9", "18.4", "S"}));
    EXPECT_FALSE(columns_.not_understood()) << "the latitude has its sign";
}

}  // namespace
}  // namespace skyloop
