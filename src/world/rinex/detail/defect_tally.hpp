/// What is wrong with records of one kind.
#pragma once

#include <string>
#include <utility>

namespace skyloop::rinex {

/// The first defect of a kind in words, and how many there are.
struct DefectTally {
    std::string first;
    int count = 0;
    void add(std::string sentence) {
        if (count++ == 0) first = std::move(sentence);
    }
    /// Many records may fail; only the first needs words.
    template <class Words>
    void add_with(Words words) {
        if (count++ == 0) first = words();
    }
};

}  // namespace skyloop::rinex
