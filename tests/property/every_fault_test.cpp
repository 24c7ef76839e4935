// Every kind of fault on a bench: its effect in what a client hears, and its end without residue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "run/fault/fault_kind.hpp"
#include "support/fault_rows.hpp"

namespace skyloop::test {
namespace {

// Between the last byte of one second and the first of the next.
constexpr double lull_s = 0.05;

std::vector<std::string> names_of(const std::vector<HeardMessage>& messages) {
    std::vector<std::string> names;
    for (const HeardMessage& message : messages)
        names.push_back(message.name);
    return names;
}

std::vector<NavPvt> fixes_of(const std::vector<HeardMessage>& messages) {
    std::vector<NavPvt> fixes;
    for (const HeardMessage& message : messages)
        if (const auto pvt = pvt_of(message)) fixes.push_back(*pvt);
    return fixes;
}

double farthest_apart(const std::vector<NavPvt>& a, const std::vector<NavPvt>& b) {
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        most = std::max(most, apart_m(a[i], b[i]));
    return most;
}

// The same messages in the same order, none damaged, the same answers, the same settings; positions within the bound.
void expect_no_residue(const BenchRun& run, const BenchRun& sound, double from, double to, double bound_m) {
    const auto heard = run.between(from, to), expected = sound.between(from, to);
    ASSERT_GT(expected.size(), 40U) << "there is something to compare";
    ASSERT_EQ(names_of(heard), names_of(expected));
    EXPECT_EQ(run.between(from, to, "CFG-VALGET"), sound.between(from, to, "CFG-VALGET")) << "the settings";
    EXPECT_EQ(run.between(from, to, "MON-VER"), sound.between(from, to, "MON-VER"));
    if (bound_m < 0) {
        for (std::size_t i = 0; i < heard.size(); ++i)
            ASSERT_EQ(heard[i], expected[i]) << heard[i].name << " of " << heard[i].at_s << " s";
        return;
    }
    const auto fixes = fixes_of(heard), expected_fixes = fixes_of(expected);
    for (std::size_t i = 0; i < fixes.size(); ++i) {
        EXPECT_EQ(fixes[i].i_tow, expected_fixes[i].i_tow);
        EXPECT_EQ(fixes[i].fix_type, expected_fixes[i].fix_type);
        EXPECT_EQ(fixes[i].flags, expected_fixes[i].flags);
        EXPECT_LE(apart_m(fixes[i], expected_fixes[i]), bound_m + 0.001) << fixes[i].i_tow;
    }
}

class EveryFault : public testing::TestWithParam<FaultRow> {};

TEST_P(EveryFault, ShowsAndLeavesNothingBehind) {
    const FaultRow& row = GetParam();
    const double again_at = bench_end_s + 2;
    const BenchRun& sound = sound_run(row.bench);
    const BenchRun run = bench_run(row.bench, bench_fault(row.kind, row.parameters), length_of(row),
                                   row.client_must_configure ? std::optional(again_at) : std::nullopt);
    const double begin = bench_begin_s - lull_s, end = bench_end_s - lull_s, settled = end + row.settle_s;
    EXPECT_EQ(run.between(0, begin), sound.between(0, begin)) << "it is not there before it begins";
    if (row.seen_in == "pace") {
        for (const auto& [at_s, speed] : run.speeds)
            EXPECT_TRUE(at_s == bench_end_s || (speed != 1) == (at_s >= bench_begin_s && at_s < bench_end_s)) << at_s;
    } else if (row.seen_in.empty()) {
        const auto faulty = run.between(begin, end), whole = sound.between(begin, end);
        const auto later = [](const auto& a, const auto& b) { return a.at_s != b.at_s; };
        EXPECT_TRUE(faulty.size() != whole.size() || faulty != whole ||
                    !std::equal(faulty.begin(), faulty.end(), whole.begin(), std::not_fn(later)));
    } else {
        EXPECT_TRUE(run.between(begin, end, row.seen_in) != sound.between(begin, end, row.seen_in)) << row.seen_in;
    }
    RecordProperty("apart_m",
                   std::to_string(farthest_apart(fixes_of(run.between(settled, length_of(row) - lull_s)),
                                                 fixes_of(sound.between(settled, length_of(row) - lull_s)))));
    expect_no_residue(run, sound, settled, length_of(row) - lull_s, row.bound_m);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryFault, testing::ValuesIn(fault_rows),
                         [](const auto& one) { return std::string(one.param.kind); });

TEST(FaultRows, AreThoseOfTheCatalogue) {
    std::vector<std::string> kinds, rows;
    for (const FaultKind& kind : fault_kinds()) {
        // The bench's sky is not authenticated: unit/fault has these.
        if (kind.name.starts_with("osnma_")) continue;
        // Nor is its receiver on a CAN bus: so has unit/fault these.
        if (kind.need == &can_node) continue;
        kinds.emplace_back(kind.name);
        EXPECT_FALSE(kind.cause.empty()) << kind.name;
        const FaultRow* row = fault_row(kind.name);
        EXPECT_TRUE(row == nullptr || !kind.measuring_receivers_only || row->bench == measuring) << kind.name;
    }
    for (const FaultRow& row : fault_rows)
        rows.emplace_back(row.kind);
    EXPECT_THAT(rows, testing::UnorderedElementsAreArray(kinds));
}

}  // namespace
}  // namespace skyloop::test
