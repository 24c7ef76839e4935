#include "campaigns/campaign/campaign_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "base/core/number_text.hpp"
#include "base/core/random.hpp"
#include "base/core/std_additions.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr double nearly_one = 1 - 1e-9;

// Of the standard normal distribution, whose function is erfc(−x/√2)/2.
double normal_quantile(double u) { return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * u); }

CampaignValue rounded_value(double number) {
    const std::string text = fmt::format("{:.12g}", number);
    return campaign_value(number_in<double>(text).value_or(number));
}

double inside(double u) { return std::clamp(u, 1e-12, nearly_one); }

// Which of `count` equal parts of (0, 1).
std::uint64_t part_of(double u, std::uint64_t count) {
    const auto part = static_cast<std::uint64_t>(u * static_cast<double>(count));
    return std::min(part, count - 1);
}

std::uint64_t count_of_whole(const WholeSpread& s) { return static_cast<std::uint64_t>(s.most - s.least) + 1; }

CampaignValue whole_at(const WholeSpread& s, std::uint64_t index) {
    return campaign_value(s.least + static_cast<std::int64_t>(index));
}

}  // namespace

std::vector<double> random_samples(std::uint64_t count, std::uint64_t design_seed, std::string_view key) {
    RandomStream stream(design_seed, fmt::format("campaign.random.{}", key));
    std::vector<double> samples;
    for (std::uint64_t i = 0; i < count; ++i)
        samples.push_back(inside(stream.uniform()));
    return samples;
}

std::vector<double> latin_hypercube_samples(std::uint64_t count, std::uint64_t design_seed, std::string_view key) {
    RandomStream stream(design_seed, fmt::format("campaign.latin_hypercube.{}", key));
    std::vector<double> samples;
    for (std::uint64_t i = 0; i < count; ++i) {
        const double within = std::clamp(stream.uniform(), 1e-9, nearly_one);  // rounding must not leave the stratum
        samples.push_back((static_cast<double>(i) + within) / static_cast<double>(count));
    }
    for (std::uint64_t i = count; i > 1; --i)  // Fisher and Yates
        std::swap(samples[i - 1], samples[part_of(stream.uniform(), i)]);
    return samples;
}

CampaignValue value_at(const CampaignSpread& spread, double u) {
    return std::visit(
        Overloaded{
            [u](const std::vector<CampaignValue>& values) { return values.at(part_of(u, values.size())); },
            [u](const UniformSpread& s) { return rounded_value(s.least + (s.most - s.least) * u); },
            [u](const LogUniformSpread& s) {
                return rounded_value(std::exp(std::log(s.least) + (std::log(s.most) - std::log(s.least)) * u));
            },
            [u](const NormalSpread& s) { return rounded_value(s.mean + s.deviation * normal_quantile(inside(u))); },
            [u](const WholeSpread& s) { return whole_at(s, part_of(u, count_of_whole(s))); }},
        spread);
}

std::uint64_t grid_size(const CampaignSpread& spread) {
    if (const auto* values = std::get_if<std::vector<CampaignValue>>(&spread)) return values->size();
    if (const auto* whole = std::get_if<WholeSpread>(&spread)) return count_of_whole(*whole);
    return 0;
}

CampaignValue grid_value(const CampaignSpread& spread, std::uint64_t index) {
    if (const auto* values = std::get_if<std::vector<CampaignValue>>(&spread)) return values->at(index);
    return whole_at(std::get<WholeSpread>(spread), index);
}

}  // namespace skyloop::inline campaigns
