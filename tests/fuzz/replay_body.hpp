// The fuzz bodies of the program that replays their corpora.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

struct ReplayBody {
    std::string_view name;
    int (*run)(const std::uint8_t* data, std::size_t size);
};

// All of them; replay.cmake writes the list.
const std::vector<ReplayBody>& replay_bodies();
