// Integrals of smooth functions over short intervals.
#pragma once

#include <array>

namespace skyloop {

// Of degree 9: Abramowitz and Stegun, Handbook of Mathematical Functions, table 25.4, n = 5.
template <class Function>
auto integral_over(double length, const Function& function) {
    constexpr std::array<double, 2> nodes{0.538469310105683, 0.906179845938664};
    constexpr std::array<double, 3> weights{0.568888888888889, 0.478628670499366, 0.236926885056189};
    const double half = length / 2;
    auto sum = function(half);
    sum *= weights[0];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        auto pair = function(half * (1 - nodes[i]));
        pair += function(half * (1 + nodes[i]));
        pair *= weights[i + 1];
        sum += pair;
    }
    sum *= half;
    return sum;
}

}  // namespace skyloop
